// The light that a projector throws on what a camera sees: the direct-hit row of image = A·pattern + ambient.
#pragma once

#include "render/pixel_array.h"
#include "render/projective_lookup.h"
#include "render/surface.h"
#include "render/tile_kernels.h"

namespace laterna {

/// One row of A per pixel of a SurfaceMap, with one entry: the projector pixel (u, v) that lights the pixel's
/// point, and its weight. The illuminance for a picture with value p in [0, 1] at (u, v) is white_lx·p.
struct LightMap {
  int width = 0, height = 0;
  PixelArray<double> u_px, v_px;  ///< projector pixel, also where the point is dark for another reason than
                                  ///< `lens` or `behind`; NaN there and where nothing is seen
  PixelArray<double> white_lx;    ///< illuminance on the surface for the all-white picture; 0 unless lit
  PixelArray<std::uint8_t> why;   ///< Unlit: lit (0), or the first reason that the point is dark
  PixelArray<float> footprint_px{};  ///< as LightEntry's; empty where no effect sets it

  float footprint(std::size_t i) const { return footprint_px.values.empty() ? 0 : footprint_px.values[i]; }
  bool lit(std::size_t i) const { return why.values[i] == std::uint8_t(Unlit::lit); }
};

/// E = Φ·J·cos(θ_i)/(z²·cos θ), in lx: Φ = flux_lm/(W·H) per panel pixel; J = det ∂(u,v)/∂(x/z, y/z) = fx·fy
/// for a pinhole; z axial depth; θ from the optical axis; θ_i at the surface. Since cos θ = z/d and cos θ_i =
/// h/d, with distance d and h the projector's height above the triangle's plane, this is Φ·J·h/z³. A point is
/// dark as ProjectiveLookup says; where the projector, or the camera, is behind the surface; and where a
/// shadow ray meets anything (RayScene's margins): also before the near plane.
///
/// Switches of Scene::effects, each the stage `rows` but the last: shadow off: no shadow ray. back_face off:
/// both sides are lit, E with |h|. border off: as Border::clamp. light_planes off: no near and far.
/// irradiance off (weight): E = Φ·fx·fy/(1 m)² at each lit point, what a facing plane at 1 m gets.
LightMap trace_light(const RayScene& rays, const Scene& scene, const SurfaceMap& surface,
                     const Projector& projector);

/// The projector as one object sees it.
struct ObjectLight {
  ProjectiveLookup lookup;
  LightTerms terms;
};

/// A projector ready to light region by region.
struct ProjectorView {
  std::vector<ObjectLight> objects;
};
ProjectorView make_projector_view(const RayScene& rays, const Scene& scene, const Projector& projector);

/// A map with nothing written yet.
LightMap make_light_map(int width, int height);

/// Lights row `tile_row` of the 4×4 tiles of a surface map, of the whole image or a region of it.
void trace_light_tiles(const RayScene& rays, const ProjectorView& light, const SurfaceMap& surface,
                       int tile_row, LightMap& map);

}  // namespace laterna
