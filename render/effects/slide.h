// Slides: pictures of the user's, one or several, in place of the coded patterns. Stage: pattern.
//
// A picture is held as 8-bit values with a table of what light each stands for: linear, or the sRGB curve,
// so that an 8-bit file of either kind keeps its bits; a float picture is rounded to the nearest of 256.
#pragma once

#include "sim/pattern.h"
#include "sim/scene.h"

#include <span>

namespace laterna {

/// A stack of the slides. Throws InputError where there is none, one is not of `size`, or its values are of
/// another kind than the first one's.
PatternStack make_slide_stack(std::span<const Slide> slides, const glm::ivec2& size);

/// Their red, green and blue; grey ones three times the same.
std::vector<PatternStack> make_slide_primaries(std::span<const Slide> slides, const glm::ivec2& size);

/// What the scene shows in place of coded patterns: its slide, its pictures, or none.
std::span<const Slide> shown_slides(const Scene& scene);

}  // namespace laterna
