// Light adds up: the pictures of a group sum to count/2·(white + black), at every pixel and on every edge.
// What is left over is noise, or tells that something is wrong.
#pragma once

#include "sim/image_view.h"
#include "sim/pattern_sequence.h"

#include <vector>

namespace laterna {

/// One standard deviation, in the stack's own DN, of one value of one picture, where white - black >
/// `min_white_minus_black` (also in the stack's own DN): 1.4826·median(|rest|/sqrt(n + n²/2)) over groups of
/// n ≥ 2 pictures, rest = Σ I - n/2·(white + black). Robust against pixels that saturate or move. Taken from
/// up to about 4000 pixels on a regular grid; 0 where nothing is lit.
double sum_noise_dn(const CapturedView& pictures, const std::vector<PatternGroup>& groups,
                    double min_white_minus_black);

/// The same for one group, from the values within three sigmas (root mean square, corrected for the cut):
/// finer than a median of whole numbers.
double group_noise_dn(const CapturedView& pictures, const PatternGroup& group, double min_white_minus_black);

/// How far the pictures of a group are from that sum, on the same grid: the mean of |rest|/(sqrt(n +
/// n²/2)·(white - black)). 1.5 DN of noise at a contrast of 100 give 0.012, a dropped picture of a pair 0.25,
/// of four steps 0.13.
struct GroupMisfit {
  PatternGroup group;
  double misfit = 0;
};
std::vector<GroupMisfit> sum_misfits(const CapturedView& pictures, const std::vector<PatternGroup>& groups,
                                     double min_white_minus_black);

/// Black is the darkest picture and white the brightest: the share of pixels, on the same grid, where some
/// picture lies outside by more than a quarter of the pixel's whole range, where that range is above
/// `min_white_minus_black`.
double outside_black_and_white(const CapturedView& pictures, double min_white_minus_black);

/// Full scale of a stack in DN: 255, or 2^b - 1 with the fewest bits b from 8 to 16 that hold the white
/// picture (the last but one).
double full_scale_dn(const CapturedView& pictures);

}  // namespace laterna
