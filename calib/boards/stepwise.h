// Camera first, then projectors: what most tools do, to compare the joint adjustment with.
#pragma once

#include "calib/boards/rig.h"

#include <optional>

namespace laterna {

/// Adjusts device 0, the poses and the bend to the sightings of device 0 alone; then every other device, with
/// all of that held. Errors of the camera's poses go into the projectors. None where either fails.
std::optional<BoardRig> adjust_stepwise(const BoardCapture& capture, const RigModel& model,
                                        const BoardRig& start);

}  // namespace laterna
