#include "apps/lab/report/static_figures.h"

#include "apps/lab/report/svg_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace laterna {

using Json = nlohmann::json;

namespace {

// Okabe and Ito's colours, which the colour-blind tell apart.
constexpr const char *blue = "#0072B2", *vermilion = "#D55E00", *sky = "#56B4E9", *green = "#009E73",
                     *orange = "#E69F00", *purple = "#CC79A7";

double value(const Json& json) { return json.is_number() ? json.get<double>() : NAN; }

std::string text(const Json& json) { return json.get<std::string>(); }

StaticFigure residual_histogram(const Json& r) {
  const Json &edges = r["histogram"]["edges_px"], &count = r["histogram"]["count"],
             &predicted = r["histogram"]["predicted"];
  ChartSeries bars{ChartSeries::Kind::bars, "measured", sky, {}},
      line{ChartSeries::Kind::line, "stated sigma", vermilion, {}};
  for (std::size_t b = 0; b < count.size(); ++b) {
    const double middle = (value(edges[b]) + value(edges[b + 1])) / 2;
    bars.points.push_back({middle, value(count[b])});
    line.points.push_back({middle, value(predicted[b])});
  }
  const std::string of = fmt::format("\"{}\" seen by \"{}\"", text(r["projector"]), text(r["camera"]));
  return {fmt::format("residuals_{}_{}", text(r["camera"]), text(r["projector"])),
          fmt::format("Residuals of {}, {:.4g} px rms", of, value(r["rms_px"])),
          svg_chart({"Residuals of " + of, "du and dv, px", "count", false, false, {bars, line}})};
}

StaticFigure error_by_range(const Json& p) {
  ChartSeries error{ChartSeries::Kind::points, "error against the truth", blue, {}},
      predicted{ChartSeries::Kind::line, "noise predicts", orange, {}};
  for (const Json& row : p["by_range"]) {
    error.points.push_back({value(row["depth_m"]), value(row["error_rms_px"])});
    predicted.points.push_back({value(row["depth_m"]), value(row["predicted_rms_px"])});
  }
  const std::string of = fmt::format("Error of \"{}\" by range", text(p["projector"]));
  return {"range_" + text(p["projector"]), of,
          svg_chart({of, "depth, m", "px rms over the image", true, true, {predicted, error}})};
}

StaticFigure lens_ladder(const Json& board) {
  ChartSeries all{ChartSeries::Kind::points, "tried", sky, {}},
      chosen{ChartSeries::Kind::points, "chosen", vermilion, {}};
  double rung = 0;
  for (const Json& r : board["ladder"]) {
    const Json& lenses = r["lenses"];
    const std::string label = lenses.empty() ? "" : text(lenses[lenses.size() - 1]);
    (r["chosen"].get<bool>() ? chosen : all)
        .points.push_back({++rung, value(r["held_out_px"]["rms"]), label});
  }
  return {"lens_ladder", "Held-out error by lens, labelled by the projector's terms",
          svg_chart({"Lens ladder", "rung", "held out, px rms", false, false, {all, chosen}})};
}

StaticFigure speed_against_accuracy(const Json& chart) {
  ChartSeries all{ChartSeries::Kind::points, "measured", blue, {}},
      bound{ChartSeries::Kind::points, "bound", orange, {}},
      front{ChartSeries::Kind::line, "Pareto front", vermilion, {}};
  for (const Json& p : chart["points"]) {
    all.points.push_back({value(p["seconds"]), value(p["error_px"]), text(p["label"])});
    bound.points.push_back({value(p["seconds"]), value(p["bound_px"])});
    const Json& pareto = chart["pareto"];
    if (std::find(pareto.begin(), pareto.end(), p["label"]) != pareto.end())
      front.points.push_back({value(p["seconds"]), value(p["error_px"])});
  }
  std::sort(front.points.begin(), front.points.end(),
            [](const ChartPoint& a, const ChartPoint& b) { return a.x < b.x; });
  return {"pareto", "Speed against accuracy",
          svg_chart({"Speed against accuracy", "seconds", "error, px rms", true, true, {front, bound, all}})};
}

// Shares of the outcomes, method by method, as stacked bars made of bars one over the other.
StaticFigure outcomes_by_method(const Json& summary) {
  const std::array<std::pair<const char*, const char*>, 5> words{
      {{"right", green}, {"weak", orange}, {"refused", sky}, {"silent", vermilion}, {"crashed", purple}}};
  Chart chart{"Outcomes by method", "", "share of problems", false, false, {}};
  for (const auto& [word, colour] : words)
    chart.series.push_back({ChartSeries::Kind::bars, word, colour, {}});
  double at = 0;
  for (const auto& [method, counts] : summary["methods"].items()) {
    double all = 0, sum = 0;
    for (const auto& [word, colour] : words) all += value(counts[word]);
    chart.x_label += fmt::format("{}{}: {}", at > 0 ? ",  " : "", at, method);
    for (std::size_t k = 0; k < words.size(); ++k) {
      sum += value(counts[words[k].first]);
      chart.series[k].points.push_back({at, all > 0 ? sum / all : NAN});
    }
    ++at;
  }
  std::reverse(chart.series.begin(), chart.series.end());  // the tallest first, so that each stays in sight
  return {"outcomes", "Outcomes by method", svg_chart(chart)};
}

}  // namespace

std::vector<StaticFigure> static_figures(const Json& data) {
  std::vector<StaticFigure> figures;
  if (data.contains("figures")) {
    for (const Json& r : data["figures"]["residuals"])
      if (!r.is_null()) figures.push_back(residual_histogram(r));
    for (const Json& p : data["figures"]["projections"])
      if (!p.is_null()) figures.push_back(error_by_range(p));
  }
  if (data.contains("board") && !data["board"]["ladder"].empty())
    figures.push_back(lens_ladder(data["board"]));
  if (data.contains("chart")) figures.push_back(speed_against_accuracy(data["chart"]));
  if (data.contains("atlas")) figures.push_back(outcomes_by_method(data["atlas"]["summary"]));
  return figures;
}

}  // namespace laterna
