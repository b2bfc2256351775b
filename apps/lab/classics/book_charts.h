// The book's spotlight measured: what a map, a 3D texture and a coarse mesh make of it.
#pragma once

#include "apps/lab/classics/classic.h"
#include "apps/lab/classics/core_picture.h"

namespace laterna {

/// Each adds a chart, and its figures, of the first projector's light at the pixels that see it.

/// The intensity map of n×n texels against the cone: rms over the cone's pixels, in shares of its peak.
void chart_intensity(const CoreView& view, ClassicResult& result);

/// The attenuation texture of n³ texels, indexed right and naively, against exact 1/d²: rms of the ratio - 1.
void chart_attenuation(const CoreView& view, ClassicResult& result);

/// Light at the vertices of the first object, a plane of n×n cells, against light at each sample: rms over
/// its pixels, in shares of the peak. Adds a picture of three meshes.
void chart_vertices(const CoreView& view, ClassicResult& result);

}  // namespace laterna
