#include "apps/bench/scaling.h"

#include "apps/bench/timing.h"
#include "render/replay.h"
#include "render/trace_rows.h"
#include "sim/pattern.h"
#include "sim/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace laterna {

namespace {

constexpr const char* axes[] = {"patterns", "samples", "bounces", "paths"};

std::vector<ScalingPoint> plan() {
  std::vector<ScalingPoint> points;
  for (const int patterns : {11, 22, 44, 66, 88}) points.push_back({.axis = axes[0], .patterns = patterns});
  for (const int samples : {1, 2, 4, 8, 16}) points.push_back({.axis = axes[1], .samples = samples});
  for (const int bounces : {1, 2, 3, 4, 6})
    points.push_back({.axis = axes[2], .bounces = bounces, .paths = 4});
  for (const int paths : {1, 2, 4, 8, 16}) points.push_back({.axis = axes[3], .bounces = 1, .paths = paths});
  return points;
}

PatternStack first_patterns(const GraySequence& sequence, int count) {
  const PatternStack all = make_pattern_stack(sequence);
  PatternStack some{all.width, all.height, count, {}};
  some.values.reserve(std::size_t(all.width) * all.height * count);
  for (std::size_t p = 0; p < std::size_t(all.width) * all.height; ++p)
    for (int k = 0; k < count; ++k) some.values.push_back(all.values[p * all.count + k % all.count]);
  return some;
}

void time_point(ScalingPoint& point, Scene scene, const RayScene& rays, int repeats) {
  scene.effects.inter_reflection = point.bounces > 0;
  scene.inter_reflection = {point.bounces, point.paths};
  const CameraRays directions(scene.cameras[0].device);
  const PixelSamples samples{point.samples, 1};
  const PatternStack patterns = first_patterns({scene.projectors[0].device.intrinsics.size}, point.patterns);
  std::atomic<std::uint64_t> entries = 0;
  const RowSource traced = trace_rows(rays, scene, 0, directions, 0, samples);
  const ImageRows image{scene.cameras[0].device.intrinsics.size,
                        [&](LightRows& rows) { traced(rows), entries += rows.entries.size(); },
                        region_px_of(scene, samples)};
  std::vector<double> times;
  for (int i = -1; i < repeats; ++i) {  // the first round warms up
    const double s = seconds([&] {
      const CapturedStack pictures =
          play_stack(image, Lookup::bilinear, patterns, make_exposure({}, 1000, {}));
    });
    if (i >= 0) times.push_back(s);
  }
  point.seconds = median(times);
  point.entries_per_pixel = double(entries) / (repeats + 1) / (double(image.size.x) * image.size.y);
}

std::vector<ScalingPoint> series_of(const std::vector<ScalingPoint>& points, const char* axis) {
  std::vector<ScalingPoint> series;
  std::copy_if(points.begin(), points.end(), std::back_inserter(series),
               [&](const ScalingPoint& p) { return p.axis == axis; });
  return series;
}

// In a frame of 220 × 150 whose lower left corner stands at (x, 190).
std::string plot(const std::vector<ScalingPoint>& series, int x) {
  const StraightLine line = straight_line(series);
  const double most = series.back().value(), at_most = line.seconds_at_0 + line.seconds_per_step * most;
  const double top = 1.1 * std::max(series.back().seconds, at_most);
  const auto right = [&](double value) { return x + 200 * value / most; };
  const auto down = [&](double s) { return 190 - 150 * s / top; };
  std::string svg = fmt::format(
      "<path d=\"M{0} 40V190H{1}\" fill=\"none\" stroke=\"black\"/>\n"
      "<text x=\"{0}\" y=\"30\">{2:.3g} s</text><text x=\"{3}\" y=\"206\">{4} {5}</text>\n"
      "<text x=\"{0}\" y=\"222\">{6:.3g} s + {7:.3g} s each, within {8:.1f} %</text>\n"
      "<path d=\"M{0} {9:.1f}L{10:.1f} {11:.1f}\" stroke=\"#36c\"/>\n",
      x, x + 220, top, x + 150, most, series[0].axis, line.seconds_at_0, line.seconds_per_step,
      100 * line.largest_misfit, down(line.seconds_at_0), right(most), down(at_most));
  for (const ScalingPoint& p : series)
    svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\"/>\n", right(p.value()), down(p.seconds));
  return svg;
}

}  // namespace

int ScalingPoint::value() const {
  return axis == axes[0] ? patterns : axis == axes[1] ? samples : axis == axes[2] ? bounces : paths;
}

std::vector<ScalingPoint> time_scaling(Scene scene, int repeats) {
  Object& walls = scene.objects.emplace_back();
  walls.name = "walls", walls.mesh = box({8, 8, 8}, true);
  const RayScene rays(scene);
  std::vector<ScalingPoint> points = plan();
  for (ScalingPoint& point : points) time_point(point, scene, rays, repeats);
  return points;
}

StraightLine straight_line(const std::vector<ScalingPoint>& series) {
  const auto n = double(series.size());
  double x = 0, y = 0, xx = 0, xy = 0;
  for (const ScalingPoint& p : series) {
    x += p.value() / n, y += p.seconds / n;
    xx += double(p.value()) * p.value() / n, xy += p.value() * p.seconds / n;
  }
  const double slope = (xy - x * y) / (xx - x * x);
  StraightLine line{y - slope * x, slope};
  for (const ScalingPoint& p : series) {
    const double misfit = std::abs(p.seconds / (line.seconds_at_0 + slope * p.value()) - 1);
    line.largest_misfit = std::max(line.largest_misfit, misfit);
  }
  return line;
}

std::string scaling_csv(const std::vector<ScalingPoint>& points) {
  std::string csv = "axis,patterns,samples,bounces,paths,entries_per_pixel,seconds\n";
  for (const ScalingPoint& p : points)
    csv += fmt::format("{},{},{},{},{},{:.4g},{:.4g}\n", p.axis, p.patterns, p.samples, p.bounces, p.paths,
                       p.entries_per_pixel, p.seconds);
  return csv;
}

std::string scaling_svg(const std::vector<ScalingPoint>& points) {
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"1080\" height=\"235\" font-family=\"sans-serif\" "
      "font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  int x = 20;
  for (const char* axis : axes) svg += plot(series_of(points, axis), x), x += 265;
  return svg + "</svg>\n";
}

}  // namespace laterna
