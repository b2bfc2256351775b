#include "render/effects/vignetting.h"

#include "render/bilinear.h"

#include <algorithm>
#include <numeric>

namespace laterna {

namespace {

double polynomial(const std::vector<double>& coefficients, double x) {
  const double sum = std::accumulate(coefficients.rbegin(), coefficients.rend(), 0.0,
                                     [x](double inner, double c) { return (inner + c) * x; });
  return std::max(0.0, 1 + sum);
}

double map_value(const Image<float>& map, const glm::dvec2& pixel, const glm::ivec2& size) {
  const glm::dvec2 at = (pixel + 0.5) / glm::dvec2(size) * glm::dvec2(map.width, map.height) - 0.5;
  return bilinear_value(map, at);
}

double tan2(const glm::dvec3& x_device) {
  return (x_device.x * x_device.x + x_device.y * x_device.y) / (x_device.z * x_device.z);
}

}  // namespace

double vignetting_share(const Vignetting& vignetting, const Image<float>* map, double tan2_theta,
                        const glm::dvec2& pixel, const glm::ivec2& size) {
  switch (vignetting.model) {
    case VignettingModel::cos4:
      return 1 / ((1 + tan2_theta) * (1 + tan2_theta));
    case VignettingModel::polynomial:
      return polynomial(vignetting.coefficients, tan2_theta);
    case VignettingModel::map:
      return map_value(*map, pixel, size);
    default:
      return 1;
  }
}

void apply_projector_vignetting(LightMap& light, const PixelGeometry& geometry, const Projector& projector) {
  const Vignetting& vignetting = projector.effects.vignetting;
  if (vignetting.model == VignettingModel::none) return;
  weigh(light, [&](std::size_t p) {
    return vignetting_share(vignetting, projector.vignetting_map.get(),
                            tan2(geometry.in_device(projector.device, p)),
                            {light.u_px.values[p], light.v_px.values[p]}, projector.device.intrinsics.size);
  });
}

void apply_camera_vignetting(SurfaceMap& surface, const PixelGeometry& geometry, const Camera& camera) {
  if (camera.vignetting.model == VignettingModel::none) return;
  const auto width = std::size_t(surface.width);
  weigh_albedo(surface, [&](std::size_t p) {
    return vignetting_share(
        camera.vignetting, camera.vignetting_map.get(), tan2(geometry.in_device(camera.device, p)),
        glm::dvec2(surface.first_px) + glm::dvec2(p % width, p / width), camera.device.intrinsics.size);
  });
}

}  // namespace laterna
