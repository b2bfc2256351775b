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

PatternStack stack_of(const Image<float>& picture, bool is_linear, const glm::ivec2& size) {
  if (picture.width != size.x || picture.height != size.y) {
    throw InputError(fmt::format(
        "[patterns]: the slide has {}×{} pixels, expected the projector's {}×{} (or input_size of a scaler)",
        picture.width, picture.height, size.x, size.y));
  }
  PatternStack stack{size.x, size.y, 1, {}};
  if (!is_linear) stack.light_of_value = srgb_light();
  stack.values.reserve(picture.values.size());
  for (const float light : picture.values) {
    const double value = is_linear ? double(light) : srgb_of_light(light);
    stack.values.push_back(std::uint8_t(std::clamp(std::lround(255 * value), 0L, 255L)));
  }
  return stack;
}

}  // namespace

PatternStack make_slide_stack(const Slide& slide, const glm::ivec2& size) {
  return stack_of(slide.light, slide.is_linear, size);
}

std::vector<PatternStack> make_slide_primaries(const Slide& slide, const glm::ivec2& size) {
  std::vector<PatternStack> stacks;
  for (const Image<float>& primary : slide.primaries)
    stacks.push_back(stack_of(primary, slide.is_linear, size));
  return stacks;
}

}  // namespace laterna
