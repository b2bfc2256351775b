// The projector's response and black level. Stage: pattern.
//
//   light = b + (1 - b)·r(p),  r(p) = p^γ, or a table at evenly spaced p, linear between,
//
// b = black over white = 1/contrast ratio. p is the signal in [0, 1] (value/255, or the light that a slide's
// encoding gives it). Only the table value → light changes, so no 8-bit rounding hides a dark level.
#pragma once

#include "sim/pattern.h"
#include "sim/scene.h"

namespace laterna {

void apply_response(PatternStack& patterns, const ProjectorEffects& effects);
void apply_black_level(PatternStack& patterns, const ProjectorEffects& effects);

/// The light of a black picture over that of white, with the switches `on`; veiling glare leaves it as it is.
double black_light(const Effects& on, const ProjectorEffects& effects);

}  // namespace laterna
