// The rig moved between pictures. Stage: replay.
//
//   device_from_world' = [R | t]·device_from_world
//
// for one device, from picture m of each sequence in which it takes part. Both rigs are traced and play the
// whole sequence; the pictures from m on are the moved one's. Costs the trace and the replay once more. The
// truth that is written beside pictures is of the rig as it stood first.
#pragma once

#include "sim/image.h"
#include "sim/scene.h"

namespace laterna {

/// Whether the scene's timing moves this camera or this projector.
bool moves(const Scene& scene, int camera, int projector);

/// The scene as it stands after the move, which it says no more of.
Scene after_move(const Scene& scene);

/// Pictures `first` and on of `from` in place of those of `to`: stacks of one size and type.
void splice(CapturedStack& to, const CapturedStack& from, int first);

}  // namespace laterna
