// Ways of calibrating from boards beside each other: time on the same corners, and error over the bound.
#pragma once

#include <string>
#include <vector>

namespace laterna {

/// Medians of ratios within each repeat, on one simulated capture with OpenCV's four lens terms on both
/// devices.
struct BoardTimes {
  int corners = 0;               ///< that the projector lights
  double opencv_over_joint = 0;  ///< OpenCV's stepwise over one joint solve, starts included
  double mrcal_over_joint = 0;   ///< mrcal's over the same
  double joint_seconds = 0;
};

/// Boards of 63 corners in so many poses.
BoardTimes time_boards(int poses, int repeats);

/// What one method made of many simulated captures.
struct MethodScore {
  std::string name;
  int rigs = 0, failures = 0;
  double over_bound = 0;  ///< median over captures of volume rms error / bound; infinite where most fail
  double error_px = 0;    ///< median volume rms error
  double seconds = 0;     ///< median of one solve
};

/// Every method on `rigs` captures of random poses and noise (8 poses, camera 0.1 px, projector 0.2 px). The
/// error is that of the projector pixels of points fixed on the boards (carried_pixel), over 5×4 places of
/// its image × the ranges 1.0, 1.4 and 1.8 m; the bound is the Cramér-Rao bound of the same at the truth.
std::vector<MethodScore> score_board_methods(int rigs);

std::string method_scores_text(const std::vector<MethodScore>& scores);

}  // namespace laterna
