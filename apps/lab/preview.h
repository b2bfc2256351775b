// One picture of the rig before anything is captured: who stands where, what is lit, what overlaps.
#pragma once

#include "apps/lab/canvas.h"
#include "apps/lab/simulation.h"

namespace laterna {

/// Left: the rig from outside, by a virtual observer: meshes shaded, projector light in colour, frusta as
/// lines. Right: what each camera sees (at most three cameras), lit surface in the projectors' colours, with
/// the overlap in per cent.
Canvas preview_picture(const Scene& scene, const Traced& traced);

/// The overlaps as lines of text.
std::string overlap_text(const Scene& scene, const Traced& traced);

}  // namespace laterna
