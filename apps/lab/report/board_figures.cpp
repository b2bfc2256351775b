#include "apps/lab/report/board_figures.h"

#include "apps/lab/json_number.h"
#include "apps/lab/report/svg_chart.h"
#include "apps/lab/report/svg_rig.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

namespace laterna {

using Json = nlohmann::json;
using Kind = SvgSeries::Kind;

namespace {

constexpr std::array<const char*, 4> colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7"};

std::string rung_name(const Json& rung, std::size_t k) {
  return fmt::format("{}. {}{}", k + 1, fmt::join(rung["lenses"].get<std::vector<std::string>>(), " / "),
                     rung["board_bend"].get<bool>() ? " + bend" : "");
}

StaticFigure lens_ladder(const Json& ladder) {
  SvgChart chart{"Lens ladder: error of poses that were left out", "px rms", "", false, false, {}};
  SvgSeries tried{Kind::points, "tried", colours[0], {}}, climbed{Kind::points, "climbed", colours[1], {}, 2},
      fits{Kind::points, "fit of each device", "#767676", {}, 3};
  for (std::size_t k = 0; k < ladder.size(); ++k) {
    const Json& rung = ladder[k];
    chart.rows.push_back(rung_name(rung, k));
    const double y = double(k), rms = number_or_nan(rung["held_out_px"], "rms");
    for (const Json& fit : rung["fit_rms_px"])
      fits.points.push_back({fit.is_number() ? fit.get<double>() : 0, y});
    (rung["chosen"].get<bool>() ? climbed : tried).points.push_back({rms, y, fmt::format("{:.4g} px", rms)});
  }
  chart.series = {fits, tried, climbed};
  return {"lens_ladder", chart.title, svg_chart(chart), ""};
}

StaticFigure uncertainty_by_range(const Json& board) {
  SvgChart chart{"Uncertainty by range, by noise alone (dashes: worst pixel)",
                 "range, in the board's unit",
                 "standard deviation, px",
                 true,
                 false,
                 {}};
  for (const char* kind : {"cameras", "projectors"})
    for (const Json& device : board[kind]) {
      const char* colour = colours[chart.series.size() / 3 % colours.size()];
      SvgSeries whole{Kind::line, device["name"].get<std::string>(), colour, {}},
          worst{Kind::dashes, "", colour, {}};
      for (const Json& row : device["prediction_sigma_px"]) {
        whole.points.push_back({number_or_nan(row, "range"), number_or_nan(row, "rms")});
        worst.points.push_back({number_or_nan(row, "range"), number_or_nan(row, "worst")});
      }
      const SvgSeries ranges{Kind::points, "", colour, whole.points, int(chart.series.size() / 3)};
      chart.series.insert(chart.series.end(), {whole, worst, ranges});
    }
  return {"uncertainty_by_range", chart.title, svg_chart(chart), ""};
}

StaticFigure left_out_poses(const Json& board) {
  SvgChart chart{
      "Each pose left out in turn: error of its projector pixels", "px rms", "pose", false, false, {}};
  SvgSeries poses{Kind::points, "", colours[0], {}};
  const Json& folds = board["held_out_px"]["folds"];
  for (std::size_t k = 0; k < board["poses"].size(); ++k) {
    const Json& label = board["poses"][k]["pose"];
    chart.rows.push_back(label.is_string() ? label.get<std::string>() : label.dump());
    if (k < folds.size() && folds[k].is_number()) poses.points.push_back({folds[k].get<double>(), double(k)});
  }
  chart.series = {poses};
  return {"left_out_poses", chart.title, svg_chart(chart), ""};
}

// In the camera's frame, with each board's distance on its axis.
StaticFigure board_rig(const Json& board) {
  Json rig{{"cameras", board["cameras"]}, {"projectors", board["projectors"]}, {"meshes", Json::array()}};
  for (Json& camera : rig["cameras"])
    camera["device_from_world"] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  for (Json& projector : rig["projectors"]) projector["device_from_world"] = projector["device_from_camera"];
  Json points = Json::array();
  for (const Json& pose : board["poses"])
    if (pose["distance"].is_number()) points.insert(points.end(), {0, 0, pose["distance"]});
  return {"board_rig",
          "The rig from boards: projectors (vermilion), camera (blue), distances of the boards (orange)",
          rig_svg(rig, points), ""};
}

}  // namespace

void add_board_figures(const Json& board, std::vector<StaticFigure>& figures) {
  if (!board["ladder"].empty()) figures.push_back(lens_ladder(board["ladder"]));
  if (!board["cameras"].empty() && !board.value("poses", Json::array()).empty())
    figures.push_back(board_rig(board));
  if (!board["cameras"].empty() && !board["projectors"].empty())
    figures.push_back(uncertainty_by_range(board));
  if (board["held_out_px"].is_object() && !board["held_out_px"]["folds"].empty())
    figures.push_back(left_out_poses(board));
}

}  // namespace laterna
