// A cloud of points as the table of correspondences that a calibration starts from.
#pragma once

#include "sim/formats/point_cloud.h"

#include <string>

namespace laterna {

/// Up to `most_points` of the cloud, evenly spread, as the table that `laterna calibrate FILE.csv` reads: one
/// pose of a board that has relief, whose corners are the points. With camera and projector pixels that of
/// calib/boards/correspondence_csv.h, with those of one device alone that of sighting_csv.h, the device being
/// called "camera" or "projector". Throws InputError, beginning with `name`, for a cloud without pixels.
std::string cloud_table(const PointCloud& cloud, std::size_t most_points, const std::string& name);

}  // namespace laterna
