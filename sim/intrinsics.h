// The pinhole part of a projector or a camera: fx, fy, cx, cy over an image of W×H pixels.
#pragma once

#include <glm/glm.hpp>

namespace laterna {

/// u = fx·x/z + cx, v = fy·y/z + cy, in pixels; (x, y, z) in the device frame (x right, y down, z forward).
/// Integer coordinates are pixel centres. (cx, cy) may lie outside the image: lens shift.
struct Intrinsics {
  glm::ivec2 size{0, 0};  ///< W, H in pixels
  double fx = 0, fy = 0, cx = 0, cy = 0;
};

/// Throws InputError, beginning with `what`, where the size is not in [1, 16384]², a number is not finite, or
/// a focal length is not positive.
void validate(const Intrinsics& intrinsics, const char* what);

/// From throw ratio (distance over picture width) and lens shift (fraction of the picture's width and
/// height):
///   fx = fy = throw_ratio·W,  cx = (W-1)/2 + lens_shift.x·W,  cy = (H-1)/2 + lens_shift.y·H.
/// Positive lens_shift.y moves the picture up, positive lens_shift.x moves it to the left as the device sees
/// it. With 0.5 the axis goes through the picture's lower edge: what makers call "100 % offset".
Intrinsics intrinsics_from_throw(glm::ivec2 size, double throw_ratio, glm::dvec2 lens_shift);

/// As gluPerspective: full vertical angle and aspect (picture width over height as it lands on a facing
/// plane), centred:
///   fy = H / (2·tan(fov_y/2)),  fx = W / (2·aspect·tan(fov_y/2)).  0 < fov_y_rad < π.
Intrinsics intrinsics_from_fov_y(glm::ivec2 size, double fov_y_rad, double aspect);

/// The same from the full horizontal angle: fx = W / (2·tan(fov_x/2)), fy = aspect·H / (2·tan(fov_x/2)).
Intrinsics intrinsics_from_fov_x(glm::ivec2 size, double fov_x_rad, double aspect);

}  // namespace laterna
