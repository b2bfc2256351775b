#include "apps/lab/plan/answer.h"

#include <fmt/format.h>

#include <limits>

namespace laterna {

namespace {

using Pixels = std::vector<glm::dvec2>;

Change infinite(const std::string& reason) {
  Change change;
  change.change_px = change.mean_px = change.rms_px = std::numeric_limits<double>::infinity();
  change.reason = reason;
  return change;
}

// Where each seed's estimate maps the points: by point, then by seed.
std::vector<Pixels> mapped(const std::vector<glm::dvec3>& points, const std::vector<RoundTrip>& trips,
                           std::size_t p) {
  std::vector<Pixels> pixels(points.size());
  for (const RoundTrip& trip : trips) {
    const WorldProjection projection(trip.answers[p].estimate);
    for (std::size_t i = 0; i < points.size(); ++i) pixels[i].emplace_back(projection.project(points[i]));
  }
  return pixels;
}

// Sums over points and seeds.
struct Moments {
  double mean2 = 0, variance = 0;  // |mean over seeds|², and the variance over seeds, both coordinates
  void add(const Pixels& seeds) {
    const double n = double(seeds.size());
    glm::dvec2 mean(0);
    for (const glm::dvec2& s : seeds) mean += s / n;
    mean2 += glm::dot(mean, mean);
    for (const glm::dvec2& s : seeds) variance += glm::dot(s - mean, s - mean) / (n - 1);
  }
};

Change change_of(const std::vector<Pixels>& full, const std::vector<Pixels>& other) {
  Moments a, b, d;
  const double points = double(full.size()), n = double(full.front().size());
  Pixels difference(full.front().size());
  for (std::size_t i = 0; i < full.size(); ++i) {
    for (std::size_t k = 0; k < difference.size(); ++k) difference[k] = other[i][k] - full[i][k];
    a.add(full[i]), b.add(other[i]), d.add(difference);
  }
  Change change;
  change.mean_px = std::sqrt(d.mean2 / points);
  change.spread_full_px = std::sqrt(a.variance / points), change.spread_px = std::sqrt(b.variance / points);
  change.change_px = std::hypot(change.mean_px, change.spread_px - change.spread_full_px);
  change.doubt_px = 2 * std::sqrt(d.variance / points / n);
  change.rms_px = std::sqrt((d.mean2 + d.variance * (n - 1) / n) / points);
  return std::isfinite(change.rms_px) ? change : infinite("its estimate cannot map the volume");
}

}  // namespace

Change change_between(const std::vector<std::vector<glm::dvec3>>& volumes, const std::vector<RoundTrip>& full,
                      const std::vector<RoundTrip>& other) {
  Change most;
  for (std::size_t p = 0; p < volumes.size(); ++p) {
    for (std::size_t k = 0; k < full.size(); ++k) {
      const Answer& answer = other[k].answers.at(p);
      if (full[k].answers.at(p).status == Status::refused) return infinite("the full model is refused");
      if (answer.status > full[k].answers[p].status)
        return infinite(
            fmt::format("{}: {}", answer.status == Status::weak ? "weak" : "refused", answer.reason));
    }
    const Change change = change_of(mapped(volumes[p], full, p), mapped(volumes[p], other, p));
    if (p == 0 || !(change.change_px + change.doubt_px <= most.change_px + most.doubt_px)) most = change;
  }
  return most;
}

Verdict verdict_on(const Change& change, double tolerance_px) {
  if (change.change_px + change.doubt_px <= tolerance_px) return Verdict::small;
  return change.change_px - change.doubt_px > tolerance_px ? Verdict::large : Verdict::unsure;
}

}  // namespace laterna
