// Mistakes in a cloud of points that whoever made them could undo without measuring anything.
#pragma once

#include "sim/formats/point_cloud.h"
#include "sim/scene.h"

#include <functional>
#include <string>
#include <vector>

namespace laterna {

/// A way to undo a mistake, or two, of each point alone.
struct CloudUndo {
  std::vector<std::string> suspects;  ///< names of Suspect (suspects.h); none: the frame alone
  std::string frame;                  ///< the device whose frame the points then stood in; empty: as is told
  std::function<void(CloudPoint&)> edit;
};

/// All of them, for a cloud whose pixels are of devices with these picture sizes:
///
///   unit_scale      points in mm, cm, inches or feet taken for metres, or the other way round
///   y_flipped       y, or y and z (OpenGL's device frame), of the points; v ↔ H - 1 - v of either device's
///                   pixels
///   both            of those two
///   inverse_pose    device_from_world applied where points in a device's frame asked for its inverse
///   axes_exchanged  (u, v) ↔ (v, u) of the projector's pixels
///   half_pixel      the projector's pixels counted from their corners, in u, v or both, either way
///
/// With `any_frame` those of points also as if they stood in the frame of each of the scene's devices, and
/// that alone.
std::vector<CloudUndo> cloud_undoings(const Scene& scene, glm::ivec2 camera_size, glm::ivec2 projector_size,
                                      bool any_frame);

}  // namespace laterna
