// Rows of one camera and one projector, traced on request: no map of the whole image is held.
#pragma once

#include "render/image_rows.h"
#include "render/pixel_samples.h"
#include "sim/scene.h"

namespace laterna {

/// Rows of what `camera` sees of `projector`'s light, region by region, with every effect of the scene that
/// acts on rays, surface, weight or rows. The other projectors show black: where `black_level` is on they add
/// constant light.
///
/// Each of a pixel's samples is traced as if it were a pixel, its entries weigh 1/count of what the pixel's
/// would, and constant light is the mean. With inter-reflection (render/effects/inter_reflection.h) each of a
/// sample's paths adds an entry for each lit point that it visits, and the black of idle projectors there.
/// Where the projector's lens or panel blurs, entries are then spread over the panel (render/panel_blur.h).
/// The arguments must outlive the result. Throws InputError where samples.count is outside 1..4096.
RowSource trace_rows(const RayScene& rays, const Scene& scene, int camera, const CameraRays& directions,
                     int projector, const PixelSamples& samples = {});

/// The samples that the scene asks for: samples_per_pixel with antialiasing, or where the camera's lens
/// blurs; else 1. Where only the lens blurs they lie at the pixel's centre.
PixelSamples samples_of(const Scene& scene, int camera, std::uint64_t seed);

/// What a camera sees beside one projector's pictures: the others that show some light as black.
struct IdleProjector {
  int projector;
  double share;  ///< light of black over light of white
};
std::vector<IdleProjector> idle_projectors(const Scene& scene, int projector);

/// Whether a pixel's row is the direct light at its centre: rows from maps of the whole image
/// (direct_rows) are then those of trace_rows, bit by bit.
bool rows_are_direct(const Scene& scene, int camera);

/// Regions for ImageRows whose rows fit in the cache's neighbourhood: as large as it has by default, but of
/// no more than 2¹⁸ entries, or one 4×4 tile; an entry that is blurred counts as all
/// the cells that it may spread to (panel_blur.h).
glm::ivec2 region_px_of(const Scene& scene, const PixelSamples& samples);

}  // namespace laterna
