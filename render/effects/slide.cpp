#include "render/effects/slide.h"

#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

// IEC 61966-2-1, from value to light.
double light_of_srgb(double value) {
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

std::array<float, 256> srgb_light() {
  std::array<float, 256> light{};
  for (int v = 0; v < 256; ++v) light[v] = static_cast<float>(light_of_srgb(v / 255.0));
  return light;
}

double srgb_of_light(double light) {
  return light <= 0.04045 / 12.92 ? light * 12.92 : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

constexpr int grey = -1;

const Image<float>& light_of(const Slide& slide, int primary) {
  return primary == grey || slide.primaries.empty() ? slide.light : slide.primaries[std::size_t(primary)];
}

void check(const Slide& slide, const glm::ivec2& size, bool is_linear) {
  const Image<float>& picture = slide.light;
  if (picture.width != size.x || picture.height != size.y) {
    throw InputError(fmt::format(
        "[patterns]: the slide has {}×{} pixels, expected the projector's {}×{} (or input_size of a scaler)",
        picture.width, picture.height, size.x, size.y));
  }
  if (slide.is_linear != is_linear) throw InputError("[patterns]: slides of both encodings, expected one");
}

PatternStack stack_of(std::span<const Slide> slides, const glm::ivec2& size, int primary) {
  if (slides.empty()) throw InputError("[patterns]: no pictures, expected at least one");
  const bool is_linear = slides[0].is_linear;
  const std::size_t count = slides.size();
  PatternStack stack{size.x, size.y, int(count), {}};
  if (!is_linear) stack.light_of_value = srgb_light();
  stack.values.resize(count * size.x * size.y);
  for (std::size_t k = 0; k < count; ++k) {
    check(slides[k], size, is_linear);
    const std::vector<float>& light = light_of(slides[k], primary).values;
    for (std::size_t i = 0; i < light.size(); ++i) {
      const double value = is_linear ? double(light[i]) : srgb_of_light(light[i]);
      stack.values[i * count + k] = std::uint8_t(std::clamp(std::lround(255 * value), 0L, 255L));
    }
  }
  return stack;
}

}  // namespace

PatternStack make_slide_stack(std::span<const Slide> slides, const glm::ivec2& size) {
  return stack_of(slides, size, grey);
}

std::vector<PatternStack> make_slide_primaries(std::span<const Slide> slides, const glm::ivec2& size) {
  std::vector<PatternStack> stacks;
  for (int primary = 0; primary < 3; ++primary) stacks.push_back(stack_of(slides, size, primary));
  return stacks;
}

std::span<const Slide> shown_slides(const Scene& scene) {
  if (scene.effects.slide) return {scene.slide.get(), 1};
  if (scene.pictures) return *scene.pictures;
  return {};
}

}  // namespace laterna
