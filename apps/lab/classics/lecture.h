// The texture-mapping lecture: light maps, photographs on their objects, shadow maps, bumps, and what goes
// wrong.
#pragma once

#include "apps/lab/classics/classic.h"

namespace laterna {

ClassicResult lecture(const std::filesystem::path& scenes);

}  // namespace laterna
