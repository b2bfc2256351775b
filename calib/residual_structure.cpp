#include "calib/residual_structure.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace laterna {

namespace {

constexpr std::size_t least_points = 8, least_blocks = 16, neighbours = 4;

/// The mean of a cluster's pixels and residuals.
struct Block {
  glm::dvec2 pixel{0.0}, residual{0.0};
};

std::optional<std::vector<Block>> blocks_of(const PointTable& points, const LensGradient& lens,
                                            const ProjectorState& state) {
  std::vector<Block> blocks;
  for (std::size_t g = 0; g < points.cluster_count(); ++g) {
    const std::size_t begin = points.cluster_begin[g], end = points.cluster_begin[g + 1];
    if (end - begin < least_points) continue;
    Block block;
    for (std::size_t i = begin; i < end; ++i) {
      double pixel[2];
      if (!project_with_rows(lens, state, {points.x[i], points.y[i], points.z[i]}, pixel, nullptr)) return {};
      block.pixel += glm::dvec2(points.u[i], points.v[i]);
      block.residual += glm::dvec2(pixel[0] - points.u[i], pixel[1] - points.v[i]);
    }
    block.pixel /= double(end - begin), block.residual /= double(end - begin);
    blocks.push_back(block);
  }
  return blocks;
}

// The nearest others of a block.
std::vector<std::size_t> nearest(const std::vector<Block>& blocks, std::size_t k) {
  std::vector<std::size_t> order;
  for (std::size_t other = 0; other < blocks.size(); ++other)
    if (other != k) order.push_back(other);
  const auto distance = [&](std::size_t other) {
    const glm::dvec2 d = blocks[other].pixel - blocks[k].pixel;
    return glm::dot(d, d);
  };
  std::partial_sort(order.begin(), order.begin() + neighbours, order.end(),
                    [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
  order.resize(neighbours);
  return order;
}

}  // namespace

std::optional<ResidualStructure> residual_structure(const PointTable& points, const LensGradient& lens,
                                                    const ProjectorState& state) {
  const auto blocks = blocks_of(points, lens, state);
  if (!blocks || blocks->size() < least_blocks) return {};
  double shared = 0, own = 0, pairs = 0;
  for (std::size_t k = 0; k < blocks->size(); ++k) {
    const glm::dvec2& m = (*blocks)[k].residual;
    own += glm::dot(m, m) / double(blocks->size());
    for (const std::size_t other : nearest(*blocks, k))
      shared += glm::dot(m, (*blocks)[other].residual), ++pairs;
  }
  shared /= pairs;
  // Most pairs are counted from both ends: half of them are independent.
  return ResidualStructure{own > 0 ? shared / own * std::sqrt(pairs) : 0, std::sqrt(std::max(0.0, shared))};
}

}  // namespace laterna
