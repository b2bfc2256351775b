// A spotlight's profile, as OpenGL's fixed-function spotlight. Stage: weight (the cone removes entries).
//
//   white_lx ·= intensity·cosⁿθ for θ ≤ cutoff; dark beyond it (Unlit::cutoff),
//
// θ from the projector's optical axis. Source: OpenGL 2.1 specification, 2.14.1.
#pragma once

#include "render/effects/pixel_geometry.h"

namespace laterna {

void apply_spotlight(LightMap& light, const PixelGeometry& geometry, const Projector& projector);

}  // namespace laterna
