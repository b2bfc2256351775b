#include "tests/gl/comparison.h"

#include "sim/parallel.h"
#include "tests/gl/jumps.h"

#include <fmt/format.h>

#include <cmath>

namespace laterna::gl {

namespace {

constexpr std::array<const char*, edge_count> names = {
    "unexplained", "border", "texel edge", "seam", "crease", "shadow edge or step", "silhouette"};
constexpr std::array<glm::u8vec3, edge_count> colors = {
    {{255, 0, 0}, {0, 160, 255}, {255, 140, 0}, {255, 255, 255}, {255, 220, 0}, {0, 220, 90}, {220, 0, 220}}};

bool near_border(double u, double size) {
  return std::min(std::abs(u + 0.5), std::abs(u + 0.5 - size)) <= uv_tolerance_px;
}
bool near_texel_edge(double u) { return std::abs(u - 0.5 - std::round(u - 0.5)) <= uv_tolerance_px; }

Edge edge_of(const Projector& projector, const LightMap& light, std::size_t p) {
  const double u = light.u_px.values[p], v = light.v_px.values[p];
  const glm::ivec2 size = projector.device.intrinsics.size;
  if (near_border(u, size.x) || near_border(v, size.y)) return Edge::border;
  if (projector.lookup == Lookup::nearest && (near_texel_edge(u) || near_texel_edge(v))) return Edge::texel;
  return Edge::none;
}

// Goes through pixels lit in either picture; `off(p)` is how far they differ, infinite where lit in one only.
template <class Off>
Differences compare(const LightMap& light, const Image<glm::vec4>& theirs, const Image<Edge>& edges,
                    double tolerance, const Off& off) {
  Differences found;
  found.map = Image<glm::u8vec3>(edges.width, edges.height);
  double squares = 0;
  for (std::size_t p = 0; p < edges.values.size(); ++p) {
    const bool lit_theirs = theirs.values[p].w > 0.5f;
    if (!light.lit(p) && !lit_theirs) continue;
    const std::size_t edge = std::size_t(edges.values[p]);
    const bool in_both = light.lit(p) && lit_theirs;
    const double difference = in_both ? off(p) : std::numeric_limits<double>::infinity();
    ++found.lit, ++found.beside[edge];
    found.map.values[p] = glm::u8vec3(70);
    if (!edge) found.greatest = std::max(found.greatest, difference), squares += difference * difference;
    if (difference <= tolerance) continue;
    ++found.differing, ++found.at[edge];
    found.map.values[p] = colors[edge];
  }
  found.rms = std::sqrt(squares / double(std::max<std::size_t>(found.beside[0], 1)));
  return found;
}

}  // namespace

Image<Edge> edges(const Scene& scene, const RayScene& rays, const SurfaceMap& surface, const LightMap& light,
                  const Image<std::uint8_t>* shadow_edges, double snap_px) {
  const Image<std::uint8_t> jumps = near_jumps(scene, rays, surface),
                            sides = near_sides(scene, surface, snap_px);
  Image<Edge> found(surface.width, surface.height);
  for (std::size_t p = 0; p < found.values.size(); ++p) {
    Edge& edge = found.values[p] = edge_of(scene.projectors[0], light, p);
    if (edge != Edge::none) continue;
    if (jumps.values[p]) edge = Edge::silhouette;
    if (shadow_edges && shadow_edges->values[p]) edge = Edge::shadow;
    if (sides.values[p] == 1 && scene.effects.irradiance) edge = Edge::crease;
    if (sides.values[p] == 2) edge = Edge::seam;
  }
  return found;
}

Differences compare_uv(const LightMap& ours, const Image<glm::vec4>& theirs, const Image<Edge>& edges) {
  return compare(ours, theirs, edges, uv_tolerance_px, [&](std::size_t p) {
    return std::hypot(ours.u_px.values[p] - theirs.values[p].x, ours.v_px.values[p] - theirs.values[p].y);
  });
}

Differences compare_dn(const Image<std::uint8_t>& ours, const LightMap& light,
                       const Image<glm::vec4>& their_uvq1, const Image<std::uint8_t>& theirs,
                       const Image<Edge>& edges, int allowed_dn) {
  return compare(light, their_uvq1, edges, allowed_dn,
                 [&](std::size_t p) { return std::abs(int(ours.values[p]) - int(theirs.values[p])); });
}

std::string text(const Differences& d) {
  std::string line = fmt::format("{} lit, {} differ ({:.4f} %): {} unexplained", d.lit, d.differing,
                                 100 * d.share(), d.at[0]);
  for (std::size_t e = 1; e < edge_count; ++e)
    if (d.beside[e]) line += fmt::format(", {} {} of {}", names[e], d.at[e], d.beside[e]);
  return line + fmt::format("; away from edges rms {:.2g}, greatest {:.2g}", d.rms, d.greatest);
}

}  // namespace laterna::gl
