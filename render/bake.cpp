#include "render/bake.h"

#include "render/bilinear.h"
#include "render/direct_light.h"
#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace laterna {

namespace {

constexpr int most_repeats = 16;

SurfaceMap empty_texture(int size_px) {
  SurfaceMap map = make_surface_map({0, 0, size_px, size_px});
  std::fill(map.object.values.begin(), map.object.values.end(), no_hit);
  std::fill(map.triangle.values.begin(), map.triangle.values.end(), no_hit);
  std::fill(map.albedo.values.begin(), map.albedo.values.end(), 0.0f);
  std::fill(map.seen_front.values.begin(), map.seen_front.values.end(), std::uint8_t{0});
  return map;
}

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

int wrap(int i, int size) { return (i % size + size) % size; }

// Puts the points of one triangle onto the texels whose centres it covers and that are still free.
void draw_triangle(const Mesh& mesh, std::uint32_t object, std::uint32_t triangle, SurfaceMap& map) {
  const int size = map.width;
  std::array<glm::dvec2, 3> texel;
  std::array<glm::dvec3, 3> x;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec2 st = mesh.texture_coordinates[mesh.triangles[triangle][i]];
    texel[i] = {st.x * size - 0.5, (1 - st.y) * size - 0.5};
    x[i] = mesh.positions[mesh.triangles[triangle][i]];
  }
  const double area = cross(texel[1] - texel[0], texel[2] - texel[0]);
  if (area == 0) return;
  const glm::dvec2 low = glm::min(texel[0], glm::min(texel[1], texel[2]));
  const glm::dvec2 high = glm::max(texel[0], glm::max(texel[1], texel[2]));
  for (int j = int(std::ceil(low.y)); j <= high.y; ++j) {
    for (int i = int(std::ceil(low.x)); i <= high.x; ++i) {
      const glm::dvec2 p(i, j);
      const double b = cross(p - texel[0], texel[2] - texel[0]) / area;
      const double c = cross(texel[1] - texel[0], p - texel[0]) / area;
      const std::size_t at = map.object.index(wrap(i, size), wrap(j, size));
      if (!(b >= 0 && c >= 0 && b + c <= 1) || map.hit(at)) continue;
      map.object.values[at] = object;
      map.triangle.values[at] = triangle;
      map.point_object.values[at] = (1 - b - c) * x[0] + b * x[1] + c * x[2];
      map.seen_front.values[at] = 1;
    }
  }
}

void check(const Object& object, const Camera& camera, const Image<float>& photograph, int size_px) {
  if (object.mesh.texture_coordinates.empty())
    throw InputError(
        fmt::format("{}: the mesh has no texture coordinates, expected some to bake onto", object.name));
  for (const glm::dvec2& st : object.mesh.texture_coordinates)
    if (!(std::abs(st.x) <= most_repeats && std::abs(st.y) <= most_repeats))
      throw InputError(fmt::format("{}: a texture coordinate is ({}, {}), expected -{} to {}", object.name,
                                   st.x, st.y, most_repeats, most_repeats));
  const glm::ivec2 size = camera.device.intrinsics.size;
  if (photograph.width != size.x || photograph.height != size.y)
    throw InputError(fmt::format("{}: a photograph of {}x{} pixels, expected the camera's {}x{}",
                                 camera.device.name, photograph.width, photograph.height, size.x, size.y));
  if (size_px < 1 || size_px > 16384)
    throw InputError(fmt::format("texture: a size of {} was found, expected 1 to 16384", size_px));
}

}  // namespace

BakedTexture bake_photograph(const RayScene& rays, const Scene& scene, std::uint32_t object,
                             const Camera& camera, const Image<float>& photograph, int size_px) {
  const Object& baked = scene.objects[object];
  check(baked, camera, photograph, size_px);
  SurfaceMap texels = empty_texture(size_px);
  for (std::uint32_t t = 0; t < baked.mesh.triangles.size(); ++t)
    draw_triangle(baked.mesh, object, t, texels);
  Projector slide_projector;
  slide_projector.device = camera.device;
  const LightMap seen = trace_light(rays, scene, texels, slide_projector);
  BakedTexture texture{Image<float>(size_px, size_px), Image<std::uint8_t>(size_px, size_px)};
  for (std::size_t i = 0; i < texture.value.values.size(); ++i) {
    if (!seen.lit(i)) continue;
    texture.covered.values[i] = 1;
    texture.value.values[i] = float(bilinear_value(photograph, {seen.u_px.values[i], seen.v_px.values[i]}));
  }
  return texture;
}

}  // namespace laterna
