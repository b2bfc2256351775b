// Light at the vertices, and between them: what a coarse mesh makes of a spotlight (undersampling).
#pragma once

#include "render/surface.h"
#include "sim/scene.h"

#include <functional>

namespace laterna {

/// Light at each pixel that sees an object, from light_at(world point) at its vertices only, interpolated as
/// a rasteriser does (Gouraud). 0 where nothing is seen.
Image<float> vertex_light(const SurfaceMap& surface, const Scene& scene,
                          const std::function<double(const glm::dvec3& x_world)>& light_at);

/// The same from light_at at each pixel's own point.
Image<float> sample_light(const SurfaceMap& surface, const Scene& scene,
                          const std::function<double(const glm::dvec3& x_world)>& light_at);

}  // namespace laterna
