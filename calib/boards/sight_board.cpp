#include "calib/boards/sight_board.h"

#include "calib/median.h"
#include "sim/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace laterna {

namespace {

double nearest_other(const std::vector<FoundPoint>& found, std::size_t k) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t other = 0; other < found.size(); ++other)
    if (other != k) nearest = std::min(nearest, glm::distance(found[k].pixel, found[other].pixel));
  return nearest;
}

}  // namespace

void add_camera_sightings(const std::vector<FoundPoint>& found, const PrintedBoard& board, int device,
                          int pose, std::vector<Sighting>& sightings) {
  const std::vector<glm::dvec3> points = board_points(board);
  for (const FoundPoint& p : found)
    sightings.push_back({device, pose, p.index, points[std::size_t(p.index)], p.pixel, 0.1});
}

BoardReading add_projector_sightings(const std::vector<FoundPoint>& found, const PrintedBoard& board,
                                     const DecodedMap& map, int device, int pose, LocalMap local,
                                     std::vector<Sighting>& sightings, double share, int camera) {
  const std::vector<glm::dvec3> points = board_points(board);
  std::vector<std::optional<ProjectorPixel>> read(found.size());
  parallel_for(found.size(), [&](std::size_t k) {
    const double radius = std::clamp(share * nearest_other(found, k), 5.0, 40.0);
    read[k] = projector_pixel_at(map, found[k].pixel, {.map = local, .radius_px = radius});
  });
  std::vector<double> residuals;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (!read[k]) continue;
    residuals.push_back(read[k]->residual_px);
    sightings.push_back({device, pose, found[k].index, points[std::size_t(found[k].index)], read[k]->pixel,
                         std::max(read[k]->sigma_px, 1e-4), ReadAt{camera, found[k].pixel, read[k]->slope}});
  }
  return {residuals.size(), median(residuals)};
}

}  // namespace laterna
