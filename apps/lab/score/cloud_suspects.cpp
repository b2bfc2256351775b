#include "apps/lab/score/cloud_suspects.h"

#include "apps/lab/score/cloud_undo.h"
#include "calib/correspondences.h"
#include "calib/median.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace laterna {

namespace {

constexpr std::size_t looked_at = 500;
constexpr double kept_share = 0.8, needed_share = 0.95, within_noise = 3, narrowest = 0.4, widest = 1.6;
constexpr double worst = std::numeric_limits<double>::infinity();

// Of the smaller four fifths, each min(e, most)².
double trimmed_mean_square(std::span<const double> errors, double most) {
  std::vector<double> squares;
  for (const double e : errors)
    if (!std::isnan(e)) squares.push_back(std::pow(std::min(e, most), 2));
  if (squares.empty()) return worst;
  const auto end = squares.begin() + std::ptrdiff_t(std::ceil(kept_share * double(squares.size())));
  std::partial_sort(squares.begin(), end, squares.end());
  return std::accumulate(squares.begin(), end, 0.0) / double(end - squares.begin());
}

std::vector<glm::dvec3> places(const std::vector<CloudPoint>& points) {
  std::vector<glm::dvec3> x(points.size());
  std::transform(points.begin(), points.end(), x.begin(), [](const CloudPoint& p) { return p.x_world; });
  return x;
}

class Judge {
 public:
  Judge(const CloudGround& ground, const Alignment& alignment, const CloudScale& scale)
      : ground_(ground), options_{alignment.world, alignment.scale}, scale_(scale) {}

  /// E of points that an undoing has moved, or not (`is_undone`).
  double operator()(std::vector<CloudPoint> points, bool is_undone) const {
    const std::vector<glm::dvec3> truth = true_points(ground_, points);
    if (options_.motion || options_.scale) {
      const auto fit = aligned_to(points, truth, options_);
      if (!fit) return worst;
      for (CloudPoint& p : points) p.x_world = apply(*fit, p.x_world);
    }
    if (is_undone && !ground_.camera && !is_as_wide(points)) return worst;
    const CloudErrors errors = cloud_errors(ground_, points, truth);
    double e = trimmed_mean_square(ground_.camera ? errors.point_m : errors.surface_m, scale_.most_m) /
               std::pow(scale_.noise_m, 2);
    if (ground_.projector)
      e += trimmed_mean_square(errors.projector_px, 10 * within_noise * scale_.noise_px) /
           std::pow(scale_.noise_px, 2);
    return e;
  }

  double noise() const { return within_noise * within_noise * (ground_.projector ? 2 : 1); }

 private:
  bool is_as_wide(const std::vector<CloudPoint>& points) const {
    const double ratio = spread_m(places(points)) / scale_.surface_spread_m;
    return ratio >= narrowest && ratio <= widest;
  }

  const CloudGround& ground_;
  SimilarityOptions options_;
  const CloudScale& scale_;
};

// An undoing that explains the error. What needs less comes first where two do as well.
struct Told {
  const CloudUndo* undo;
  double remaining;
  std::size_t steps() const { return undo->suspects.size() + (undo->frame.empty() ? 0 : 1); }
};

std::vector<Told> told_undoings(const std::vector<CloudUndo>& undos, const std::vector<CloudPoint>& points,
                                const Judge& judge, double error) {
  std::vector<Told> told;
  for (const CloudUndo& undo : undos) {
    std::vector<CloudPoint> edited = points;
    for (CloudPoint& p : edited) undo.edit(p);
    const Told t{&undo, judge(std::move(edited), true)};
    const double explains = 1 - t.remaining / error;
    if (explains >= needed_share || (t.remaining <= judge.noise() && explains > 0.5)) told.push_back(t);
  }
  const double one_step = 0.01 * error;
  std::stable_sort(told.begin(), told.end(), [&](const Told& a, const Told& b) {
    return a.remaining + one_step * double(a.steps()) < b.remaining + one_step * double(b.steps());
  });
  return told;
}

}  // namespace

double spread_m(const std::vector<glm::dvec3>& points) {
  glm::dvec3 middle;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values(points.size());
    std::transform(points.begin(), points.end(), values.begin(),
                   [&](const glm::dvec3& x) { return x[axis]; });
    middle[axis] = median(std::move(values));
  }
  std::vector<double> distances(points.size());
  std::transform(points.begin(), points.end(), distances.begin(),
                 [&](const glm::dvec3& x) { return glm::distance(x, middle); });
  return median(std::move(distances));
}

CloudSuspects cloud_suspects(const Scene& scene, const CloudGround& ground,
                             const std::vector<CloudPoint>& all, const Alignment& alignment,
                             const CloudScale& scale) {
  std::vector<CloudPoint> points;
  for (const std::size_t i : evenly_spread(all.size(), looked_at)) points.push_back(all[i]);
  const Judge judge(ground, alignment, scale);
  const double error = judge(points, false);
  const auto size_of = [](const std::optional<Device>& d) { return d ? d->intrinsics.size : glm::ivec2(0); };
  const auto undos =
      cloud_undoings(scene, size_of(ground.camera), size_of(ground.projector), !alignment.world);
  const std::vector<Told> told = told_undoings(undos, points, judge, error);
  CloudSuspects result;
  if (told.empty() || !(error > 0)) return result;
  result.better_frame = told.front().undo->frame;
  for (const Told& t : told) {
    // What another frame or another step would need as well is another story.
    if (t.undo->frame != result.better_frame || t.steps() > told.front().steps()) continue;
    for (const std::string& name : t.undo->suspects) {
      if (std::any_of(result.suspects.begin(), result.suspects.end(),
                      [&](const auto& s) { return s.name == name; }))
        continue;
      result.suspects.push_back({name, std::isfinite(error) ? 1 - t.remaining / error : 1, advice(name)});
    }
  }
  return result;
}

}  // namespace laterna
