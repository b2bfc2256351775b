// Do the residuals of neighbouring blocks agree? Noise does not; a wrong mesh, camera or lens does.
#pragma once

#include "calib/projection_rows.h"

#include <optional>

namespace laterna {

struct ResidualStructure {
  double moran_z = 0;  ///< Moran's I of the blocks' mean residuals in standard deviations from chance
  double smooth_rms_px =
      0;  ///< of the part that neighbours share: sqrt of the mean of m_i·m_j over neighbours, at least 0
};

/// Of the mean residual vectors m of the table's clusters, each with its four nearest clusters in projector
/// pixels as neighbours: I = (Σ m_i·m_j / pairs) / (Σ |m_i|² / clusters), which has mean 0 (to 1/clusters)
/// and variance 1/(2·pairs) where the blocks' errors are independent (Moran 1950; two components). None with
/// fewer than 16 clusters of 8 points or more, or where a point lies behind.
std::optional<ResidualStructure> residual_structure(const PointTable& points, const LensGradient& lens,
                                                    const ProjectorState& state);

}  // namespace laterna
