// What pictures tell about a wrong calibration, beside the truth that they should show.
#pragma once

#include "apps/lab/score/suspects.h"
#include "calib/correspondences.h"
#include "render/direct_light.h"
#include "sim/pattern_sequence.h"
#include "sim/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace laterna {

/// Each lit camera pixel (up to 4,000, at least a tenth of the full scale between its darkest and brightest
/// picture, nowhere saturated but in binary codes) measures a share m_k of its range in picture k, and should
/// measure that of the pattern at its true projector pixel, p_k. D = Σ(m_k - p_k)² over pixels and pictures.
///
///   dropped_frame   some pictures show other patterns of the sequence better: each D_k falls below a third
///                   of what it was, from above 0.05 a pixel, and their sum below a tenth; and as they stand
///                   best, all agree: below 0.05 a pixel on the mean. explains = 1 - D(as they stand best)/D.
///                   So are exchanged and repeated pictures named. Missing pictures are the reader's
///                   (score.h).
///   axes_exchanged  most pictures do, with a pattern of the other axis
///   y_flipped       the camera's pictures, upside down, mirrored left to right or turned by half a circle,
///                   take away 0.8 of D, and more than another order does; the words say which
///   gamma           none of these, and of the fringes: m_k follows p_k^γ with γ outside [0.9, 1.1], takes
///                   away half of D over them, and shifts places by more than 0.01 px (bent_response.h).
///                   explains = that share. Black and white codes show no gamma, and it does them no harm.
///
/// Nothing is said of families without coded groups, or where fewer than 100 pixels can be looked at. The
/// sequence's pictures are those that come into the projector's scaler.
std::vector<Suspect> picture_suspects(const Scene& scene, int projector, const LightMap& truth,
                                      const CapturedStack& pictures, const PatternSequence& sequence);

/// keystone: a free 11-parameter matrix (dlt.h) fits what was decoded better than the best projector of the
/// given lens model, whose K has no skew: explains = 1 - (rms of the matrix)²/(rms of the projector)², of up
/// to 3,000 correspondences, named from a half on. None where either is refused.
std::optional<Suspect> keystone_suspect(const Correspondences& decoded, glm::ivec2 projector_size,
                                        const std::string& lens_model);

}  // namespace laterna
