// Distance attenuation, as OpenGL's light sources. Stage: weight.
//
//   white_lx /= k0 + k1·d + k2·d²,
//
// d the distance from the projector's centre in metres. It stands on top of the irradiance; with that
// switched off, it is the only law of distance. Source: OpenGL 2.1 specification, 2.14.1.
#pragma once

#include "render/effects/pixel_geometry.h"

namespace laterna {

void apply_attenuation(LightMap& light, const PixelGeometry& geometry, const Projector& projector);

}  // namespace laterna
