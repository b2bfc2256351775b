// Devices of a rig whose intrinsics and lens are known: what is left to find is where they stand.
#pragma once

#include "calib/boards/rig_fit.h"

#include <string>

namespace laterna {

/// The model of a device: its known lens with a free place, held or, where its sigmas are not 0, with them as
/// a prior; or the one of these terms.
DeviceModel device_model(const BoardDevice& device, const std::vector<std::string>& terms);

bool all_known(const BoardCapture& capture);

/// The capture with the sightings of known devices at the pixels of a pinhole with the same fx, fy, cx, cy; a
/// sighting whose pixel has no ray is left out.
BoardCapture straightened(const BoardCapture& capture);

/// Whether a fit has a twin: for each pose the camera's sightings of the board, and for each other device all
/// its points in the camera's frame, solved for as a placement with known intrinsics and the fit's sigmas
/// (solve.h). A sentence that begins with the device, or empty.
std::string second_placement(const RigFit& fit);

}  // namespace laterna
