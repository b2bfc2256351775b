// Vignetting of projectors and cameras. Stage: weight.
//
//   cos4:       V = cos⁴θ = 1/(1 + tan²θ)²
//   polynomial: V = max(0, 1 + c1·tan²θ + c2·tan⁴θ + ...)
//   map:        V = the picture's value, bilinear; stretched so that both pictures span the same rectangle
//
// with θ the angle from the device's optical axis: it stands on top of the irradiance, which of itself is
// even on a facing plane. A projector's V multiplies white_lx. A camera's V multiplies the albedo, so that
// ambient light is dimmed alike.
#pragma once

#include "render/effects/pixel_geometry.h"

namespace laterna {

/// V. `map` is needed for that model only; `pixel` is the device's, of a picture of `size`.
double vignetting_share(const Vignetting& vignetting, const Image<float>* map, double tan2_theta,
                        const glm::dvec2& pixel, const glm::ivec2& size);

void apply_projector_vignetting(LightMap& light, const PixelGeometry& geometry, const Projector& projector);

/// After every effect that reads the albedo. `geometry` may be of `surface` itself.
void apply_camera_vignetting(SurfaceMap& surface, const PixelGeometry& geometry, const Camera& camera);

}  // namespace laterna
