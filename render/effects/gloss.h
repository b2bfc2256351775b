// Gloss on top of Lambert's law. Stage: weight.
//
//   f = albedo/π + f_gloss(l, v),  white_lx ·= 1 + π·f_gloss/albedo,
//
// since replay multiplies white_lx by albedo/π. With unit vectors n (normal), l (to the light), v (to the
// camera), h = normalise(l + v), and strength k:
//
//   phong: f_gloss = k·(e + 2)/(2π)·max(0, r·v)^e,  r = 2(n·l)n - l
//   ggx:   f_gloss = k·D·G/(4·(n·l)(n·v)),  D = α²/(π((n·h)²(α² - 1) + 1)²), G of Smith, height-correlated
//
// Both reflect at most k of the light from any direction, so albedo + k ≤ 1 keeps the energy. There is no
// Fresnel term. Ambient light sees Lambert's share only. Sources: Lafortune and Willems, "Using the modified
// Phong reflectance model", 1994; Walter et al., "Microfacet models for refraction", 2007; Heitz, 2014.
#pragma once

#include "render/effects/pixel_geometry.h"

namespace laterna {

/// f_gloss in 1/sr; 0 where l or v is not above the surface. `gloss` has what its model needs.
double gloss_per_sr(const Gloss& gloss, const glm::dvec3& n, const glm::dvec3& l, const glm::dvec3& v);

/// Where nothing of Lambert is left to multiply, this much is put in its place: it shows in no picture.
inline constexpr float least_glossy_albedo = 1e-6f;

/// Raises the albedo of glossy objects to least_glossy_albedo. Before apply_gloss.
void make_room_for_gloss(SurfaceMap& surface, const Scene& scene);

void apply_gloss(LightMap& light, const PixelGeometry& geometry, const Projector& projector,
                 const Camera& camera);

}  // namespace laterna
