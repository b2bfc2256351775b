// The rows' transpose: from a camera's picture to a projector's.
#pragma once

#include "render/image_rows.h"
#include "sim/image.h"
#include "sim/lookup.h"

#include <cstdint>

namespace laterna {

/// Aᵀ·y: at each pixel of one source, the sum over camera pixels and its entries of weight·share·y, where
/// share is what `lookup` takes of the texel for the entry. So y·(A·p) = p·(Aᵀ·y) for any picture p in [0,
/// 1]. `camera_image` has the camera's size. (Dual photography: Sen et al., SIGGRAPH 2005.)
Image<double> apply_transpose(const ImageRows& image, Lookup lookup, const Image<float>& camera_image,
                              glm::ivec2 projector_size, std::uint32_t source = 0);

}  // namespace laterna
