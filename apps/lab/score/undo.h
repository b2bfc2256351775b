// Mistakes that whoever made them could undo without measuring anything, and the undoing.
#pragma once

#include "apps/lab/score/score_rig.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace laterna {

/// A way to undo a mistake: `rig` edits the result before it is aligned, `pixel` (none: as they are) moves
/// the pixels that it then gives. Nothing in either is fitted.
struct Undo {
  std::string suspect;  ///< name of Suspect (suspects.h)
  std::function<ScoreRig(const ScoreRig&)> rig;
  std::function<glm::dvec2(const glm::dvec2&)> pixel{};
};

/// What the undoing does to the pixels of the rig that it gives: nothing where it has no `pixel`.
void undo_pixels(const Undo& undo, std::vector<glm::dvec2>& pixels);

/// All of them for a projector of the given picture size:
///
///   size_swapped         W and H exchanged in the size; in size, focal lengths and centre; in the last two
///                        or in the centre alone; or the centre's offset from the middle of the other size's
///                        picture
///   half_pixel           the centre is moved by half a pixel in u, v or both, either way: pixels counted
///                        from their corners
///   y_flipped            v ↔ H - 1 - v, by the centre, the picture (as it is, or with the pose a proper
///                        rotation that has every point behind) or the device frame's y; y and z axes
///                        (OpenGL's device frame), of the device, the world or both
///   inverse_pose         world_from_device in place of device_from_world, of the projector or of all
///                        devices; or camera_from_projector in place of projector_from_camera
///   rotation_transposed  Rᵀ in place of R with the same t, or with the same centre, of the same three
///   unit_scale           lengths in mm, cm, inches or feet taken for metres, or the other way round, of the
///                        same three
///   axes_exchanged       (u, v) ↔ (v, u): rows decoded as columns; the pose a reflection, behind the
///                        picture, or turned by a quarter
std::vector<Undo> undoings(glm::ivec2 size);

}  // namespace laterna
