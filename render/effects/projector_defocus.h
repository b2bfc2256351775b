// A projector out of focus, as a thin lens. Stage: rows.
//
// Light of one panel pixel leaves the whole aperture and meets again at depth z_f. A point at depth z gathers
// from a disc of the panel of diameter
//
//   footprint_px = √(fx·fy)·A·|1/z_f - 1/z|,
//
// evenly over its area. What lies beyond the panel is dark, and a point beyond the sharp picture's edge still
// gets what its disc overlaps: the border is soft (render/panel_blur.h spreads the entries).
//
// Neglected: the slope of the light over the aperture; the penumbra of shadows (the shadow ray goes to the
// lens's centre); the local scale of a distorted picture; the blur of an idle projector's black.
// Source: Potmesil & Chakravarty, "A lens and aperture camera model for synthetic image generation", 1981.
#pragma once

#include "render/effects/pixel_geometry.h"

namespace laterna {

/// The diameter for a point at axial depth `depth_m`; 0 without aperture_m or focus_m.
double blur_diameter_px(const Optics& optics, const Intrinsics& intrinsics, double depth_m);

/// Fills light.footprint_px, 0 where unlit.
void apply_projector_defocus(LightMap& light, const PixelGeometry& geometry, const Projector& projector);

/// What is left of the contrast of stripes, `stripe_px` wide each: the disc's transfer at their period,
/// 2·J1(x)/x with x = π·diameter_px/(2·stripe_px). Negative: dark and bright have changed places.
double stripe_contrast(double diameter_px, double stripe_px);

}  // namespace laterna
