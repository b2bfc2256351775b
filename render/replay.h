// Plays a whole pattern stack through rows of light.
#pragma once

#include "render/exposure.h"
#include "render/image_rows.h"
#include "render/show.h"
#include "sim/image.h"
#include "sim/scene.h"

namespace laterna {

/// Frame k at each camera pixel before exposure, in cd/m²: Σ weight·p_k(u, v) over the pixel's entries, plus
/// its constant light, where p_k in [0, 1] is value/255 of what `lookup` finds at (u, v) of the entry's
/// source. Picture k is what the show's timeline makes of the frames. In single precision. An entry whose
/// source the show does not have is an error of the caller's.
ImageStack<float> play_luminance(const ImageRows& image, Lookup lookup, const Show& show);

/// The same, exposed: 8-bit pictures for a bit depth of 8, else 16-bit. Arithmetic is in single precision: up
/// to 2⁻⁸ DN of 16 bits.
CapturedStack play_stack(const ImageRows& image, Lookup lookup, const Show& show, const Exposure& exposure);

/// The same into a stack of the right size and type, whose memory is used again.
void play_stack(const ImageRows& image, Lookup lookup, const Show& show, const Exposure& exposure,
                CapturedStack& out);

/// One region's part of that. `out` is of the whole image.
void play_rows(const LightRows& rows, Lookup lookup, const Show& show, const Exposure& exposure,
               CapturedStack& out);

/// Direct light from maps of the whole image, played and exposed. Pixels without the projector's light get
/// the ambient light; those that see nothing, or a back side, are black (but for noise). Throws InputError
/// where the patterns are not of the projector's size or the maps not of one size.
CapturedStack capture_stack(const SurfaceMap& surface, const LightMap& light, const Projector& projector,
                            const AnyPatterns& patterns, double ambient_lx, const Exposure& exposure);

}  // namespace laterna
