// The shader lecture: M in the vertex shader, divide and tests per fragment; fixed to world or eye; no
// occlusions.
#pragma once

#include "apps/lab/classics/classic.h"

namespace laterna {

ClassicResult shader_projector(const std::filesystem::path& scenes);

}  // namespace laterna
