// Lens distortion: a warp after the divide, in mrcal's lens models, for cameras and projectors alike.
#pragma once

#include "sim/intrinsics.h"

#include <glm/glm.hpp>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace laterna {

/// A lens as a file names it. `parameters` are those after fx, fy, cx, cy, in mrcal's order (OPENCV5:
/// k1,k2,p1,p2,k3).
struct Lens {
  std::string model = "LENSMODEL_PINHOLE";
  std::vector<double> parameters;
  bool operator==(const Lens&) const = default;
};

inline bool is_pinhole(const Lens& lens) { return lens.model == "LENSMODEL_PINHOLE"; }

/// How many parameters follow fx, fy, cx, cy. Throws InputError, naming the accepted models, for an unknown
/// one. Accepted: PINHOLE, STEREOGRAPHIC, OPENCV4, 5, 8, 12, CAHVOR and SPLINED_STEREOGRAPHIC_... (each with
/// a centre of projection and fx, fy, cx, cy).
int lens_parameter_count(const std::string& model);

/// A device's projection ready for use: intrinsics and lens. Immutable, cheap to copy, safe to share among
/// threads.
class LensProjection {
 public:
  /// Throws InputError for an unknown model, a wrong number of parameters, or one that is not finite.
  LensProjection(const Intrinsics& intrinsics, const Lens& lens);

  const Intrinsics& intrinsics() const { return intrinsics_; }
  bool is_pinhole() const { return !model_; }

  /// tan of the angle from the optical axis at which the lens folds over: the smallest radius, over all
  /// azimuths, where the Jacobian of (x/z, y/z) → pixel loses its positive determinant. Infinite where it
  /// never does (up to 89°).
  double fold_radius() const { return fold_radius_; }

  /// The pixel of a point in the device frame; none where z ≤ 0, beyond the fold, or where mrcal's model
  /// fails.
  std::optional<glm::dvec2> project(const glm::dvec3& x_device) const;

  /// The direction (x/z, y/z, 1) that a pixel looks along: Newton's method on mrcal's forward model from
  /// `start` (a neighbour's direction), then from the axis; ends with |project(unproject(p)) - p| ≤ 1e-9 px,
  /// or gives none.
  std::optional<glm::dvec3> unproject(const glm::dvec2& pixel,
                                      const std::optional<glm::dvec3>& start = {}) const;

  /// The warp: from the pixel that K alone gives (texture matrix T, after the divide) to the pixel with the
  /// lens.
  std::optional<glm::dvec2> warp(const glm::dvec2& pinhole_pixel) const;

  /// det ∂(u,v)/∂(x/z, y/z), in px²: fx·fy for a pinhole. The area of one pixel on the plane z = 1 is its
  /// inverse.
  double pixels_per_unit_area(const glm::dvec3& x_device) const;

 private:
  friend class LensGradient;
  struct Model;
  bool evaluate(const glm::dvec2& xy, glm::dvec2& pixel, glm::dmat2& dpixel_dxy) const;
  std::optional<glm::dvec2> newton(const glm::dvec2& pixel, glm::dvec2 xy) const;
  double find_fold_radius() const;

  Intrinsics intrinsics_;
  std::shared_ptr<const Model> model_;  // empty for a pinhole
  double fold_radius_;
};

/// mrcal's forward model with gradients, for solvers whose parameters move.
class LensGradient {
 public:
  explicit LensGradient(const std::string& model);
  /// 4 + lens_parameter_count(model).
  int parameter_count() const { return parameter_count_; }
  /// pixel = projection of x_device under parameters = (fx, fy, cx, cy, lens parameters...). Row-major
  /// gradients: dpixel_dx 2×3, dpixel_dparameters 2×parameter_count; either may be null. False where z ≤ 0 or
  /// a number is not finite.
  bool project(std::span<const double> parameters, const glm::dvec3& x_device, double pixel[2],
               double* dpixel_dx, double* dpixel_dparameters) const;

 private:
  std::shared_ptr<const LensProjection::Model> model_;  // empty for a pinhole
  int parameter_count_;
};

}  // namespace laterna
