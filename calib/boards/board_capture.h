// What a rig of devices saw of a board that was held in several poses.
#pragma once

#include "sim/device.h"

#include <glm/glm.hpp>

#include <optional>
#include <string>
#include <vector>

namespace laterna {

/// A camera or a projector of the rig, as far as it is known before calibrating.
struct BoardDevice {
  std::string name;
  glm::ivec2 size{0, 0};          ///< W, H in pixels
  std::optional<Device> known{};  ///< intrinsics and lens; its placement is passed over
  bool is_camera = false;         ///< it sees the board; device 0 does in any case
  /// Standard deviations of what is known: fx, fy, cx, cy (px), lens parameters, independent of one another;
  /// 0 is exact (as in solve.h). Empty, or all 0: exact, and held. Else a prior, and solved for with the
  /// rest.
  std::vector<double> known_sigma{};
};

/// The camera's sighting at which a projector's pixel was read. Its error e moves that pixel by slope·e,
/// slope being the derivative of the projector's pixel by the camera's on the board; predict() (rig_rows.h)
/// takes that back, so that the two are independent.
struct ReadAt {
  int device = 0;
  glm::dvec2 pixel{0.0};
  glm::dmat2 slope{0.0};
};

/// A point of the board and the pixel at which a device sees it or, for a projector, lights it. Integer
/// coordinates are pixel centres.
struct Sighting {
  int device = 0, pose = 0;  ///< indices into BoardCapture::devices and ::pose_labels
  int corner = 0;            ///< the file's own number, for messages only
  glm::dvec3 x_board{0.0};   ///< in the capture's unit of length
  glm::dvec2 pixel{0.0};
  double sigma_px = 1;              ///< per coordinate; of the reading alone where it is `read_at`
  std::optional<ReadAt> read_at{};  ///< none: pixels of different devices are independent
};

/// The board's extent in x and y, over which it may bend: (x - center)/half_size is in [-1, 1].
struct BoardExtent {
  glm::dvec2 center{0.0}, half_size{1.0};
};

/// Devices, poses and sightings. The frame of device 0 is the rig's: it must be a camera; a pose that
/// it does not see hangs on another camera's. Lengths are in one unit, whichever it is; translations come out
/// in it.
struct BoardCapture {
  std::vector<BoardDevice> devices;
  std::vector<int> pose_labels;  ///< the file's own numbers
  std::vector<Sighting> sightings;
  BoardExtent extent;

  int pose_count() const { return int(pose_labels.size()); }
};

/// Throws InputError where a size is unusable, an index is out of range, a number is not finite, a sigma is
/// not positive, known intrinsics are unsound or of another size, or a pixel lies outside its device's image
/// by more than a tenth of the size.
void validate(const BoardCapture& capture);

/// Completes what a table tells: sightings whose `pose` is the file's own number get indices into
/// pose_labels, which become these numbers in their order; the extent is that of all points. Throws
/// InputError, beginning with the file, for what validate() refuses.
void complete_table(BoardCapture& capture, const std::string& file_name);

/// The extent of all board points in x and y.
BoardExtent extent_of(const std::vector<Sighting>& sightings);

/// The poses with the given indices, in that order; the board's extent stays.
BoardCapture with_poses(const BoardCapture& capture, const std::vector<int>& poses);

/// All poses but one.
BoardCapture without_pose(const BoardCapture& capture, int pose);

/// Whether a device sees the board, as device 0 does; a projector's pixels are read at what cameras see.
inline bool is_camera(const BoardCapture& capture, int device) {
  return device == 0 || capture.devices[std::size_t(device)].is_camera;
}

/// The sightings of all cameras; devices and poses keep their indices.
BoardCapture seen_by_cameras(const BoardCapture& capture);

/// The sightings of one device alone; devices and poses keep their indices.
BoardCapture seen_by(const BoardCapture& capture, int device);

}  // namespace laterna
