// The table of classics: one line for each system.
#pragma once

#include "apps/lab/classics/book_spotlight.h"
#include "apps/lab/classics/slide_projector.h"

#include <array>

namespace laterna {

inline const auto classic_table = std::to_array<Classic>({
    {"slide_projector", "1992 spotlight and slide-projector demo",
     "object-linear and eye-linear coordinates give one picture; four passes give the picture of one; near "
     "and far planes; light on faces turned away appears without the back-face test and goes with it",
     &slide_projector},
    {"book_spotlight", "OpenGL course book's spotlight",
     "intensity map from cutoff and exponent; attenuation by a 3D texture along r; three passes; several "
     "lights added; border texel against clamp-to-edge; per-vertex light against per-sample",
     &book_spotlight},
});

}  // namespace laterna
