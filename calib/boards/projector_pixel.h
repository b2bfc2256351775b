// The projector pixel that lights a given point of a flat board, to a fraction of a pixel.
#pragma once

#include "calib/decoded_map.h"

#include <glm/glm.hpp>

#include <optional>

namespace laterna {

/// How projector pixels run over camera pixels around a point of a plane.
enum class LocalMap {
  homography,  ///< 8 parameters: true for two pinhole devices; the baseline of the literature
  quadratic    ///< 12 parameters: all second-order terms, perspective's and those of both lenses
};

struct LocalFitOptions {
  LocalMap map = LocalMap::quadratic;
  double radius_px = 12;  ///< of the disc of camera pixels that are used
  int least_pixels = 64;  ///< valid ones in it that agree
};

struct ProjectorPixel {
  glm::dvec2 pixel{0.0};
  glm::dmat2 slope{0.0};    ///< column j: derivative of the pixel by camera x, y
  double sigma_px = 0;      ///< of each coordinate, from the fit's residuals
  double residual_px = 0;   ///< sqrt(mean(du² + dv²)) of the pixels used
  int used = 0, valid = 0;  ///< pixels of the disc that agree, and that are decoded
};

/// Fits u and v over the decoded pixels within `radius_px` of a camera point and reads the fit there.
/// Outliers of the decoding are left out first: those beyond three times the median residual, and at least
/// one projector pixel, of a homography by least median of squares (cv::findHomography, which needs less than
/// half of them wrong). Then least squares with weights 1/σ² of the map.
///
/// A homography leaves out the lenses' second-order terms, which move what is read at the centre; the
/// quadratic leaves out third-order terms, which are odd about the centre of a whole disc and move nothing
/// there. None where fewer than `least_pixels` agree, or where their mean lies more than a third of the
/// radius off: that would be extrapolation.
std::optional<ProjectorPixel> projector_pixel_at(const DecodedMap& map, const glm::dvec2& camera_px,
                                                 const LocalFitOptions& options = {});

}  // namespace laterna
