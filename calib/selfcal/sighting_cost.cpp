#include "calib/selfcal/sighting_cost.h"

#include "calib/projection_rows.h"
#include "sim/rigid.h"

#include <cmath>

namespace laterna {

namespace {

class SightingCost : public ceres::CostFunction {
 public:
  SightingCost(const LensGradient& lens, const TrackSighting& sighting, bool one_focal)
      : lens_(lens), pixel_(sighting.pixel), inverse_sigma_(1 / sighting.sigma_px), one_focal_(one_focal) {
    set_num_residuals(2);
    for (const int size : {lens.parameter_count(), 6, 3}) mutable_parameter_block_sizes()->push_back(size);
  }

  bool Evaluate(const double* const* blocks, double* residuals, double** jacobians) const override {
    const int k = lens_.parameter_count(), p = k + 6;
    const double *place = blocks[1], *point = blocks[2];
    thread_local ProjectorState state;
    thread_local std::vector<double> rows;
    state.parameters.assign(blocks[0], blocks[0] + k);
    for (int i = 0; i < 4; ++i) state.parameters[i] *= track_pixel_scale;
    if (one_focal_) state.parameters[1] = state.parameters[0];
    const glm::dvec3 turn(place[0], place[1], place[2]);
    state.device_from_points = rigid_from_rotation_vector(turn, {place[3], place[4], place[5]});
    rows.resize(2 * std::size_t(p));
    double pixel[2];
    if (!project_with_rows(lens_, state, {point[0], point[1], point[2]}, pixel,
                           jacobians ? rows.data() : nullptr))
      return false;
    residuals[0] = (pixel[0] - pixel_.x) * inverse_sigma_;
    residuals[1] = (pixel[1] - pixel_.y) * inverse_sigma_;
    for (int r = 0; jacobians && r < 2; ++r) {
      double* row = rows.data() + r * p;
      for (int i = 0; i < p; ++i) row[i] *= inverse_sigma_;
      if (jacobians[0]) by_intrinsics(row, jacobians[0] + r * k);
      if (jacobians[1]) by_place(row + k, turn, jacobians[1] + 6 * r);
      if (jacobians[2]) {
        const glm::dvec3 g =
            glm::dvec3(row[k + 3], row[k + 4], row[k + 5]) * state.device_from_points.rotation;
        for (int i = 0; i < 3; ++i) jacobians[2][3 * r + i] = g[i];
      }
    }
    return true;
  }

 private:
  void by_intrinsics(const double* row, double* out) const {
    for (int i = 0; i < lens_.parameter_count(); ++i) out[i] = row[i] * (i < 4 ? track_pixel_scale : 1);
    if (one_focal_) out[0] += out[1], out[1] = 0;
  }

  static void by_place(const double* row, const glm::dvec3& turn, double* out) {
    const glm::dvec3 g = glm::dvec3(row[0], row[1], row[2]) * left_jacobian(turn);
    for (int i = 0; i < 3; ++i) out[i] = g[i], out[3 + i] = row[3 + i];
  }

  LensGradient lens_;
  glm::dvec2 pixel_;
  double inverse_sigma_;
  bool one_focal_;
};

}  // namespace

glm::dmat3 left_jacobian(const glm::dvec3& w) {
  const double angle = glm::length(w), squared = angle * angle;
  const glm::dmat3 cross(0, w.z, -w.y, -w.z, 0, w.x, w.y, -w.x, 0);  // columns
  // (1 - cos)/θ² and (θ - sin)/θ³, or their series where these lose digits.
  const double half = std::sin(angle / 2);
  const double b = angle > 1e-4 ? 2 * half * half / squared : 0.5 - squared / 24;
  const double c = angle > 1e-2 ? (angle - std::sin(angle)) / (squared * angle)
                                : 1.0 / 6 - squared / 120 + squared * squared / 5040;
  return glm::dmat3(1.0) + b * cross + c * cross * cross;
}

std::unique_ptr<ceres::CostFunction> sighting_cost(const LensGradient& lens, const TrackSighting& sighting,
                                                   bool one_focal) {
  return std::make_unique<SightingCost>(lens, sighting, one_focal);
}

}  // namespace laterna
