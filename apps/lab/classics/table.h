// The table of classics: one line for each system.
#pragma once

#include "apps/lab/classics/book_spotlight.h"
#include "apps/lab/classics/lecture.h"
#include "apps/lab/classics/projected_light.h"
#include "apps/lab/classics/shader_projector.h"
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
    {"lecture", "texture-mapping lecture",
     "a photograph reprojected and taken again returns itself; light maps; shadow maps against shadow rays; "
     "Phong's sum; bump, displacement and solid textures; reverse projection and penetration, each shown and "
     "cured",
     &lecture},
    {"projected_light", "projected-light tutorial",
     "view-camera to light matrix by a stack; the q > 0 test; flashlight, coloured spot, field of view; "
     "border against edge clamp; intensity × 4",
     &projected_light},
    {"shader_projector", "shader lecture",
     "M = B·P·V in a vertex shader, divide and range test per fragment; r > 0 beside q > 0; fixed in the "
     "world and fixed to the eye; occlusion missing and cured",
     &shader_projector},
});

}  // namespace laterna
