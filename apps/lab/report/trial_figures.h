// The numbers behind a round trip's figures: what result.json does not hold and a page needs to draw.
#pragma once

#include "apps/lab/trial.h"

#include <nlohmann/json.hpp>

namespace laterna {

/// {"name", "size": [W, H], "fx", "fy", "cx", "cy", "lens": {"model"}, "device_from_world": 3×4}.
nlohmann::json device_figure(const Device& device);

/// {"projectors", "cameras": [device_figure], "meshes": [{"name", "triangles_in_file", "positions": [x, y, z,
/// ...], "triangles": [i, j, k, ...]}]}, world frame, m. A mesh of more than 20,000 triangles is thinned by
/// merging the vertices of each cell of a grid (96 cells along its longest side): for looking at only.
nlohmann::json rig_figure(const Scene& scene);

/// One view's residuals e = decoded - projected by the estimate, projector pixels, of at most 20,000 valid
/// pixels that see a surface (`points_world`: what the solver was told of them, m, NaN for none), evenly
/// spread: {"camera", "projector", "points", "used", "rms_px", "sigma_px",
/// "sample": [[u, v, du, dv], ...], "histogram": {"edges_px", "count", "predicted"}}. The histogram counts du
/// and dv together over ±4 rms(du, dv) in 40 bins; `predicted` is how many normal deviates of the stated
/// standard deviations fall into each. null where nothing is valid.
nlohmann::json residual_figure(const DecodedMap& decoded, const PixelArray<glm::dvec3>& points_world,
                               const Device& estimate, const std::string& camera,
                               const std::string& projector);

/// Estimate against truth, and its own standard deviation, over the projector's image: {"projector",
/// "lit_depths_m": [5 %, 95 %], "depths_m": [three of them], "grid": [{"depth_m", "u", "v", "du", "dv",
/// "sigma_px"}], "by_range": [{"depth_m", "error_rms_px", "predicted_rms_px"}]}. The grid is image_grid() at
/// the nearest, the middle and the farthest depth of the volume; by_range runs from half the nearest to twice
/// the farthest. sigma is sqrt(trace(J·C·Jᵀ)), as rms_px. null where no point lies in front.
nlohmann::json projection_figure(const Device& truth, const Device& estimate,
                                 const std::vector<double>& covariance,
                                 std::span<const glm::dvec3> surface_points);

/// At most 3,000 of the surface's points that a projector lights, as [x, y, z, ...] in m.
nlohmann::json points_figure(std::span<const glm::dvec3> points);

}  // namespace laterna
