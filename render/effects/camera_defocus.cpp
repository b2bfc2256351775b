#include "render/effects/camera_defocus.h"

namespace laterna {

glm::vec2 lens_point_m(const Optics& optics, const PixelSamples& samples, std::uint32_t camera,
                       const glm::ivec2& pixel, int sample) {
  if (samples.count == 1) return {0, 0};
  const glm::vec2 square = stratified_square(samples, camera, pixel, sample, SampleUse::aperture);
  return static_cast<float>(*optics.aperture_m / 2) * disc_from_square(square);
}

}  // namespace laterna
