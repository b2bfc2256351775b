#include "apps/lab/report/static_figures.h"

#include "apps/lab/chart/chart_report.h"
#include "apps/lab/chart/chart_svg.h"
#include "apps/lab/report/board_figures.h"
#include "apps/lab/report/plan_figures.h"
#include "apps/lab/report/selfcal_figures.h"
#include "apps/lab/report/svg_atlas.h"
#include "apps/lab/report/svg_chart.h"
#include "apps/lab/report/svg_maps.h"
#include "apps/lab/report/svg_rig.h"
#include "apps/lab/report/thumbnails.h"
#include "sim/error.h"
#include "sim/plain_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace laterna {

using Json = nlohmann::json;

namespace {

// Okabe and Ito's colours, which the colour-blind tell apart.
constexpr const char *blue = "#0072B2", *vermilion = "#D55E00", *sky = "#56B4E9", *orange = "#E69F00";

double value(const Json& json) { return json.is_number() ? json.get<double>() : double(NAN); }

std::string text(const Json& json) { return json.get<std::string>(); }

std::string of_view(const Json& j) {
  return fmt::format("\"{}\" seen by \"{}\"", text(j["projector"]), text(j["camera"]));
}

// Letters and digits, anything else as one underline.
std::string plain(const std::string& words) {
  std::string name;
  for (const char c : words) {
    if (std::isalnum(static_cast<unsigned char>(c)))
      name += c;
    else if (!name.empty() && name.back() != '_')
      name += '_';
  }
  return name;
}

void add_pictures(const Json& view, std::vector<StaticFigure>& figures) {
  const std::string stem = fmt::format("{}_{}", text(view["camera"]), text(view["projector"]));
  for (const Json& frame : view["frames"])
    if (frame["label"] == "white")
      figures.push_back(
          {"frame_" + stem, of_view(view) + ": the white frame as captured", "", text(frame["image"])});
  for (const Json& map : view["maps"])
    figures.push_back(
        {fmt::format("map_{}_{}", text(map["label"]), stem),
         fmt::format("{}: {}, from {:.4g} (violet) to {:.4g} (yellow) {}; grey: none", of_view(view),
                     text(map["label"]), value(map["low"]), value(map["high"]), text(map["unit"])),
         "", text(map["image"])});
}

StaticFigure residual_histogram(const Json& r) {
  const Json &edges = r["histogram"]["edges_px"], &count = r["histogram"]["count"],
             &predicted = r["histogram"]["predicted"];
  SvgSeries bars{SvgSeries::Kind::bars, "measured", sky, {}},
      line{SvgSeries::Kind::line, "stated standard deviations predict", vermilion, {}};
  for (std::size_t b = 0; b < count.size(); ++b) {
    const double middle = (value(edges[b]) + value(edges[b + 1])) / 2;
    bars.points.push_back({middle, value(count[b])});
    line.points.push_back({middle, value(predicted[b])});
  }
  const std::string title = fmt::format("Residuals of {}, {:.4g} px rms", of_view(r), value(r["rms_px"]));
  return {fmt::format("residual_histogram_{}_{}", text(r["camera"]), text(r["projector"])),
          title + ", counted", svg_chart({title, "du and dv, px", "count", false, false, {bars, line}}), ""};
}

StaticFigure error_by_range(const Json& p) {
  SvgSeries error{SvgSeries::Kind::points, "error against the truth", blue, {}},
      predicted{SvgSeries::Kind::dashes, "noise predicts", orange, {}};
  for (const Json& row : p["by_range"]) {
    error.points.push_back({value(row["depth_m"]), value(row["error_rms_px"])});
    predicted.points.push_back({value(row["depth_m"]), value(row["predicted_rms_px"])});
  }
  const std::string title =
      fmt::format("Error of \"{}\" by range, lit from {:.4g} to {:.4g} m", text(p["projector"]),
                  value(p["lit_depths_m"][0]), value(p["lit_depths_m"][1]));
  return {"range_" + text(p["projector"]), title,
          svg_chart({title, "depth, m", "px rms over the image", true, true, {predicted, error}}), ""};
}

glm::ivec2 size_of(const Json& rig, const Json& projector) {
  for (const Json& p : rig["projectors"])
    if (p["name"] == projector) return {p["size"][0].get<int>(), p["size"][1].get<int>()};
  throw InputError("the figures' rig has no projector " + projector.dump());
}

void add_trial_figures(const Json& f, std::vector<StaticFigure>& figures) {
  figures.push_back({"rig", "The rig: projectors (vermilion), cameras (blue), lit points (orange)",
                     rig_svg(f["rig"], f["points"]), ""});
  for (const Json& r : f["residuals"]) {
    if (r.is_null()) continue;
    figures.push_back({fmt::format("residual_vectors_{}_{}", text(r["camera"]), text(r["projector"])),
                       fmt::format("Residual vectors of {}: colour is direction", of_view(r)),
                       residual_vectors_svg(r, size_of(f["rig"], r["projector"])), ""});
    figures.push_back(residual_histogram(r));
  }
  for (const Json& p : f["projections"]) {
    if (p.is_null()) continue;
    const glm::ivec2 size = size_of(f["rig"], p["projector"]);
    const std::string name = text(p["projector"]);
    figures.push_back({"difference_" + name,
                       fmt::format("Projection difference of \"{}\": recovered minus true", name),
                       projection_map_svg(p, size, GridQuantity::difference), ""});
    figures.push_back({"uncertainty_" + name, fmt::format("Uncertainty of \"{}\" by range", name),
                       projection_map_svg(p, size, GridQuantity::sigma), ""});
    figures.push_back(error_by_range(p));
  }
}

// What a page may hold any number of.
void add_several(const Json& data, std::vector<StaticFigure>& figures) {
  const Json none = Json::array();
  const Json selfcals = data.value("selfcals", none), plans = data.value("plans", none),
             charts = data.value("charts", none);
  for (std::size_t k = 0; k < selfcals.size(); ++k)
    add_selfcal_figures(selfcals[k], text(data["selfcal_names"][k]), figures);
  for (std::size_t k = 0; k < plans.size(); ++k)
    add_plan_figure(plans[k], text(data["plan_names"][k]), figures);
  for (const Json& chart : charts)
    figures.push_back({charts.size() == 1 ? "chart" : "chart_" + text(chart["chart"]),
                       "Speed against accuracy", chart_svg(read_chart(chart)), ""});
  for (const Json& atlas : data.value("atlas_references", none))
    figures.push_back({"atlas_" + text(atlas["name"]), "Outcomes as stored: " + text(atlas["name"]),
                       atlas_svg(atlas["cells"], "laterna"), ""});
}

}  // namespace

std::string StaticFigure::file_bytes() const { return svg.empty() ? bytes_of_data_uri(image) : svg; }

std::vector<StaticFigure> static_figures(const Json& data) try {
  std::vector<StaticFigure> figures;
  for (const Json& view : data.value("views", Json::array())) add_pictures(view, figures);
  if (data.contains("figures")) add_trial_figures(data["figures"], figures);
  if (data.contains("board")) add_board_figures(data["board"], figures);
  add_several(data, figures);
  if (data.contains("atlas"))
    for (const std::string& method : methods_of(data["atlas"]["cells"]))
      figures.push_back(
          {"atlas_" + method, "Outcomes of method " + method, atlas_svg(data["atlas"]["cells"], method), ""});
  for (StaticFigure& figure : figures) figure.name = plain(figure.name);
  return figures;
} catch (const Json::exception& error) {
  throw InputError("the figures' data are not as Laterna writes them: " + plain_json_message(error.what()));
}

}  // namespace laterna
