// The rows of A: image = A·pattern + ambient, a region of the camera's image at a time. A is never held
// whole.
#pragma once

#include "render/direct_light.h"
#include "render/pixel_array.h"

#include <functional>

namespace laterna {

/// Light that reaches a camera pixel from one place of the projector's picture.
struct LightEntry {
  double u_px, v_px;       ///< projector pixel
  double weight;           ///< luminance at the camera pixel, in cd/m², where the picture is 1 at (u, v)
  float footprint_px = 0;  ///< side of the square of the picture that it gathers from; 0: a point
};

/// The rows of A for a region's pixels, row by row: those of pixel p are entries[begin[p]] to
/// entries[begin[p + 1] - 1]. One projector is the source of them all.
struct LightRows {
  PixelRegion region;
  std::vector<std::uint32_t> begin;       ///< region.size() + 1
  std::vector<LightEntry> entries;        ///< none where the pixel is dark
  std::vector<double> ambient_cd_per_m2;  ///< one per pixel
};

/// Fills `rows` for rows.region, which the caller sets; what `rows` held before is replaced. Called on
/// several threads at once. Effects wrap one of these in another.
using RowSource = std::function<void(LightRows& rows)>;

/// Rows of direct light, one entry where lit, from maps that cover the region (the whole image's, say).
void direct_rows(const SurfaceMap& surface, const LightMap& light, double ambient_lx, LightRows& rows);

/// Antialiasing: each camera pixel is the mean of `count` rays.
struct PixelSamples {
  int count = 1;  ///< 1: the pixel's centre, exactly
  std::uint64_t seed = 0;
};

/// Where sample `sample` of a camera's pixel lies beside the pixel's centre, in [-0.5, 0.5)². The pixel is
/// cut into columns × rows = count cells, as near to square as count's divisors allow, and each sample is
/// uniform in a cell of its own: Philox4x32-10 with counter (x, y, sample/4, camera) under the key `seed`.
/// (0, 0) where count is 1.
glm::vec2 sample_offset_px(const PixelSamples& samples, std::uint32_t camera, const glm::ivec2& pixel,
                           int sample);

/// Direct light traced on request, region by region: each of a pixel's samples is traced as if it were a
/// pixel, its entry (where lit) weighs 1/count of what the pixel's would, and the ambient light is the mean.
/// The arguments must outlive the result. Throws InputError where samples.count is outside 1..4096.
RowSource trace_rows(const RayScene& rays, const Scene& scene, int camera, const CameraRays& directions,
                     int projector, const PixelSamples& samples = {});

}  // namespace laterna
