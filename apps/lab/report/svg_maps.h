// Figures over a projector's image, as SVG: residual vectors, and maps at several depths.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

#include <string>

namespace laterna {

/// The colour of a direction, radians from +u towards +v (down): gold against violet, orange against blue, so
/// that none relies on red against green, and all read on white and on black.
std::string direction_colour(double angle);

/// residual_figure() (trial_figures.h) as strokes that begin at their pixel; a stroke of 14 units is the rms,
/// longer ones are cut. With a wheel that says which colour is which direction.
std::string residual_vectors_svg(const nlohmann::json& residual, glm::ivec2 projector_size_px);

enum class GridQuantity { difference, sigma };

/// The grid of projection_figure() at each of its depths, in viridis from 0 to the largest: the length of
/// (du, dv) with strokes along it, or sigma_px. Cells whose number is null are left out.
std::string projection_map_svg(const nlohmann::json& projection, glm::ivec2 projector_size_px,
                               GridQuantity quantity);

}  // namespace laterna
