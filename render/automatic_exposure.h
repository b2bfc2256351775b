// The exposure that suits a scene.
#pragma once

#include "render/replay.h"

#include <span>

namespace laterna {

/// The luminance that fills the scale so that the 99.9th percentile of the ideal white frame stands at 80 %
/// of it. A pixel's white is Σ weight + constant light; the percentile (nearest rank: the ⌈0.999·n⌉-th
/// smallest) is over the pixels of all `images` together that have an entry. Where none has, over those with
/// constant light; where none has that either, 1 cd/m².
double automatic_saturation_cd_per_m2(std::span<const ImageRows> images);

}  // namespace laterna
