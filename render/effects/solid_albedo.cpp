#include "render/effects/solid_albedo.h"

#include <cmath>

namespace laterna {

namespace {

// Steele et al., "Fast splittable pseudorandom number generators", 2014: the output mix of SplitMix64.
std::uint64_t mix(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

double lattice_value(std::uint64_t seed, const glm::dvec3& corner) {
  std::uint64_t key = mix(seed);
  for (int i = 0; i < 3; ++i) key = mix(key ^ std::uint64_t(std::int64_t(corner[i])));
  return double(key >> 11) * 0x1p-53;
}

double noise(std::uint64_t seed, const glm::dvec3& x) {
  const glm::dvec3 cell = glm::floor(x), t = x - cell, blend = t * t * (3.0 - 2.0 * t);
  double sum = 0;
  for (int k = 0; k < 8; ++k) {
    const glm::dvec3 step(k & 1, (k >> 1) & 1, k >> 2);
    const glm::dvec3 share = step * blend + (1.0 - step) * (1.0 - blend);
    sum += share.x * share.y * share.z * lattice_value(seed, cell + step);
  }
  return sum;
}

double checker(const glm::dvec3& x) {
  const glm::dvec3 cell = glm::floor(x + 0.25);
  return std::fmod(std::abs(cell.x + cell.y + cell.z), 2.0) == 0 ? 1 : 0;
}

}  // namespace

double solid_share(const Solid& solid, std::uint64_t seed, const glm::dvec3& x_object) {
  if (solid.kind == SolidKind::none) return 1;
  // Lattice coordinates stay below 2⁵³, where doubles and integers agree.
  const glm::dvec3 x = glm::clamp(x_object / solid.cell, -0x1p52, 0x1p52);
  const double s = solid.kind == SolidKind::checker ? checker(x) : noise(seed, x);
  return solid.low + (1 - solid.low) * s;
}

void apply_solid_albedo(SurfaceMap& surface, const Scene& scene) {
  weigh_albedo(surface, [&](std::size_t p) {
    const Object& object = scene.objects[surface.object.values[p]];
    return solid_share(object.effects.solid, object.seed, surface.point_object.values[p]);
  });
}

}  // namespace laterna
