#include "apps/lab/report/plan_figures.h"

#include "apps/lab/json_number.h"
#include "apps/lab/report/svg_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace laterna {

using Json = nlohmann::json;
using Kind = SvgSeries::Kind;

namespace {

// In Okabe and Ito's colours, which the colour-blind tell apart.
std::array<SvgSeries, 3> series_by_verdict() {
  return {SvgSeries{Kind::points, "small", "#0072B2", {}, 0},
          SvgSeries{Kind::points, "unsure", "#E69F00", {}, 1},
          SvgSeries{Kind::points, "large", "#D55E00", {}, 2}};
}

}  // namespace

void add_plan_figure(const Json& plan, const std::string& name, std::vector<StaticFigure>& figures) {
  const double tolerance = plan.at("tolerance_px");
  SvgChart chart{fmt::format("{}: what each changes alone, {:.4g} px allowed", name, tolerance),
                 "change of the answer, px rms",
                 "",
                 true,
                 false,
                 {}};
  std::array<SvgSeries, 3> verdicts = series_by_verdict();
  for (const Json& choice : plan.at("choices"))
    for (const Json& tried : choice.at("tried")) {
      const double change = number_or_nan(tried, "change_px"), row = double(chart.rows.size());
      chart.rows.push_back(
          fmt::format("{}: {}", choice.at("name").get<std::string>(), tried.at("value").get<std::string>()));
      for (SvgSeries& series : verdicts)
        if (tried.at("verdict") == series.name && std::isfinite(change))
          series.points.push_back(
              {std::max(change, tolerance / 1000), row, fmt::format("{:.4g} px", change)});
    }
  if (chart.rows.empty()) return;
  chart.series.push_back({Kind::dashes,
                          "tolerance",
                          "#767676",
                          {{tolerance, -0.5}, {tolerance, double(chart.rows.size()) - 0.5}}});
  for (SvgSeries& series : verdicts)
    if (!series.points.empty()) chart.series.push_back(std::move(series));
  figures.push_back({"plan_" + name, chart.title, svg_chart(chart), ""});
}

}  // namespace laterna
