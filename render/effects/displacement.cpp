#include "render/effects/displacement.h"

#include "render/albedo.h"
#include "sim/error.h"
#include "sim/smooth_normals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace laterna {

namespace {

struct Refined {
  Mesh mesh;
  std::vector<glm::dvec3> normals;
  std::vector<std::uint32_t> first;  // for each vertex, the first one of its position
  glm::dvec2 map_size_px;
  double longest_px;
  // Of this round: the edges that are halved, named by the first vertices of their ends, so that both sides
  // of a seam agree, and the first vertex in the middle of each; the middles of edges between vertices
  // themselves.
  std::unordered_map<std::uint64_t, std::uint32_t> halved, middles;

  double edge_px(std::uint32_t a, std::uint32_t b) const {
    return glm::length((mesh.texture_coordinates[a] - mesh.texture_coordinates[b]) * map_size_px);
  }
  double area_px2(const glm::uvec3& t) const;
  void find_long_edges();
  std::uint32_t middle_of(std::uint32_t a, std::uint32_t b);
  bool halve_edges();
};

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
}

double Refined::area_px2(const glm::uvec3& t) const {
  const auto& st = mesh.texture_coordinates;
  const glm::dvec2 p = (st[t.y] - st[t.x]) * map_size_px, q = (st[t.z] - st[t.x]) * map_size_px;
  return 0.5 * std::abs(p.x * q.y - p.y * q.x);
}

constexpr std::uint32_t whole = 0xffffffffu;  // an edge that is not halved has no middle

void Refined::find_long_edges() {
  halved.clear();
  for (const glm::uvec3& t : mesh.triangles)
    for (int i = 0; i < 3; ++i)
      if (const std::uint32_t a = t[i], b = t[(i + 1) % 3]; edge_px(a, b) > longest_px)
        halved.emplace(edge_key(first[a], first[b]), whole);
}

/// The vertex in the middle of an edge, made when first asked for; `whole` where the edge is short enough.
std::uint32_t Refined::middle_of(std::uint32_t a, std::uint32_t b) {
  const auto edge = halved.find(edge_key(first[a], first[b]));
  if (edge == halved.end()) return whole;
  const auto next = static_cast<std::uint32_t>(mesh.positions.size());
  const auto [at, is_new] = middles.emplace(edge_key(a, b), next);
  if (!is_new) return at->second;
  if (edge->second == whole) edge->second = next;
  first.push_back(edge->second);
  mesh.positions.push_back(0.5 * (mesh.positions[a] + mesh.positions[b]));
  mesh.texture_coordinates.push_back(0.5 * (mesh.texture_coordinates[a] + mesh.texture_coordinates[b]));
  normals.push_back(0.5 * (normals[a] + normals[b]));
  return next;
}

/// Replaces triangle abc, whose edges ab, bc and ca have the middles m (or whole), by 1 to 4 of the same
/// turn.
void split(const glm::uvec3& t, const glm::uvec3& m, const Refined& refined, std::vector<glm::uvec3>& out) {
  const int halved = (m.x != whole) + (m.y != whole) + (m.z != whole);
  if (halved == 0) {
    out.push_back(t);
  } else if (halved == 3) {
    for (const glm::uvec3& part : {glm::uvec3(t.x, m.x, m.z), {m.x, t.y, m.y}, {m.z, m.y, t.z}, m})
      out.push_back(part);
  } else if (halved == 1) {
    const int i = m.x != whole ? 0 : m.y != whole ? 1 : 2;  // the halved edge starts at corner i
    out.emplace_back(t[i], m[i], t[(i + 2) % 3]);
    out.emplace_back(m[i], t[(i + 1) % 3], t[(i + 2) % 3]);
  } else {
    const int i = m.x == whole ? 0 : m.y == whole ? 1 : 2;  // the whole edge starts at corner i
    const std::uint32_t a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3], bc = m[(i + 1) % 3],
                        ca = m[(i + 2) % 3];
    out.emplace_back(ca, bc, c);
    if (refined.edge_px(a, bc) < refined.edge_px(b, ca)) {
      out.emplace_back(a, b, bc);
      out.emplace_back(a, bc, ca);
    } else {
      out.emplace_back(a, b, ca);
      out.emplace_back(b, bc, ca);
    }
  }
}

/// One round over all triangles; false where every edge was short enough.
bool Refined::halve_edges() {
  find_long_edges();
  if (halved.empty()) return false;
  middles.clear();
  std::vector<glm::uvec3> parts;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::uvec3 middles_of_t(middle_of(t.x, t.y), middle_of(t.y, t.z), middle_of(t.z, t.x));
    split(t, middles_of_t, *this, parts);
  }
  mesh.triangles = std::move(parts);
  return true;
}

/// No triangle of edges up to L covers more than √3/4·L².
double fewest_triangles(const Refined& refined) {
  double area_px2 = 0;
  for (const glm::uvec3& t : refined.mesh.triangles) area_px2 += refined.area_px2(t);
  return area_px2 / (std::sqrt(3.0) / 4 * refined.longest_px * refined.longest_px);
}

void refine(Refined& refined, const std::string& name) {
  constexpr double most(most_displaced_triangles);
  bool fits = fewest_triangles(refined) <= most;
  while (fits && refined.halve_edges()) fits = double(refined.mesh.triangles.size()) <= most;
  if (fits) return;
  throw InputError(fmt::format(
      "{}: with edges of at most {} px of its {}×{} displacement_map the mesh has more than {} triangles; "
      "expected a larger displacement_edge_px",
      name, refined.longest_px, refined.map_size_px.x, refined.map_size_px.y, most_displaced_triangles));
}

}  // namespace

Object displaced(const Object& object) {
  const Image<float>& map = *object.displacement_map;
  const std::vector<std::uint32_t> first = first_of_position(object.mesh);
  Refined refined{object.mesh,
                  smooth_normals(object.mesh, first),
                  first,
                  glm::dvec2(map.width, map.height),
                  object.effects.displacement_edge_px,
                  {},
                  {}};
  refine(refined, object.name);
  Object result = object;
  result.mesh = std::move(refined.mesh);
  for (std::size_t i = 0; i < result.mesh.positions.size(); ++i) {
    const double height = albedo_map_value(map, result.mesh.texture_coordinates[i]);
    result.mesh.positions[i] += object.effects.displacement * height * unit_or_zero(refined.normals[i]);
  }
  return result;
}

const Scene& displaced(const Scene& scene, std::optional<Scene>& storage) {
  const auto has_map = [](const Object& object) { return object.displacement_map != nullptr; };
  if (!scene.effects.displacement || std::none_of(scene.objects.begin(), scene.objects.end(), has_map))
    return scene;
  storage = scene;
  storage->effects.displacement = false;
  for (Object& object : storage->objects)
    if (has_map(object)) object = displaced(object);
  return *storage;
}

}  // namespace laterna
