// Veiling glare of a camera's lens. Stage: replay.
//
//   L'(p) = (1 - g)·L(p) + g·mean(L),
//
// the mean over the image, at each instant: the lens takes a share g of the light and spreads it evenly, so
// that the sum over the image stays. It acts before the colour filter, on each primary by itself.
//
// mean(L) is linear in the pattern: (1/N)·Aᵀ·1 in inner product with it. So the rows keep (1 - g) of their
// weight, and each pixel gets one more entry, of weight g, into a source of a single pixel whose light in
// frame k is the mean over the image in frame k. Costs an entry per pixel, a pass over the rows beforehand,
// and a stack of values in place of bits.
#pragma once

#include "render/image_rows.h"
#include "render/show.h"
#include "sim/scene.h"

namespace laterna {

/// The image's mean luminance in cd/m²: of constant light, and per projector pixel of what its light adds.
struct MeanLight {
  double constant = 0;
  Image<double> of_pixel;
  double white = 0;  ///< the sum of of_pixel
};

/// The same bits for any number of threads. The rows have source 0 alone.
MeanLight mean_light_of(const ImageRows& image, Lookup lookup, const glm::ivec2& projector_size);

/// Of one pixel: the image's mean luminance in each frame over that of the white picture.
PatternStack veil_of(const MeanLight& mean, const PatternStack& frames);

/// The rows with glare g in [0, 1]: the new entries are of source 1, veil_of() of what source 0 plays.
ImageRows apply_camera_glare(const ImageRows& image, const MeanLight& mean, double glare);

}  // namespace laterna
