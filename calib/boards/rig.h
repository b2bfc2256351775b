// A rig of devices and the board's poses while they are solved for, and which of their parameters are free.
//
// Frames: camera is the frame of device 0; board has its points in it. x_camera = camera_from_board·(x_board
// + bend), x_device = device_from_camera·x_camera, pixel = lens(x_device).
#pragma once

#include "calib/boards/board_capture.h"
#include "calib/intrinsics_prior.h"
#include "sim/device.h"

#include <string>
#include <vector>

namespace laterna {

/// A lens model and what of it is solved for. A parameter that is not free keeps its start value, 0 for a
/// lens parameter.
struct DeviceModel {
  std::string lens_model = "LENSMODEL_PINHOLE";
  std::vector<bool> lens_free;    ///< one per lens parameter
  bool one_focal_length = false;  ///< fx = fy
  bool fixed_center = false;      ///< cx, cy stay at the middle of the image
  bool known = false;             ///< intrinsics and lens stay at their start, the place is free
  bool held = false;              ///< nothing is free, neither intrinsics nor place
  bool held_core = false;         ///< fx, fy, cx, cy stay at their start, as with a splined lens
  IntrinsicsPrior prior{};        ///< of what is free; empty: nothing is known
};

/// Distortion terms in the order in which they stand in OpenCV's models: k1, k2, p1p2 (one term), k3, k456
/// (rational, one term), s1234 (thin prism, one term). The smallest of PINHOLE, OPENCV4, 5, 8 and 12 that has
/// all of them, with the others held at 0. Or one splined model by mrcal's name, its core held and all knots
/// free. Throws InputError for an unknown term.
DeviceModel model_of_terms(const std::vector<std::string>& terms);

/// The terms that a word of the command line stands for: pinhole (none), k1, k1k2, k1k2p1p2 or opencv4,
/// opencv5, opencv8, opencv12, several terms joined by + (k1+p1p2), splined, or mrcal's name of a splined
/// model (itself). Throws InputError, naming the words, for another one.
std::vector<std::string> lens_terms(const std::string& word);

/// Whether they are `splined`, whose grid depends on what the device sees (rig_splines.h), or a splined
/// model.
bool are_splined(const std::vector<std::string>& terms);

/// "pinhole", "k1+k2" or "splined 9x6" (Nx, Ny).
std::string terms_text(const std::vector<std::string>& terms);

struct RigModel {
  std::vector<DeviceModel> devices;
  bool bend = false;        ///< the board's bend is free
  bool hold_poses = false;  ///< the board's poses are not solved for
};

struct RigDevice {
  std::vector<double> parameters;  ///< fx, fy, cx, cy (px), lens parameters
  Rigid device_from_camera;
};

struct BoardRig {
  std::vector<RigDevice> devices;
  std::vector<Rigid> camera_from_board;  ///< one per pose
  /// Height of the board's middle over its edges, as if bent about y and about x: z + bend.x·(1 - x²) +
  /// bend.y·(1 - y²), with x and y in [-1, 1] over the extent (mrcal's calobject_warp).
  glm::dvec2 bend{0.0};
};

/// How far the bend lifts a board point, by a unit of bend.x and of bend.y.
inline glm::dvec2 bend_shape(const glm::dvec3& x_board, const BoardExtent& extent) {
  const glm::dvec2 at = (glm::dvec2(x_board) - extent.center) / extent.half_size;
  return 1.0 - at * at;
}
inline glm::dvec3 bent(const glm::dvec3& x_board, const BoardExtent& extent, const glm::dvec2& bend) {
  return {x_board.x, x_board.y, x_board.z + glm::dot(bend, bend_shape(x_board, extent))};
}

/// Where the free parameters stand among the global columns: for each device its intrinsics, then (not for
/// device 0) rotation and translation; the bend last. Poses have columns of their own.
struct RigColumns {
  struct Of {
    std::vector<int> intrinsics;  ///< one per parameter; -1 where held; fx and fy may share one
    int pose = -1;                ///< rotation (3), translation (3); -1 where held
  };
  std::vector<Of> devices;
  int bend = -1;  ///< two columns
  int count = 0;
};
RigColumns columns_of(const RigModel& model);

/// "camera fx", "projector k1", "projector rotation_x", "bend_x": one per global column.
std::vector<std::string> column_names(const RigModel& model, const BoardCapture& capture);

/// k1, k2, p1, ... for OpenCV's models; knot7_x, knot7_y for splined ones; lens0, ... for others.
std::string lens_parameter_name(const std::string& lens_model, int index);

/// Moves a rig: intrinsics and bend by addition, rotations R = exp([w]×)·R̂ in the target frame, translations
/// by addition. `global` has columns.count entries, `poses` 6 per pose (may be empty).
BoardRig moved(const BoardRig& rig, const RigColumns& columns, const std::vector<double>& global,
               const std::vector<double>& poses);
/// The inverse: the step that takes `from` to `to`.
std::vector<double> global_step(const BoardRig& from, const BoardRig& to, const RigColumns& columns);

/// Fits a rig's intrinsics to a model: lens parameters added as 0 or cut, held and known ones kept, fx and fy
/// made one, the centre put into the middle of the image; a spline that comes new starts at its prior's mean.
BoardRig fitted_to(BoardRig rig, const RigModel& model, const BoardCapture& capture);

/// Device d of the rig as the rest of Laterna knows it; device_from_world is device_from_camera, lengths in
/// the capture's unit.
Device device_of(const BoardRig& rig, const RigModel& model, const BoardCapture& capture, int d);

}  // namespace laterna
