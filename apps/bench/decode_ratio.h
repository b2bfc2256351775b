// What decoding costs beside reading the pictures, beside OpenCV, and beside libm.
#pragma once

namespace laterna {

/// Medians over repeats of ratios within each repeat, on one thread: 44 Gray pictures of 1280×800 for a
/// projector of the same size, and four steps of a fringe of the same size (best of three passes each).
struct DecodeTimes {
  double gray_over_read = 0;  ///< decode_gray_codes over summing the bytes of the same pictures
  double opencv_over_gray =
      0;  ///< OpenCV's getProjPixel, per pixel, over decode_gray_codes: the same columns and rows
  double atan2_over_phase = 0;   ///< mean, c, s and angle with libm's atan2 in double, over fit_fringe
  double atan2f_over_phase = 0;  ///< the same in float
  double atan2_over_fit = 0;  ///< the peer in double, without any sigma, over the fit with each pixel's sigma
  double phase_ns = 0;        ///< fit_fringe, per pixel
};

/// Throws std::runtime_error where OpenCV decodes something else, or the phases differ by more than 5e-6 rad.
DecodeTimes time_decode(int repeats);

}  // namespace laterna
