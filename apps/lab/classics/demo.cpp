#include "apps/lab/classics/demo.h"

#include "render/effects/displacement.h"
#include "sim/scene_file.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace laterna {

ClassicDemo::ClassicDemo(const std::filesystem::path& file, const std::vector<std::string>& set)
    : ClassicDemo(load_scene(file, set)) {}

namespace {

Scene with_displacement(Scene scene) {
  std::optional<Scene> storage;
  displaced(scene, storage);
  return storage ? *storage : scene;
}

}  // namespace

ClassicDemo::ClassicDemo(Scene scene_to_show)
    : scene(with_displacement(std::move(scene_to_show))), view(scene), fragments(scene) {
  const Intrinsics& k = projector().device.intrinsics;
  const PatternStack stack = slide_of(scene);
  slide = Image<float>(stack.width, stack.height);
  for (std::size_t i = 0; i < slide.values.size(); ++i)
    slide.values[i] = stack.light_of_value[stack.values[i]];
  white_lx = projector().flux_lm / (double(k.size.x) * k.size.y) * k.fx * k.fy;
  full_lx = white_lx + scene.ambient_lx;
  white = scene.objects[0].albedo * full_lx / std::numbers::pi;
}

std::vector<Image<double>> ClassicDemo::passes(SlideOptions options, int steps) const {
  options.share = white_lx / full_lx;
  return draw_passes(fragments, {.ambient = scene.ambient_lx / full_lx,
                                 .lights = {slide_shade(fragments, projector(), slide, options)},
                                 .steps = steps});
}

Image<double> ClassicDemo::core() const {
  const Image<float> picture = core_picture(view);
  Image<double> shares(picture.width, picture.height);
  std::transform(picture.values.begin(), picture.values.end(), shares.values.begin(),
                 [&](float value) { return value / white; });
  return shares;
}

double ClassicDemo::core_distance_px(const PixelArray<glm::dvec4>& strq) const {
  const LightMap& light = view.lights[0];
  double most = 0;
  for (std::size_t p = 0; p < strq.values.size(); ++p)
    if (light.lit(p))
      most =
          std::max(most, glm::distance(pixel_from_texture(strq.values[p], projector().device.intrinsics.size),
                                       {light.u_px.values[p], light.v_px.values[p]}));
  return most;
}

Canvas shown(const Image<double>& image, double white) {
  Image<float> light(image.width, image.height);
  std::copy(image.values.begin(), image.values.end(), light.values.begin());
  return grey_canvas(light, white);
}

double greatest_difference(const Image<double>& a, const Image<double>& b) {
  double greatest = 0;
  for (std::size_t p = 0; p < a.values.size(); ++p)
    greatest = std::max(greatest, std::abs(a.values[p] - b.values[p]));
  return greatest;
}

double rms_difference(const Image<double>& a, const Image<double>& b) {
  double sum = 0;
  for (std::size_t p = 0; p < a.values.size(); ++p) sum += std::pow(a.values[p] - b.values[p], 2);
  return std::sqrt(sum / double(a.values.size()));
}

double share_that_differs(const Image<double>& a, const Image<double>& b) {
  std::size_t count = 0;
  for (std::size_t p = 0; p < a.values.size(); ++p) count += std::abs(a.values[p] - b.values[p]) > 1e-6;
  return double(count) / double(a.values.size());
}

}  // namespace laterna
