// What share of the light a surface point reflects.
#pragma once

#include "sim/scene.h"

#include <glm/glm.hpp>

namespace laterna {

/// The map's value at texture coordinates (s right, t up, repeated): bilinear between texel centres, which
/// lie at s = (x + 0.5)/W, t = 1 - (y + 0.5)/H.
double albedo_map_value(const Image<float>& map, const glm::dvec2& st);

/// Texture coordinates at a point of a triangle, in the object's frame: those of its vertices, weighted by
/// the point's barycentric coordinates. The mesh must have texture coordinates.
glm::dvec2 texture_coordinates_at(const Mesh& mesh, std::uint32_t triangle, const glm::dvec3& x_object);

}  // namespace laterna
