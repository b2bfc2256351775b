// The projector's scaler: what happens to a picture between its input and its panel. Stage: pattern.
//
// Along each axis of the panel, a = (u + 0.5)/W is 0 to 1. The homography K takes the shown part of the
// input, (0, 0) to (1, 1), to the keystone's corners on the panel. Overscan o shows the middle 1 - o of the
// input:
//
//   (s, t) = 0.5 + (1 - o)·(K⁻¹(a, b) - 0.5),  input pixel = (s·W_in - 0.5, t·H_in - 0.5).
//
// Beyond the input the panel is black. Values are read at the nearest pixel, or bilinearly and rounded to 8
// bits, as electronics do.
#pragma once

#include "sim/pattern.h"
#include "sim/scene.h"

#include <glm/glm.hpp>

namespace laterna {

/// The size of the pictures that a projector takes: the scaler's input_size where the scaler is on, else the
/// panel's.
glm::ivec2 input_size(const Effects& effects, const Projector& projector);

/// The projective map from (u, v, 1) of the panel to input pixels, scaled so that its third row is positive
/// on the keystone's quadrilateral. The scaler passes check() of sim/effect_checks.h.
glm::dmat3 input_from_panel(const Scaler& scaler, const glm::ivec2& input_px, const glm::ivec2& panel_px);

/// The stack on the panel.
PatternStack scale_patterns(const PatternStack& input, const Scaler& scaler, const glm::ivec2& panel_px);

}  // namespace laterna
