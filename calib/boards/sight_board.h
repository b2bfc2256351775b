// A found board and a decoded map to sightings by camera and projector.
#pragma once

#include "calib/boards/board_capture.h"
#include "calib/boards/find_board.h"
#include "calib/boards/projector_pixel.h"

#include <optional>
#include <vector>

namespace laterna {

/// How well a projector's pixels could be read at a board's points.
struct BoardReading {
  std::size_t points = 0;  ///< that got a projector pixel
  double median_residual_px =
      0;  ///< of the local fits, projector pixels, sqrt(mean(du² + dv²)) each; 0 without points
};

/// The camera's sightings of a board in pose `pose` (an index): `sigma_px` is a tenth of a pixel, what
/// OpenCV's corners are good for; the adjustment estimates it anew.
void add_camera_sightings(const std::vector<FoundPoint>& found, const PrintedBoard& board, int device,
                          int pose, std::vector<Sighting>& sightings);

/// A projector's sightings of the same: projector_pixel_at() at each point, over a disc of `share` of the
/// distance to the nearest other point, at most 40 and at least 5 camera pixels. Their sigma is of the
/// reading alone: that the camera's point is itself uncertain moves the projector's pixel by the map's slope
/// (ReadAt, of device `camera`). Points without a reading are left out.
BoardReading add_projector_sightings(const std::vector<FoundPoint>& found, const PrintedBoard& board,
                                     const DecodedMap& map, int device, int pose, LocalMap local,
                                     std::vector<Sighting>& sightings, double share = 0.45, int camera = 0);

}  // namespace laterna
