// The projected-light tutorial: the matrix by a stack, the q test, flashlights, the border, brighter light.
#pragma once

#include "apps/lab/classics/classic.h"

namespace laterna {

ClassicResult projected_light(const std::filesystem::path& scenes);

}  // namespace laterna
