#include "apps/lab/score/fitted.h"

#include "apps/lab/score/keystone.h"

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace laterna {

namespace {

constexpr std::size_t fewest_points = 20;

// Pixels of a result and true ones, side by side.
struct Pairs {
  std::vector<glm::dvec2> found, expected;
};

Pairs usable(const std::vector<glm::dvec2>& pixels, const Probe& probe) {
  Pairs pairs;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!(glm::distance(pixels[i], probe.true_pixels[i]) < probe.diagonal_px)) continue;
    pairs.found.push_back(pixels[i]);
    pairs.expected.push_back(probe.true_pixels[i]);
  }
  return pairs;
}

template <class Map>
double remaining_px2(std::vector<glm::dvec2> pixels, const Probe& probe, const Map& map) {
  for (glm::dvec2& pixel : pixels) pixel = map(pixel);
  return squared_error_px2(pixels, probe);
}

void add_overscan(const std::vector<glm::dvec2>& pixels, const Pairs& pairs, const Probe& probe,
                  std::vector<FittedUndo>& found) {
  const glm::dvec2 size(probe.truth.projector.intrinsics.size), middle = (size - 1.0) / 2.0;
  glm::dvec2 above(0.0), below(0.0);
  for (std::size_t i = 0; i < pairs.found.size(); ++i) {
    const glm::dvec2 d = pairs.found[i] - middle;
    above += d * (pairs.expected[i] - middle), below += d * d;
  }
  const glm::dvec2 each = above / below, both((above.x + above.y) / (below.x + below.y));
  for (const auto& [scale, parameters] : {std::pair(both, 1), std::pair(each, 2)}) {
    const bool is_sound = scale.x > 0.5 && scale.x < 2 && scale.y > 0.5 && scale.y < 2;
    if (!is_sound) continue;
    found.push_back({"overscan", parameters,
                     remaining_px2(pixels, probe,
                                   [&, s = scale](const glm::dvec2& p) { return middle + s * (p - middle); }),
                     fmt::format("the picture is scaled by {:.4f} × {:.4f}", scale.x, scale.y)});
  }
}

glm::dvec2 apply(const cv::Matx33d& h, const glm::dvec2& pixel) {
  const cv::Vec3d q = h * cv::Vec3d(pixel.x, pixel.y, 1);
  return glm::dvec2(q[0], q[1]) / q[2];
}

// How far the corners move inwards, in pixels, each along both axes.
std::array<double, 8> inward_px(const cv::Matx33d& h, glm::ivec2 size) {
  std::array<double, 8> moves{};
  for (int corner = 0; corner < 4; ++corner) {
    const glm::dvec2 side(corner & 1 ? 1 : 0, corner & 2 ? 1 : 0);
    const glm::dvec2 from = side * glm::dvec2(size) - 0.5;
    const glm::dvec2 move = (apply(h, from) - from) * (1.0 - 2.0 * side);
    moves[2 * corner] = move.x, moves[2 * corner + 1] = move.y;
  }
  return moves;
}

bool is_keystone(const cv::Matx33d& h, glm::ivec2 size) {
  const std::array<double, 8> moves = inward_px(h, size);
  const auto [least, most] = std::minmax_element(moves.begin(), moves.end());
  const double farthest = std::max(size.x, size.y) / 2.0;
  return (*least > -1 && *most > 2 && *most < farthest) || (*most < 1 && *least < -2 && *least > -farthest);
}

// What the best zoom and shift along each axis leave: Σ|e|² about the regression lines, as a share of Σ|e|².
double beyond_zoom_and_shift(const Pairs& pairs) {
  const double n = double(pairs.found.size());
  double left = 0, all = 0;
  for (int axis = 0; axis < 2; ++axis) {
    double x = 0, e = 0, xx = 0, xe = 0, ee = 0;
    for (std::size_t i = 0; i < pairs.found.size(); ++i) {
      const double found = pairs.found[i][axis], error = pairs.expected[i][axis] - found;
      x += found, e += error, xx += found * found, xe += found * error, ee += error * error;
    }
    left += ee - e * e / n - std::pow(xe - x * e / n, 2) / (xx - x * x / n);
    all += ee;
  }
  return left / all;
}

void add_homography(const std::vector<glm::dvec2>& pixels, const Pairs& pairs, const Probe& probe,
                    std::vector<FittedUndo>& found) {
  std::vector<cv::Point2d> from, to;
  for (const glm::dvec2& p : pairs.found) from.emplace_back(p.x, p.y);
  for (const glm::dvec2& p : pairs.expected) to.emplace_back(p.x, p.y);
  const cv::Mat fitted = cv::findHomography(from, to);
  if (fitted.empty()) return;
  const cv::Matx33d h = fitted;
  if (!is_keystone(h, probe.truth.projector.intrinsics.size) || beyond_zoom_and_shift(pairs) < 0.1) return;
  found.push_back({"keystone", 8,
                   remaining_px2(pixels, probe, [&](const glm::dvec2& p) { return apply(h, p); }),
                   "the picture is warped by a homography"});
}

}  // namespace

std::vector<FittedUndo> fitted_undoings(const ScoreRig& result, const Probe& probe) {
  const std::vector<glm::dvec2> pixels = result_pixels(result, probe);
  const Pairs pairs = usable(pixels, probe);
  std::vector<FittedUndo> found;
  if (pairs.found.size() < fewest_points) return found;
  add_overscan(pixels, pairs, probe, found);
  add_homography(pixels, pairs, probe, found);
  if (const auto keystone = keystone_of(result, probe))
    found.push_back({"keystone", 2, keystone->remaining_px2, keystone->words});
  return found;
}

double without_overscan_px2(const std::vector<glm::dvec2>& pixels, const Probe& probe) {
  double least = squared_error_px2(pixels, probe);
  const Pairs pairs = usable(pixels, probe);
  std::vector<FittedUndo> found;
  if (pairs.found.size() >= fewest_points) add_overscan(pixels, pairs, probe, found);
  for (const FittedUndo& undo : found) least = std::min(least, undo.remaining_px2);
  return least;
}

}  // namespace laterna
