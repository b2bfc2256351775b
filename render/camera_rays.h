// The direction that each pixel of a camera looks along, found once.
#pragma once

#include "render/pixel_array.h"
#include "sim/device.h"

#include <glm/glm.hpp>

namespace laterna {

/// Directions in the camera's frame, scaled to z = 1, so that a ray's parameter is the axial depth in metres.
class CameraRays {
 public:
  /// Unprojects all W×H pixel centres; each starts from its left neighbour, rows stand alone. A pinhole needs
  /// no table.
  explicit CameraRays(const Device& camera);

  int width() const { return width_; }
  int height() const { return height_; }

  /// (x/z, y/z) of pixel (x, y); NaN where the lens fails.
  glm::dvec2 direction(int x, int y) const {
    if (pinhole_) return {(x - cx_) * inverse_fx_, (y - cy_) * inverse_fy_};
    return table_(x, y);
  }

  /// The directions of the 4×4 pixels from `first` on, row by row: x/z and y/z.
  void tile(const glm::ivec2& first, double* x, double* y) const {
    for (int lane = 0; lane < 16; ++lane) {
      const glm::dvec2 d = direction(first.x + lane % 4, first.y + lane / 4);
      x[lane] = d.x, y[lane] = d.y;
    }
  }

  /// The same at (x, y) + offset, within half a pixel each way: exact for a pinhole, else by the slope
  /// between the pixel's neighbours, which is off by the lens's curvature over a pixel, some 1e-5 px; NaN
  /// where a neighbour has no direction.
  glm::dvec2 direction(int x, int y, const glm::dvec2& offset_px) const {
    if (pinhole_) return {(x + offset_px.x - cx_) * inverse_fx_, (y + offset_px.y - cy_) * inverse_fy_};
    return table_(x, y) + slope(x, y, 1, 0) * offset_px.x + slope(x, y, 0, 1) * offset_px.y;
  }

 private:
  glm::dvec2 slope(int x, int y, int along_x, int along_y) const;

  int width_, height_;
  bool pinhole_;
  double cx_, cy_, inverse_fx_, inverse_fy_;
  PixelArray<glm::dvec2> table_;
};

}  // namespace laterna
