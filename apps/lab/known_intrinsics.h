// Intrinsics that are known before calibrating, from files.
#pragma once

#include "calib/solve.h"

#include <map>
#include <string>
#include <vector>

namespace laterna {

/// By the projector's name; "" stands for any.
using KnownByName = std::map<std::string, KnownIntrinsics>;

/// From words FILE or NAME=FILE. FILE.cameramodel (mrcal's) is exact. Another file is an estimate that
/// `laterna calibrate -o` wrote: NAME's, or its only one; its standard deviations are kept, as if independent
/// of one another. Placements in the files are passed over. Throws InputError for a file that cannot be read,
/// an estimate without that name or with several and none named, or a name said twice.
KnownByName read_known_intrinsics(const std::vector<std::string>& words);

/// Those of one projector; none where nothing is said of it.
std::optional<KnownIntrinsics> known_for(const KnownByName& known, const std::string& projector);

}  // namespace laterna
