// Where our picture and OpenGL's differ, and what stands there: a test that says "they agree but at edges"
// has to say at which.
#pragma once

#include "render/direct_light.h"
#include "sim/image.h"
#include "tests/gl/rasteriser.h"
#include "tests/gl/sides.h"

#include <array>
#include <string>

namespace laterna::gl {

/// What two right pictures may differ by, in texels: T's and the vertices' rounding to float, and vertices
/// snapped to 1/256 of a pixel.
inline constexpr double uv_tolerance_px = 0.01;

/// What makes a pixel's value a matter of rounding. The first that holds, narrowest first.
enum class Edge : std::uint8_t {
  none,
  border,     ///< (u, v) is within uv_tolerance_px of the picture's edge
  texel,      ///< nearest lookup: within uv_tolerance_px of the edge of a texel
  seam,       ///< triangles meet here that do not share an edge (near_sides): OpenGL may see between them
  crease,     ///< with irradiance: the edge of a triangle, where OpenGL may see its neighbour, lit otherwise
  shadow,     ///< as the caller marks
  silhouette  ///< a neighbour (of the eight) sees another surface (near_jumps)
};
inline constexpr std::size_t edge_count = 7;

/// The edge at each pixel, from our maps alone: nothing of OpenGL's picture goes into it. `shadow_edges`,
/// where given, is not 0 near one.
Image<Edge> edges(const Scene& scene, const RayScene& rays, const SurfaceMap& surface, const LightMap& light,
                  const Image<std::uint8_t>* shadow_edges = nullptr, double snap_px = mesa_snap_px);

/// Pixels that are lit in either picture.
struct Differences {
  std::size_t lit = 0, differing = 0;
  std::array<std::size_t, edge_count> at{};      ///< of those that differ, by edge; at[0] is unexplained
  std::array<std::size_t, edge_count> beside{};  ///< of all lit, by edge: what the explanation could cover
  double greatest = 0, rms = 0;                  ///< of pixels at no edge
  Image<glm::u8vec3> map;  ///< black: unlit; grey: the same; colour: differs. Red is unexplained

  std::size_t unexplained() const { return at[0]; }
  double share() const { return double(differing) / double(std::max<std::size_t>(lit, 1)); }
};

/// Projector pixels, in texels: differing where beyond uv_tolerance_px, or lit in one only.
Differences compare_uv(const LightMap& ours, const Image<glm::vec4>& theirs, const Image<Edge>& edges);

/// 8-bit pictures: differing where by more than `allowed_dn`, or lit in one only.
Differences compare_dn(const Image<std::uint8_t>& ours, const LightMap& light,
                       const Image<glm::vec4>& their_uvq1, const Image<std::uint8_t>& theirs,
                       const Image<Edge>& edges, int allowed_dn = 1);

/// One line for people.
std::string text(const Differences& differences);

}  // namespace laterna::gl
