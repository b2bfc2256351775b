// A slide: one picture in place of the coded patterns. Stage: pattern.
//
// The picture is held as 8-bit values with a table of what light each stands for: linear, or the sRGB curve,
// so that an 8-bit file of either kind keeps its bits; a float picture is rounded to the nearest of 256.
#pragma once

#include "sim/pattern.h"
#include "sim/scene.h"

namespace laterna {

/// A stack of one picture, grey. Throws InputError where the slide is not of `size`.
PatternStack make_slide_stack(const Slide& slide, const glm::ivec2& size);

/// Its red, green and blue, for a slide that has them.
std::vector<PatternStack> make_slide_primaries(const Slide& slide, const glm::ivec2& size);

}  // namespace laterna
