// Sightings of a printed board by a known rig under one condition of the atlas.
#pragma once

#include "calib/boards/synthetic_boards.h"
#include "sim/fields.h"

#include <cstdint>
#include <string>

namespace laterna {

/// A camera of 1280×1024 and a projector of 1024×768 before a board of 9×7 corners at 60 mm.
struct BoardCondition {
  int poses = 8;
  double least_tilt_deg = 15, most_tilt_deg = 40;  ///< between the board's normal and the camera's axis
  double alike = 0;  ///< 0: poses as drawn; 1: all of them the first one; between: so near to it
  double camera_noise_px = 0.1, projector_noise_px = 0.2;
  double outliers = 0;  ///< share of sightings that are off by up to 30 px
  double bend_m = 0;    ///< of the board's middle over its edges
  double camera_k1 = 0, projector_k1 = 0;
  std::string lens = "auto";  ///< that is solved for: auto, or words as of `calibrate --lens`
  std::string bend = "auto";  ///< auto or off
};

template <class Visitor>
void describe(Visitor& visit, BoardCondition& c) {
  visit(Field{.key = "poses", .low = 1, .high = 200}, c.poses);
  visit(Field{.key = "least_tilt_deg", .unit = "deg", .low = 0, .high = 80}, c.least_tilt_deg);
  visit(Field{.key = "most_tilt_deg", .unit = "deg", .low = 0, .high = 80}, c.most_tilt_deg);
  visit(Field{.key = "alike", .low = 0, .high = 1}, c.alike);
  visit(Field{.key = "camera_noise_px", .unit = "px", .low = 1e-6, .high = 100}, c.camera_noise_px);
  visit(Field{.key = "projector_noise_px", .unit = "px", .low = 1e-6, .high = 100}, c.projector_noise_px);
  visit(Field{.key = "outliers", .low = 0, .high = 1}, c.outliers);
  visit(Field{.key = "bend_m", .unit = "m", .low = -0.1, .high = 0.1}, c.bend_m);
  visit(Field{.key = "camera_k1", .low = -1, .high = 1}, c.camera_k1);
  visit(Field{.key = "projector_k1", .low = -1, .high = 1}, c.projector_k1);
  visit(Field{.key = "lens"}, c.lens);
  visit(Field{.key = "bend"}, c.bend);
}

struct BoardProblem {
  synthetic::BoardTruth truth;
  BoardCapture capture;  ///< with noise and outliers
};

/// The same seed gives the same problem.
BoardProblem board_problem(const BoardCondition& condition, std::uint64_t seed);

/// The projector's volume error of a rig whose poses are those of the truth with the given indices: over
/// 16×12 pixels of the whole picture × 12 depths over 5-95 % of the board points', points fixed on the boards
/// (rig_covariance.h: carried_pixel()), rms. Infinite where a point ends up behind.
double board_volume_error_px(const BoardProblem& problem, const RigModel& model, const BoardRig& rig,
                             const std::vector<int>& poses);

/// What noise alone does to it, by the covariance of the joint adjustment at the truth under the true model.
/// NaN where that is not determined.
double board_volume_bound_px(const BoardProblem& problem);

}  // namespace laterna
