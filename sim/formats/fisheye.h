// OpenCV's fisheye lens, which kalibr and ROS call equidistant, as a lens of ours.
#pragma once

#include "sim/formats/rig.h"

#include <span>
#include <string>

namespace laterna {

/// With θ the angle from the axis and r = |(x, y)|, a file's model is
///
///   (u, v) = (fx, fy)·θ_d·(x, y)/r + (cx, cy),   θ_d = θ + k1·θ³ + k2·θ⁵ + k3·θ⁷ + k4·θ⁹
///
/// (Kannala and Brandt 2006; OpenCV, "Fisheye camera model"; in pixels, centres at whole numbers). It becomes
/// mrcal's LENSMODEL_SPLINED_STEREOGRAPHIC with the same fx, fy, cx, cy (sim/spline_knots.h), whose shift Δu
/// is a tensor product of cubic splines through (θ_d/|u| - 1)·u at the knots: 12×12 of them, or as many more,
/// up to 96×96, as bring the largest difference over the image below 0.002 px. That difference, taken over
/// rays of 65×65 pixels from edge to edge, is told in a note: `lens of "cam0": ...`. The same input gives the
/// same bits.
///
/// `device` has its name and its intrinsics. Throws InputError, beginning with `place`, for intrinsics that
/// are unsound (a size that is not known is one), another number of coefficients than four, one beyond ±1e4,
/// a difference that stays above 0.02 px, and a pixel that looks further from the axis than 85°, or beyond
/// where θ_d folds over.
Lens lens_from_fisheye(const Device& device, std::span<const double> k, const std::string& place,
                       Notes& notes);

}  // namespace laterna
