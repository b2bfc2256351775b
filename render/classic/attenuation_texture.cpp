#include "render/classic/attenuation_texture.h"

#include "render/classic/intensity_map.h"
#include "render/projective_lookup.h"
#include "sim/error.h"

#include <array>

namespace laterna {

double depth_at(double r_over_q, double near_m, double far_m, DepthIndex index) {
  if (index == DepthIndex::linear) return near_m + r_over_q * (far_m - near_m);
  return near_m * far_m / (far_m - r_over_q * (far_m - near_m));
}

double attenuation_at(const Projector& projector, double distance_m) {
  const glm::dvec3 k = *projector.effects.attenuation;
  return 1 / (k.x + distance_m * (k.y + distance_m * k.z));
}

AttenuationTexture attenuation_texture(const Projector& projector, glm::ivec3 size, DepthIndex index) {
  const LightPlanes& planes = projector.device.planes;
  if (!planes.near_m || !planes.far_m || !projector.effects.attenuation)
    throw InputError(projector.device.name + ": an attenuation texture needs near, far and attenuation");
  AttenuationTexture texture{size, std::vector<float>(std::size_t(size.x) * size.y * size.z)};
  std::size_t at = 0;
  for (int k = 0; k < size.z; ++k) {
    const double depth = depth_at((k + 0.5) / size.z, *planes.near_m, *planes.far_m, index);
    for (int j = 0; j < size.y; ++j)
      for (int i = 0; i < size.x; ++i, ++at) {
        const glm::dvec2 slope =
            slope_of(projector.device.intrinsics, {(i + 0.5) / size.x, (j + 0.5) / size.y});
        texture.values[at] = float(attenuation_at(projector, depth * std::sqrt(1 + glm::dot(slope, slope))));
      }
  }
  return texture;
}

double AttenuationTexture::value(const glm::dvec3& str_over_q) const {
  std::array<LinearTaps, 3> taps{};
  for (int axis = 0; axis < 3; ++axis)
    taps[std::size_t(axis)] = linear_taps(str_over_q[axis] * size[axis] - 0.5, size[axis]);
  const auto texel = [&](int i, int j, int k) {
    return double(values[(std::size_t(k) * size.y + j) * size.x + i]);
  };
  const auto row = [&](int j, int k) {
    return glm::mix(texel(taps[0].first, j, k), texel(taps[0].second, j, k), taps[0].share);
  };
  const auto sheet = [&](int k) {
    return glm::mix(row(taps[1].first, k), row(taps[1].second, k), taps[1].share);
  };
  return glm::mix(sheet(taps[2].first), sheet(taps[2].second), taps[2].share);
}

}  // namespace laterna
