// kalibr's camera chains: camchain.yaml.
//
//   cam0: {camera_model: pinhole, intrinsics: [fu, fv, pu, pv], distortion_model: radtan,
//          distortion_coeffs: [k1, k2, r1, r2], resolution: [W, H], rostopic: /cam0/image_raw}
//   cam1: {..., T_cn_cnm1: 4×4 rows}
//
// There and here alike: pixel centres at whole numbers, x right, y down, z forward, metres; r1, r2 are
// OpenCV's p1, p2. T_cn_cnm1 takes coordinates of the camera before to this one's: poses are a chain, and the
// world is cam0's frame. Distortion `none` and `radtan` are read and written, `equidistant` is read as a
// spline (fisheye.h); fov and omni cameras are no lens of ours. kalibr knows no projectors and no names: a
// device is named after the first word of its topic, and is a projector where that begins with "proj".
// https://github.com/ethz-asl/kalibr/wiki/yaml-formats
#pragma once

#include "sim/formats/parts.h"

#include <string>

namespace laterna {

/// Throws InputError, beginning with `file_name` and the key. Equidistant lenses, of which a
/// file may hold 16, are told in the notes.
Rig parse_kalibr(const std::string& text, const std::string& file_name);

/// Throws InputError for a lens that is neither a pinhole nor four terms of OpenCV's, such as the spline of
/// a fisheye.
std::string kalibr_text(const Rig& rig, Notes& notes);

}  // namespace laterna
