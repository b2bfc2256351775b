// What a classic begins with: its scene, the core's view of it, the fragments that passes draw; and how
// pictures compare.
#pragma once

#include "apps/lab/classics/core_picture.h"
#include "apps/lab/classics/panels.h"
#include "apps/lab/classics/passes.h"

#include <filesystem>
#include <string>
#include <vector>

namespace laterna {

/// A scene with one projector and a slide. The frame buffer's 1 is the ambient light and the slide's white
/// together, at a point where irradiance is off.
struct ClassicDemo {
  Scene scene;
  CoreView view;
  Fragments fragments;
  Image<float> slide;
  double white_lx;  ///< of the slide's white, without irradiance: what a facing plane at 1 m gets
  double full_lx;   ///< with the ambient light
  double white;     ///< luminance in cd/m² of the first object's plain albedo in full_lx

  /// `set` as load_scene has it.
  explicit ClassicDemo(const std::filesystem::path& file, const std::vector<std::string>& set = {});
  explicit ClassicDemo(Scene scene_to_show);
  ClassicDemo(const ClassicDemo&) = delete;
  ClassicDemo& operator=(const ClassicDemo&) = delete;
  const Projector& projector() const { return scene.projectors[0]; }

  /// The frame buffer after each pass, in `steps` as FrameBuffer has them; options.share is set here.
  std::vector<Image<double>> passes(SlideOptions options, int steps = 0) const;

  /// The core's picture in the frame buffer's scale.
  Image<double> core() const;

  /// (s, t, r, q) at each pixel.
  PixelArray<glm::dvec4> coordinates(CoordinateSource source) const {
    return texture_coordinates(view.surface, scene, scene.cameras[0], projector(), source);
  }

  /// How far s/q and t/q are from the core's (u, v), in projector pixels, at most, over lit pixels.
  double core_distance_px(const PixelArray<glm::dvec4>& strq) const;
};

/// For the eye: `white` and above is white.
Canvas shown(const Image<double>& image, double white = 1);

double greatest_difference(const Image<double>& a, const Image<double>& b);
double rms_difference(const Image<double>& a, const Image<double>& b);

/// Of all pixels, those whose values differ by more than a millionth.
double share_that_differs(const Image<double>& a, const Image<double>& b);

}  // namespace laterna
