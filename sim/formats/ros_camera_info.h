// ROS's camera_info files, as camera_calibration and camera_info_manager keep them: one device each, without
// a place.
//
//   image_width, image_height, camera_name, camera_matrix: {rows: 3, cols: 3, data}, distortion_model:
//   plumb_bob (k1, k2, t1, t2, k3), rational_polynomial (k1, k2, t1, t2, k3, k4, k5, k6) or, read only,
//   equidistant, also called fisheye (k1, k2, k3, k4), as a spline (fisheye.h),
//   distortion_coefficients: {rows, cols, data}, rectification_matrix, projection_matrix
//
// There and here alike: pixel centres at whole numbers, u right, v down, x right, y down, z forward; K row by
// row; t1, t2 are OpenCV's p1, p2. A stereo pair's rectification R and projection P say where a device
// stands: x_rectified = R·x_device, and P's last column is -f'·B of a second device B metres to the right
// (below), so
//   x_device = Rᵀ·(x_world + (P03/P00, P13/P11, 0)),  the world being the first device's rectified frame;
// of one camera alone R = 1, P = [K' | 0], and it stands at the origin. K' is that of the rectified picture
// and is passed over. In writing R and P are the identity and [K | 0]. A device whose camera_name begins with
// "proj" is a projector. http://wiki.ros.org/camera_calibration_parsers
#pragma once

#include "sim/formats/parts.h"

#include <string>

namespace laterna {

/// The device, in the first one's rectified frame; notes a lens that is fitted. Throws InputError, beginning
/// with `file_name` and the key.
Device parse_camera_info(const std::string& text, const std::string& file_name, Notes& notes);

/// Notes that the placement is lost. Throws InputError for a lens that is none of OpenCV's with up to eight
/// terms, such as the spline of a fisheye.
std::string camera_info_text(const Device& device, Notes& notes);

}  // namespace laterna
