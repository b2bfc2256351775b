#include "apps/lab/report/selfcal_figures.h"

#include "apps/lab/json_number.h"
#include "apps/lab/report/svg_chart.h"

#include <fmt/format.h>

namespace laterna {

using Json = nlohmann::json;
using Kind = SvgSeries::Kind;

void add_selfcal_figure(const Json& selfcal, const std::string& name, std::vector<StaticFigure>& figures) {
  SvgChart chart{name + ": residuals by station, beside what noise predicts", "px rms", "", false, false, {}};
  SvgSeries fit{Kind::points, "residuals of the fit", "#0072B2", {}},
      predicted{Kind::points, "predicted error by noise", "#E69F00", {}, 2};
  for (const Json& station : selfcal.at("stations")) {
    const double row = double(chart.rows.size());
    chart.rows.push_back(fmt::format("{} {}", station.at("device").get<std::string>(),
                                     station.at("station").get<std::string>()));
    fit.points.push_back({number_or_nan(station, "fit_rms_px"), row});
    predicted.points.push_back({number_or_nan(station, "predicted_px"), row});
  }
  if (chart.rows.empty()) return;
  chart.series = {fit, predicted};
  figures.push_back({"selfcal_" + name, chart.title, svg_chart(chart), ""});
}

}  // namespace laterna
