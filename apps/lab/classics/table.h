// The table of classics: one line for each system.
#pragma once

#include "apps/lab/classics/slide_projector.h"

#include <array>

namespace laterna {

inline const auto classic_table = std::to_array<Classic>({
    {"slide_projector", "1992 spotlight and slide-projector demo",
     "object-linear and eye-linear coordinates give one picture; four passes give the picture of one; near "
     "and far planes; light on faces turned away appears without the back-face test and goes with it",
     &slide_projector},
});

}  // namespace laterna
