// Colour: a projector of three primaries, and what each pixel of a camera sees of them. Stage: weight.
//
//   weight_j = weight·M(c, j)·s_j,   constant light = constant light·Σ_j M(c, j),
//
// for primary j = 0, 1, 2 (red, green, blue) and a pixel behind a filter of channel c. M is the pair's
// mixing, the identity where [[colour]] has none; s is [patterns] colour. A mono camera takes the mean of M's
// rows. So grey pictures look as they do without colour, to rounding, wherever M's rows add to 1. Light that
// no picture changes (ambient light, the black of idle projectors) is white. Surfaces reflect all primaries
// alike.
//
// Costs nothing where every primary plays the same pictures at the same time: one entry then has the sum of
// the weights. Else an entry becomes up to three.
#pragma once

#include "render/light_rows.h"
#include "sim/scene.h"

namespace laterna {

/// Whether the primaries of the scene's projectors play pictures of their own.
bool patterns_have_colour(const Scene& scene);

/// The channel of a camera pixel: 0 red, 1 green, 2 blue. The filter is not mono.
int channel_at(ColourFilter filter, const glm::ivec2& camera_pixel);

/// What a camera pixel sees of each primary's light: M's row.
glm::dvec3 primaries_seen(const Scene& scene, int camera, int projector, const glm::ivec2& camera_pixel);

/// Rows of white light in colour; with the effect off, `rows` itself. With `each_primary` the entries of
/// source i are split over sources 3i + j, those without weight left out.
RowSource apply_colour(RowSource rows, const Scene& scene, int camera, int projector, bool each_primary);

}  // namespace laterna
