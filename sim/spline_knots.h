// Where the knots of mrcal's splined lens models stand.
#pragma once

#include <glm/glm.hpp>

#include <string>
#include <vector>

namespace laterna {

/// LENSMODEL_SPLINED_STEREOGRAPHIC_...: pixel = (fx, fy)·(u + Δu(u)) + (cx, cy), u = 2·tan(θ/2)·(x, y)/|(x,
/// y)| with θ the angle from the axis, and Δu a B-spline over a grid of knots (mrcal, "Splined stereographic
/// lens model").
inline bool is_splined(const std::string& lens_model) {
  return lens_model.starts_with("LENSMODEL_SPLINED_STEREOGRAPHIC_");
}

/// The u of each knot of a splined model, row by row; knot k has the lens parameters 2k (x) and 2k + 1 (y).
/// Throws InputError for another model.
std::vector<glm::dvec2> spline_knots(const std::string& lens_model);

}  // namespace laterna
