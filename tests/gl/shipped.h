// A scene that ships, at both renderers.
#pragma once

#include "sim/image_file.h"
#include "sim/scene_file.h"
#include "tests/gl/comparison.h"
#include "tests/gl/context.h"
#include "tests/render/rig.h"
#include "tests/testing.h"

#include <iostream>

namespace laterna::gl {

inline Scene shipped_scene(const std::string& name) {
  return load_scene(laterna::testing::data_folder() / "scenes" / (name + ".toml"));
}

/// The same without shadows, back faces and irradiance: each lit pixel shows the projector's picture as it
/// is.
inline Scene plain_scene(const std::string& name) {
  Scene scene = shipped_scene(name);
  scene.effects.shadow = scene.effects.irradiance = scene.effects.back_face = false;
  return scene;
}

/// Every texel another grey: what shows a wrong texel best.
inline Image<std::uint8_t> grains(glm::ivec2 size) {
  Image<std::uint8_t> slide(size.x, size.y);
  std::mt19937_64 random = laterna::testing::generator();
  for (auto& value : slide.values) value = std::uint8_t(random());
  return slide;
}

/// The same picture in floats, 0 to 1.
inline Image<float> in_floats(const Image<std::uint8_t>& slide) {
  Image<float> light(slide.width, slide.height);
  for (std::size_t i = 0; i < light.values.size(); ++i) light.values[i] = float(slide.values[i]) / 255;
  return light;
}

/// The luminance of a white facing plane at 1 m of the first object's albedo: without irradiance, that of
/// every point in white light.
inline double plain_saturation(const Scene& scene) {
  const Projector& projector = scene.projectors[0];
  const Intrinsics& k = projector.device.intrinsics;
  const double at_1_m = projector.flux_lm / (double(k.size.x) * k.size.y) * k.fx * k.fy;
  return luminance_cd_per_m2(scene.objects[0].albedo, at_1_m, 0);
}

/// Our 8-bit picture of one slide.
inline Image<std::uint8_t> our_picture(const Scene& scene, const laterna::testing::Traced& traced,
                                       const Image<std::uint8_t>& slide, double saturation) {
  const PatternStack pattern{slide.width, slide.height, 1, slide.values};
  const CapturedStack stack =
      capture_stack(traced.surface, traced.light, scene.projectors[0], pattern, 0, {8, saturation, 0, {}});
  const auto picture = std::get<ImageStack<std::uint8_t>>(stack).picture(0);
  Image<std::uint8_t> ours(traced.surface.width, traced.surface.height);
  std::ranges::copy(picture, ours.values.begin());
  return ours;
}

/// Prints what differs; in a test that has failed so far, keeps the pictures.
inline void report(const std::string& what, const Differences& found, const Image<std::uint8_t>& ours,
                   const Image<std::uint8_t>& theirs) {
  std::cout << what << ": " << text(found) << "\n";
  if (!::testing::Test::HasFailure()) return;
  const laterna::testing::ScratchFolder folder;
  write_picture(folder / (what + " where.png"), found.map);
  write_picture(folder / (what + " ours.png"), ours);
  write_picture(folder / (what + " theirs.png"), theirs);
}

}  // namespace laterna::gl
