#include "apps/lab/report/selfcal_figures.h"

#include "apps/lab/json_number.h"
#include "apps/lab/report/svg_chart.h"
#include "apps/lab/report/svg_rig.h"

#include <fmt/format.h>

#include <array>

namespace laterna {

using Json = nlohmann::json;
using Kind = SvgSeries::Kind;

namespace {

constexpr std::array<const char*, 5> colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9"};

// Every station in the first one's frame, its device's colour.
StaticFigure selfcal_rig(const Json& selfcal, const std::string& name) {
  Json rig{{"cameras", Json::array()}, {"projectors", Json::array()}, {"meshes", Json::array()}};
  const Json& devices = selfcal.at("devices");
  for (const Json& station : selfcal.at("stations"))
    for (std::size_t d = 0; d < devices.size(); ++d)
      if (devices[d].at("name") == station.at("device")) {
        Json placed = devices[d];
        placed["name"] = fmt::format("{} {}", station.at("device").get<std::string>(),
                                     station.at("station").get<std::string>());
        placed["device_from_world"] = station.at("device_from_first"), placed["colour"] = colours[d % 5];
        rig["cameras"].push_back(std::move(placed));
      }
  Json points = Json::array();
  for (const Json& point : selfcal.at("points")) points.insert(points.end(), point.begin(), point.end());
  return {"selfcal_rig_" + name, name + ": the rig from correspondences alone, and points (orange)",
          rig_svg(rig, points), ""};
}

}  // namespace

void add_selfcal_figures(const Json& selfcal, const std::string& name, std::vector<StaticFigure>& figures) {
  if (!selfcal.value("points", Json::array()).empty()) figures.push_back(selfcal_rig(selfcal, name));
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
