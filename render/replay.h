// Plays a whole pattern stack through the light that was traced once.
#pragma once

#include "render/direct_light.h"
#include "render/exposure.h"
#include "render/surface.h"
#include "sim/image.h"
#include "sim/pattern.h"
#include "sim/scene.h"

namespace laterna {

/// Picture k: L = albedo/π·(white_lx·p_k(u, v) + ambient_lx) at each pixel, then the exposure, where p_k in
/// [0, 1] is value/255 of the texel that Projector::lookup takes. Pixels without the projector's light get
/// the ambient light; those that see nothing, or a back side, are black (but for noise). 8-bit pictures for a
/// bit depth of 8, else 16-bit. Arithmetic is in single precision: up to 2⁻⁸ DN of 16 bits. Throws InputError
/// where the patterns are not of the projector's size or the maps not of one size.
CapturedStack capture_stack(const SurfaceMap& surface, const LightMap& light, const Projector& projector,
                            const PatternStack& patterns, double ambient_lx, const Exposure& exposure);

}  // namespace laterna
