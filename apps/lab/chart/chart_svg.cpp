#include "apps/lab/chart/chart_svg.h"

#include "apps/lab/chart/log_axis.h"
#include "apps/lab/chart/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace laterna {

namespace {

constexpr double width = 1000, height = 600;
constexpr double left = 80, right = 680, top = 50, bottom = 530;  // of the axes
constexpr double text_px = 13;

const std::array<const char*, 6> colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"};

/// What is joined, and how it looks.
struct Series {
  std::string name;
  std::vector<const ChartPoint*> points;
  std::vector<std::string> swept;  ///< keys whose values differ among its points
  int index = 0;

  std::string colour() const { return colours[std::size_t(index) % colours.size()]; }
  int shape() const { return index % marker_shapes; }
};

std::vector<std::string> swept_keys(const std::vector<const ChartPoint*>& points) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : points.front()->values.items()) {
    const auto differs = [&, &k = key, &v = value](const ChartPoint* p) {
      const auto found = p->values.find(k);
      return found == p->values.end() || *found != v;
    };
    if (std::any_of(points.begin(), points.end(), differs)) keys.push_back(key);
  }
  return keys;
}

std::vector<Series> series_of(const Chart& chart) {
  std::vector<Series> all;
  for (const ChartPoint& p : chart.points) {
    auto found = std::find_if(all.begin(), all.end(), [&](const Series& s) { return s.name == p.series; });
    if (found == all.end()) found = all.insert(all.end(), Series{p.series, {}, {}, int(all.size())});
    found->points.push_back(&p);
  }
  for (Series& s : all) s.swept = swept_keys(s.points);
  return all;
}

bool drawn(const ChartPoint& p) {
  return std::isfinite(p.x) && p.x > 0 && std::isfinite(p.error_px.middle) && p.error_px.middle > 0;
}

/// Both axes, and the picture.
struct Plot {
  LogAxis x, y;
  Svg svg;
  std::pair<double, double> at(double u, double v) const { return {x.at(u), y.at(v)}; }
};

Plot plot_around(const Chart& chart) {
  std::vector<double> xs, ys;
  for (const ChartPoint& p : chart.points) {
    if (!drawn(p)) continue;
    xs.push_back(p.x);
    ys.insert(ys.end(), {p.error_px.low, p.error_px.middle, p.error_px.high, p.bound_px});
  }
  return {axis_around(xs, left, right), axis_around(ys, bottom, top),
          Svg(width, height, chart.name + ": error against " + chart.against)};
}

std::string x_title(const Chart& chart) {
  if (chart.against == "capture_seconds") return "seconds of capture";
  if (chart.against != "seconds") return chart.against;
  return chart.ratios ? "seconds over those of the fastest point" : "seconds";
}

void draw_axes(const Chart& chart, Plot& plot) {
  const Svg::Stroke faint{neutral_grey, 1, "", 0.25};
  for (const Tick& tick : ticks_of(plot.x)) {
    const double x = plot.x.at(tick.value);
    plot.svg.line({{x, top}, {x, bottom}}, faint);
    plot.svg.text(x, bottom + 18, tick.text, text_px, Svg::Anchor::middle);
  }
  for (const Tick& tick : ticks_of(plot.y)) {
    const double y = plot.y.at(tick.value);
    plot.svg.line({{left, y}, {right, y}}, faint);
    plot.svg.text(left - 8, y + 4.5, tick.text, text_px, Svg::Anchor::end);
  }
  plot.svg.line({{left, top}, {left, bottom}, {right, bottom}}, {});
  plot.svg.text((left + right) / 2, bottom + 44, x_title(chart), text_px + 1, Svg::Anchor::middle);
  plot.svg.text(22, (top + bottom) / 2, "error over the volume, rms, projector px", text_px + 1,
                Svg::Anchor::middle, true);
  plot.svg.text(left, 28, chart.name, 17);
}

void draw_front(const Chart& chart, Plot& plot) {
  std::vector<std::pair<double, double>> steps;
  for (const std::size_t k : pareto_front(chart.points)) {
    const ChartPoint& p = chart.points[k];
    if (!drawn(p)) continue;
    const auto [x, y] = plot.at(p.x, p.error_px.middle);
    if (!steps.empty()) steps.emplace_back(x, steps.back().second);
    steps.emplace_back(x, y);
    plot.svg.ring(x, y, 10, {neutral_grey, 2, "", 0.7});
  }
  if (!steps.empty()) steps.emplace_back(right, steps.back().second);
  plot.svg.line(steps, {neutral_grey, 6, "", 0.3});
}

void draw_lines(const Series& s, Plot& plot) {
  if (s.swept.size() > 1) return;
  std::vector<std::pair<double, double>> errors, bounds;
  for (const ChartPoint* p : s.points) {
    if (!drawn(*p)) continue;
    errors.push_back(plot.at(p->x, p->error_px.middle));
    if (p->bound_px > 0) bounds.push_back(plot.at(p->x, p->bound_px));
  }
  plot.svg.line(errors, {s.colour(), 1.5, "", 0.7});
  plot.svg.line(bounds, {s.colour(), 1.5, "5 4"});
}

// A lone bound, where no line can pass through it, is a short dash.
void draw_bars(const Series& s, const Chart& chart, Plot& plot) {
  const Svg::Stroke thin{s.colour(), 1.2};
  const long count =
      std::count_if(s.points.begin(), s.points.end(), [](const ChartPoint* p) { return drawn(*p); });
  for (const ChartPoint* p : s.points) {
    if (!drawn(*p)) continue;
    const auto [x, y] = plot.at(p->x, p->error_px.middle);
    if (p->error_px.low > 0 && std::isfinite(p->error_px.high)) {
      const double y0 = plot.y.at(p->error_px.low), y1 = plot.y.at(p->error_px.high);
      plot.svg.line({{x, y0}, {x, y1}}, thin);
      for (const double end : {y0, y1}) plot.svg.line({{x - 3.5, end}, {x + 3.5, end}}, thin);
    }
    if (chart.against == "seconds" && p->seconds_low > 0)
      plot.svg.line(
          {{std::max(left, plot.x.at(p->seconds_low)), y}, {std::min(right, plot.x.at(p->seconds_high)), y}},
          thin);
    if ((count == 1 || s.swept.size() > 1) && p->bound_px > 0) {
      const double b = plot.y.at(p->bound_px);
      plot.svg.line({{x - 9, b}, {x + 9, b}}, {s.colour(), 1.5, "5 4"});
    }
  }
}

// "steps 8, pitch_px 16": the swept values that x does not show.
std::string word_of(const ChartPoint& p, const Series& s, const std::string& against) {
  std::string word;
  for (const std::string& key : s.swept) {
    if (key == against) continue;
    const auto& value = p.values[key];
    word += fmt::format("{}{} {}", word.empty() ? "" : ", ", key.substr(key.rfind('.') + 1),
                        value.is_string() ? value.get<std::string>() : value.dump());
  }
  return word;
}

/// Places that are taken by words and markers.
class Taken {
 public:
  bool free(double x0, double y0, double x1, double y1) const {
    return x0 > left && x1 < right + 20 && y0 > top - 15 && y1 < bottom &&
           std::none_of(boxes_.begin(), boxes_.end(), [&](const std::array<double, 4>& b) {
             return x0 < b[2] && b[0] < x1 && y0 < b[3] && b[1] < y1;
           });
  }
  void take(double x0, double y0, double x1, double y1) { boxes_.push_back({x0, y0, x1, y1}); }

 private:
  std::vector<std::array<double, 4>> boxes_;
};

// Right of the marker, left, above or below; where none is free, the word is only the marker's hint.
void place_word(double x, double y, const std::string& word, Taken& taken, Svg& svg) {
  constexpr double size = 11, rise = 8;
  const double length = 0.56 * size * double(word.size());
  const std::array<std::pair<double, double>, 8> offsets{{{12, 4},
                                                          {-12 - length, 4},
                                                          {-length / 2, -14},
                                                          {-length / 2, 22},
                                                          {10, -10},
                                                          {10, 18},
                                                          {-10 - length, -10},
                                                          {-10 - length, 18}}};
  for (const auto& [dx, dy] : offsets) {
    if (!taken.free(x + dx, y + dy - rise, x + dx + length, y + dy + 2)) continue;
    taken.take(x + dx, y + dy - rise, x + dx + length, y + dy + 2);
    svg.text(x + dx, y + dy, word, size);
    return;
  }
}

void draw_markers(const std::vector<Series>& all, const Chart& chart, Plot& plot) {
  Taken taken;
  for (const Series& s : all)
    for (const ChartPoint* p : s.points) {
      if (!drawn(*p)) continue;
      const auto [x, y] = plot.at(p->x, p->error_px.middle);
      plot.svg.marker(x, y, s.shape(), s.colour(),
                      fmt::format("{}\n{:.4g} px, bound {:.4g} px, {:.3g} s{}", p->label, p->error_px.middle,
                                  p->bound_px, p->seconds, chart.ratios ? " over the fastest" : ""));
      taken.take(x - 7, y - 7, x + 7, y + 7);
    }
  for (const Series& s : all)
    for (const ChartPoint* p : s.points) {
      const std::string word = drawn(*p) ? word_of(*p, s, chart.against) : "";
      if (!word.empty()) place_word(plot.x.at(p->x), plot.y.at(p->error_px.middle), word, taken, plot.svg);
    }
}

void draw_legend(const std::vector<Series>& all, const Chart& chart, Plot& plot) {
  const double x = right + 30;
  double y = top + 10;
  for (const Series& s : all) {
    plot.svg.marker(x, y - 4, s.shape(), s.colour(), "");
    plot.svg.text(x + 14, y, s.name, text_px);
    y += 22;
  }
  const auto sample = [&](const std::string& words, const Svg::Stroke& stroke) {
    plot.svg.line({{x - 9, y - 4}, {x + 9, y - 4}}, stroke);
    plot.svg.text(x + 14, y, words, text_px);
    y += 22;
  };
  y += 14;
  const bool pictures = !chart.points.empty() && chart.points.front().kind == "pictures";
  sample(pictures ? "predicted for independent noise" : "Cramér-Rao bound", {neutral_grey, 1.5, "5 4"});
  sample("front: nothing has less of both", {neutral_grey, 6, "", 0.3});
  sample("bars: quartiles over the seeds", {neutral_grey, 1.2});
  const long missing =
      std::count_if(chart.points.begin(), chart.points.end(), [](const ChartPoint& p) { return !drawn(p); });
  if (missing > 0) plot.svg.text(x - 9, y, fmt::format("{} points gave no error to draw", missing), text_px);
}

}  // namespace

std::string chart_svg(const Chart& chart) {
  const std::vector<Series> all = series_of(chart);
  Plot plot = plot_around(chart);
  draw_axes(chart, plot);
  draw_front(chart, plot);
  for (const Series& s : all) draw_lines(s, plot);
  for (const Series& s : all) draw_bars(s, chart, plot);
  draw_markers(all, chart, plot);
  draw_legend(all, chart, plot);
  return plot.svg.str();
}

}  // namespace laterna
