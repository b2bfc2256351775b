#include "calib/selfcal/held_out_points.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

constexpr double rounding_px = 1e-4;

void split(const TrackRig& rig, std::vector<int> points, int levels, int& blocks, std::vector<int>& block) {
  if (levels == 0 || points.size() < 2) {
    for (const int p : points) block[p] = blocks;
    blocks += !points.empty();
    return;
  }
  glm::dvec3 low = rig.points[points.front()], high = low;
  for (const int p : points) low = glm::min(low, rig.points[p]), high = glm::max(high, rig.points[p]);
  const glm::dvec3 extent = high - low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const auto middle = points.begin() + std::ptrdiff_t(points.size() / 2);
  std::nth_element(points.begin(), middle, points.end(),
                   [&](int a, int b) { return rig.points[a][axis] < rig.points[b][axis]; });
  split(rig, {points.begin(), middle}, levels - 1, blocks, block);
  split(rig, {middle, points.end()}, levels - 1, blocks, block);
}

using Sightings = std::vector<TrackSighting>;

// Σ(du² + dv²) of a point's sightings where they put it themselves; none where it comes to lie behind.
std::optional<double> own_misfit(const Tracks& tracks, const TrackColumns& columns, const TrackRig& rig,
                                 Sightings::const_iterator begin, Sightings::const_iterator end) {
  glm::dvec3 x = rig.points[begin->point];
  double misfit = 0;
  for (int round = 0; round < 8; ++round) {
    Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    misfit = 0;
    for (auto s = begin; s != end; ++s) {
      Eigen::Matrix<double, 2, 3, Eigen::RowMajor> j;
      const auto pixel = predict(tracks, columns, rig, s->station, x, nullptr, j.data());
      if (!pixel) return std::nullopt;
      const Eigen::Vector2d r(pixel->x - s->pixel.x, pixel->y - s->pixel.y);
      const double weight = 1 / (s->sigma_px * s->sigma_px);
      h += weight * j.transpose() * j, g += weight * j.transpose() * r;
      misfit += r.squaredNorm();
    }
    const Eigen::Vector3d step = h.ldlt().solve(-g);
    if (!step.allFinite()) return std::nullopt;
    x += glm::dvec3(step.x(), step.y(), step.z());
  }
  return misfit;
}

// The rms of a block's points under a rig; none where one of them comes to lie behind.
std::optional<HeldOutPose> fold_of(const Tracks& tracks, const TrackRig& rig, const std::vector<int>& block,
                                   int fold) {
  const TrackColumns columns = columns_of(tracks);
  HeldOutPose result{fold, 0, 0, {}};
  double sum = 0;
  const auto& all = tracks.sightings;
  for (auto begin = all.begin(), end = begin; begin != all.end(); begin = end) {
    while (end != all.end() && end->point == begin->point) ++end;
    if (block[begin->point] != fold || end - begin < 2) continue;
    const auto misfit = own_misfit(tracks, columns, rig, begin, end);
    if (!misfit) return std::nullopt;
    sum += *misfit, result.sightings += std::size_t(end - begin);
  }
  if (result.sightings > 0) result.rms_px = std::max(rounding_px, std::sqrt(sum / double(result.sightings)));
  return result;
}

}  // namespace

std::vector<int> point_blocks(const TrackRig& rig, int levels) {
  std::vector<int> placed, block(rig.points.size(), -1);
  for (int p = 0; p < int(rig.points.size()); ++p)
    if (rig.has_point(p)) placed.push_back(p);
  int blocks = 0;
  split(rig, std::move(placed), levels, blocks, block);
  return block;
}

HeldOut hold_out_points(const Tracks& tracks, const TrackRig& rig, const std::vector<UnitBaseline>& units) {
  const std::vector<int> block = point_blocks(rig);
  const int blocks = block.empty() ? 0 : 1 + *std::max_element(block.begin(), block.end());
  HeldOut held_out;
  double sum = 0, count = 0;
  for (int fold = 0; fold < blocks; ++fold) {
    Tracks rest = tracks;
    std::erase_if(rest.sightings, [&](const TrackSighting& s) { return block[s.point] == fold; });
    if (tracks.sightings.size() - rest.sightings.size() < 8) continue;
    const TrackCovariance c = track_covariance(rest, rig, units, 1);
    const auto result =
        c.step.empty() ? std::nullopt : fold_of(tracks, moved(tracks, rig, c.step), block, fold);
    if (!result) {
      held_out.failed.push_back(fold);
      continue;
    }
    held_out.folds.push_back(*result);
    sum += result->rms_px * result->rms_px * double(result->sightings), count += double(result->sightings);
  }
  held_out.rms_px = count > 0 ? std::sqrt(sum / count) : 0;
  return held_out;
}

}  // namespace laterna
