// Pixels that are active over part of their area only. Stage: rows (projector), rays (camera).
//
//   side = √fill_factor:
//
// a panel pixel emits from the square of this side about its centre, with 1/fill_factor of its mean density,
// so that its flux is kept (the screen door; panel_blur.h); a camera pixel is the mean over such a square,
// where antialiasing spreads its rays.
#pragma once

#include "sim/effect_parameters.h"
#include "sim/effects.h"

#include <cmath>

namespace laterna {

/// The square's side in px: 1 where the effect is off.
inline double active_side_px(const Effects& on, const Optics& optics) {
  return on.fill_factor ? std::sqrt(optics.fill_factor) : 1;
}

}  // namespace laterna
