// Veiling glare of a projector's lens. Stage: pattern.
//
//   light_k(u, v) = (1 - g)·p_k(u, v) + g·mean(p_k):
//
// the lens takes a share g of each picture's light and spreads it evenly over the picture, so that a
// picture's flux stays. For picture k it adds the constant g·mean(p_k), carried in PatternStack::added_light.
// The light that it throws beyond the picture's edge is left out. It is what lowers ANSI contrast below
// on/off contrast.
#pragma once

#include "sim/pattern.h"
#include "sim/scene.h"

#include <vector>

namespace laterna {

/// The mean light of each picture.
std::vector<double> mean_light(const PatternStack& patterns);

/// After every other effect on the light of values.
void apply_veiling_glare(PatternStack& patterns, const ProjectorEffects& effects);

}  // namespace laterna
