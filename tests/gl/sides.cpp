#include "tests/gl/sides.h"

#include "sim/device.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace laterna::gl {

namespace {

// Bit e of a triangle: its edge from corner e to the next is open.
std::vector<std::uint8_t> open_edges(const Mesh& mesh) {
  std::map<std::array<double, 3>, std::uint32_t> places;
  std::vector<std::uint32_t> place;
  for (const glm::dvec3& x : mesh.positions)
    place.push_back(places.try_emplace({x.x, x.y, x.z}, std::uint32_t(places.size())).first->second);
  struct Side {
    std::uint32_t low, high, triangle;
    int edge;
    bool same(const Side& other) const { return low == other.low && high == other.high; }
  };
  std::vector<Side> sides;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int e = 0; e < 3; ++e) {
      const std::uint32_t a = place[mesh.triangles[t][e]], b = place[mesh.triangles[t][(e + 1) % 3]];
      sides.push_back({std::min(a, b), std::max(a, b), t, e});
    }
  }
  std::ranges::sort(sides, {}, [](const Side& s) { return std::pair(s.low, s.high); });
  std::vector<std::uint8_t> open(mesh.triangles.size(), 0);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const bool shared =
        (i > 0 && sides[i].same(sides[i - 1])) || (i + 1 < sides.size() && sides[i].same(sides[i + 1]));
    if (!shared) open[sides[i].triangle] |= std::uint8_t(1 << sides[i].edge);
  }
  return open;
}

double distance_to_segment(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 along = b - a;
  const double share = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0, 1.0);
  return glm::distance(p, a + share * along);
}

}  // namespace

Image<std::uint8_t> near_sides(const Scene& scene, const SurfaceMap& surface, double snap_px) {
  const WorldProjection camera(scene.cameras[0].device);
  std::vector<std::vector<std::uint8_t>> open;
  for (const Object& object : scene.objects) open.push_back(open_edges(object.mesh));
  Image<std::uint8_t> near(surface.width, surface.height);
  for (std::size_t p = 0; p < near.values.size(); ++p) {
    if (!surface.hit(p)) continue;
    const std::uint32_t o = surface.object.values[p], t = surface.triangle.values[p];
    const Object& object = scene.objects[o];
    const auto pixel_of = [&](int corner) {
      const glm::dvec3& x_object = object.mesh.positions[object.mesh.triangles[t][corner % 3]];
      return glm::dvec2(camera.project(glm::dvec3(object.world_from_object * glm::dvec4(x_object, 1))));
    };
    const glm::ivec2 pixel(int(p % surface.width), int(p / surface.width));
    for (int e = 0; e < 3; ++e) {
      if (distance_to_segment(glm::dvec2(pixel), pixel_of(e), pixel_of(e + 1)) > 2 * snap_px) continue;
      near.values[p] = std::max<std::uint8_t>(near.values[p], open[o][t] >> e & 1 ? 2 : 1);
    }
  }
  return near;
}

}  // namespace laterna::gl
