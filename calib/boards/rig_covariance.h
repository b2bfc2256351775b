// How sure a rig is: the covariance of everything that was solved for, and of the pixels that it predicts.
#pragma once

#include "calib/boards/adjust.h"

#include <optional>
#include <vector>

namespace laterna {

/// (JᵀJ)⁻¹ of all free parameters (tangent, as moved() takes them), from the pose factors: the global block,
/// and for pose k with the rows [P G] of its factor, A_k = -P⁻¹·G and the rest that is its own. A step of
/// pose k is A_k·δ_global + ε_k with ε_k independent. This is the Cramér-Rao bound where the sigmas are true.
struct RigCovariance {
  int globals = 0;
  std::vector<double> global;  ///< row-major globals²
  std::vector<std::vector<double>>
      pose_from_global;                       ///< A_k, row-major 6×globals; empty where poses are held
  std::vector<std::vector<double>> pose_own;  ///< covariance of ε_k, row-major 6×6
  std::vector<double> factor;  ///< R of all rows [J_global r], poses eliminated; (globals + 1)², row-major
};

/// None where the factors do not determine every parameter (last over first singular value of the scaled
/// columns at most 1e-10).
std::optional<RigCovariance> rig_covariance(const RigProblem& problem, const Adjustment& adjustment);

/// The triangular factor with all poses eliminated, as in RigCovariance, whether it has full rank or not.
std::vector<double> eliminated_factor(const RigProblem& problem, const Adjustment& adjustment);

/// Row-major (globals + 6·poses)²: the global parameters, then the poses.
std::vector<double> full_covariance(const RigCovariance& covariance);

/// The covariance of the pixel at which device d puts a point, when the point is fixed on the boards (mrcal's
/// way): x_device is carried to each board pose by the rig, and comes back through the perturbed rig as the
/// mean over the poses. So it holds what intrinsics, places and board poses do together, at the point's place
/// and range. (uu, uv, vv) in px²; none where the point lies behind.
std::optional<glm::dvec3> pixel_covariance(const RigProblem& problem, const BoardRig& rig,
                                           const RigCovariance& covariance, int device,
                                           const glm::dvec3& x_device);

/// The same of a point that is fixed in the camera's frame: what verify() compares where the truth's camera
/// frame is taken for the estimate's. A camera's centre that is a pixel off turns its frame by a pixel, which
/// boards, and points triangulated by the same rig, turn with: this is then much larger than
/// pixel_covariance().
std::optional<glm::dvec3> pixel_covariance_in_camera(const RigProblem& problem, const BoardRig& rig,
                                                     const RigCovariance& covariance, int device,
                                                     const glm::dvec3& x_device);

/// The map of pixel_covariance() without linearising: where device d of `to` puts the point that device d of
/// `from` has at x_device. `poses[i]` is the index in `from` of pose i of `to`. None where it lies behind.
std::optional<glm::dvec2> carried_pixel(const LensGradient& lens, const BoardRig& from, const BoardRig& to,
                                        const std::vector<int>& poses, int device,
                                        const glm::dvec3& x_device);

}  // namespace laterna
