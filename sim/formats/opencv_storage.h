// OpenCV's FileStorage (YAML, XML or JSON) in the layouts that camera-projector tools write.
//
//   scan3d         cam_K, cam_kc, proj_K, proj_kc, R, T, E, F (without E and F the tool takes the file for
//   none)
//                  scan3d-capture (Cam_K... as well)
//   procam         cam_int, cam_dist, proj_int, proj_dist, rotation (written `roration` by the tool),
//                  translation, img_shape (height, then width)         procam-calibration
//   slstudio       Kc, kc, Kp, kp, Rp, Tp, frameWidth, frameHeight, screenResX, screenResY; kc and kp of just
//                  five coefficients                                   SLStudio
//   opencv-stereo  M1, D1, M2, D2, R, T (the second device is taken for the projector); the sample keeps R
//   and T
//                  in extrinsics.yml beside intrinsics.yml             OpenCV's stereo samples
//   opencv         Cameras, Projectors: lists of {name, size: [W, H], K, D, R, T}; ours, for any number
//   (read only)    camera_matrix, distortion_coefficients, image_width, image_height; in older files
//                  Camera_Matrix, Distortion_Coefficients, image_Width, image_Height
//                                                                      OpenCV's calibration sample
//                  with fisheye_model other than 0 and k1, k2, k3, k4: a fisheye, as a spline (fisheye.h)
//
// There and here alike: pixel centres at whole numbers, u right, v down; x right, y down, z forward; K row by
// row; distortion k1, k2, p1, p2, k3, ... Pairs: x_projector = R·x_camera + T, the world is the camera's
// frame. Lists: x_device = R·x_world + T. T is in the unit of the board that was used; no file says which.
// Pictures' sizes, which most layouts leave out, are written as cam_size and proj_size (W, H), and read where
// they stand.
#pragma once

#include "sim/formats/parts.h"

#include <string>

namespace laterna {

/// `extrinsics`: the text of a second file whose keys are added. Devices are named "camera" and "projector"
/// in pairs; a size that the file does not say stays 0. A lens that is fitted is told in the notes. Throws
/// InputError, beginning with `file_name` and the key, for anything else, such as a fisheye in a file without
/// its picture's size.
Rig parse_opencv_storage(const std::string& text, const std::string& file_name,
                         const std::string& extrinsics = "");

/// Whether a tree has one of the layouts.
bool is_opencv_layout(const Tree& tree);

/// `layout` is a name of the table above. YAML, or XML for procam and slstudio, as the tools write. Throws
/// InputError where a pair layout is not given one camera and one projector, or a lens is none of OpenCV's,
/// such as the spline of a fisheye.
std::string opencv_storage_text(const Rig& rig, const std::string& layout, Notes& notes);

}  // namespace laterna
