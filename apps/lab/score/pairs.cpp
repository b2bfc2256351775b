#include "apps/lab/score/pairs.h"

#include "apps/lab/score/fitted.h"
#include "calib/correspondences.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace laterna {

namespace {

constexpr std::size_t few_points = 100, looked_at_fully = 12;

Probe thinned(const Probe& probe) {
  Probe thin{probe.truth, probe.alignment};
  thin.diagonal_px = probe.diagonal_px;
  for (const std::size_t i : evenly_spread(probe.points_world.size(), few_points)) {
    if (i < probe.surface_begin) thin.surface_begin = thin.points_world.size() + 1;
    thin.points_world.push_back(probe.points_world[i]);
    thin.true_pixels.push_back(probe.true_pixels[i]);
  }
  return thin;
}

// Indices into the undoings, the first undone first; `second` none: an overscan.
struct Order {
  std::size_t first;
  std::optional<std::size_t> second;
  double remaining_px2 = 0;
};

std::vector<glm::dvec2> undone(const std::vector<Undo>& undos, const Order& order, const ScoreRig& result,
                               const Probe& probe) {
  const Undo& a = undos[order.first];
  ScoreRig rig = a.rig(result);
  if (order.second) rig = undos[*order.second].rig(rig);
  std::vector<glm::dvec2> pixels = result_pixels(rig, probe);
  undo_pixels(a, pixels);
  if (order.second) undo_pixels(undos[*order.second], pixels);
  return pixels;
}

double remaining_px2(const std::vector<Undo>& undos, const Order& order, const ScoreRig& result,
                     const Probe& probe) {
  const std::vector<glm::dvec2> pixels = undone(undos, order, result, probe);
  return order.second ? squared_error_px2(pixels, probe) : without_overscan_px2(pixels, probe);
}

std::vector<Order> all_orders(const std::vector<Undo>& undos) {
  std::vector<Order> orders;
  for (std::size_t i = 0; i < undos.size(); ++i) {
    orders.push_back({i, std::nullopt});
    for (std::size_t j = 0; j < undos.size(); ++j)
      if (undos[i].suspect != undos[j].suspect) orders.push_back({i, j});
  }
  return orders;
}

// What the best single undoing of a name leaves.
double alone_px2(const std::vector<Undo>& undos, const std::string& name, const ScoreRig& result,
                 const Probe& probe) {
  double least = std::numeric_limits<double>::infinity();
  for (const Undo& undo : undos) {
    if (undo.suspect != name) continue;
    std::vector<glm::dvec2> pixels = result_pixels(undo.rig(result), probe);
    undo_pixels(undo, pixels);
    least = std::min(least, squared_error_px2(pixels, probe));
  }
  return least;
}

bool leaves_less(const Order& a, const Order& b) { return a.remaining_px2 < b.remaining_px2; }

}  // namespace

Pair best_pair(const ScoreRig& result, const Probe& probe) {
  const std::vector<Undo> undos = undoings(probe.truth.projector.intrinsics.size);
  const Probe thin = thinned(probe);
  std::vector<Order> orders = all_orders(undos);
  for (Order& order : orders) order.remaining_px2 = remaining_px2(undos, order, result, thin);
  const std::size_t few = std::min(looked_at_fully, orders.size());
  std::partial_sort(orders.begin(), orders.begin() + std::ptrdiff_t(few), orders.end(), leaves_less);
  orders.resize(few);
  for (Order& order : orders) order.remaining_px2 = remaining_px2(undos, order, result, probe);
  const Order best = *std::min_element(orders.begin(), orders.end(), leaves_less);
  Pair pair{undos[best.first].suspect, best.second ? undos[*best.second].suspect : "overscan",
            best.remaining_px2};
  if (best.second && alone_px2(undos, pair.second, result, thin) < alone_px2(undos, pair.first, result, thin))
    std::swap(pair.first, pair.second);
  return pair;
}

}  // namespace laterna
