// Intrinsics that are known before calibrating, from files.
#pragma once

#include "calib/boards/board_capture.h"
#include "calib/solve.h"

#include <map>
#include <string>
#include <vector>

namespace laterna {

/// By the device's name; "" stands for any.
using KnownByName = std::map<std::string, KnownIntrinsics>;

/// From words FILE or NAME=FILE. FILE.cameramodel (mrcal's) is exact. Another file is what `laterna calibrate
/// -o` wrote, of a known scene or of boards: NAME's, or its only one, or all of them by their own names;
/// standard deviations are kept, as if independent of one another; what was held there is exact. Placements
/// in the files are passed over. Throws InputError for a file that cannot be read, an estimate without that
/// name, or a name said twice.
KnownByName read_known_intrinsics(const std::vector<std::string>& words);

/// Puts them into a rig's devices. Throws InputError where one is of a device that the rig has not, or of any
/// device.
void add_known(BoardCapture& capture, const KnownByName& known);

/// Those of one projector; none where nothing is said of it.
std::optional<KnownIntrinsics> known_for(const KnownByName& known, const std::string& projector);

}  // namespace laterna
