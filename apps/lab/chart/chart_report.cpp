#include "apps/lab/chart/chart_report.h"

#include "apps/lab/json_number.h"
#include "apps/lab/shell_word.h"
#include "sim/error.h"
#include "sim/parallel.h"
#include "sim/plain_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

using Json = nlohmann::json;

double spread_px(const ChartPoint& p) { return p.error_px.high - p.error_px.low; }

std::string command_of(const ChartPoint& p, const std::string& specification, std::uint64_t seed) {
  const std::string words = seed == 1 ? "" : fmt::format(" --seed {}", seed);
  return fmt::format("laterna chart {} --point {}{} -o {}", shell_word(specification), shell_word(p.label),
                     words, folder_name(p.label, "point"));
}

Json labels_of(const Chart& chart, const std::vector<std::size_t>& indices) {
  Json labels = Json::array();
  for (const std::size_t k : indices) labels.push_back(chart.points[k].label);
  return labels;
}

// What does not depend on the machine.
Json results_of(const ChartPoint& p) {
  return {{"label", p.label},
          {"series", p.series},
          {"kind", p.kind},
          {"method", p.method},
          {"values", p.values},
          {"seeds", p.seeds},
          {"ok", p.ok},
          {"weak", p.weak},
          {"refused", p.refused},
          {"crashed", p.crashed},
          {"error_px", finite_or_null(p.error_px.middle)},
          {"error_low_px", finite_or_null(p.error_px.low)},
          {"error_high_px", finite_or_null(p.error_px.high)},
          {"error_mm", finite_or_null(p.error_mm)},
          {"bound_px", finite_or_null(p.bound_px)},
          {"bound", p.bound},
          {"pictures", p.pictures},
          {"capture_seconds", finite_or_null(p.capture_seconds)}};
}

void read_seconds(const Json& json, const std::string& against, ChartPoint& p) {
  const bool ratios = json.contains("seconds_ratio");
  p.seconds = number_or_nan(json, ratios ? "seconds_ratio" : "seconds");
  p.seconds_low = ratios ? p.seconds : number_or_nan(json, "seconds_low");
  p.seconds_high = ratios ? p.seconds : number_or_nan(json, "seconds_high");
  p.x = against == "seconds"           ? p.seconds
        : against == "capture_seconds" ? p.capture_seconds
                                       : number_or_nan(p.values, against.c_str());
}

ChartPoint point_of(const Json& json, const std::string& against) {
  ChartPoint p;
  p.label = json.at("label"), p.series = json.at("series");
  p.kind = json.at("kind"), p.method = json.at("method"), p.values = json.at("values");
  p.seeds = json.at("seeds"), p.ok = json.at("ok"), p.weak = json.at("weak");
  p.refused = json.at("refused"), p.crashed = json.at("crashed");
  p.error_px = {number_or_nan(json, "error_low_px"), number_or_nan(json, "error_px"),
                number_or_nan(json, "error_high_px")};
  p.error_mm = number_or_nan(json, "error_mm"), p.bound_px = number_or_nan(json, "bound_px");
  p.bound = json.at("bound"), p.pictures = json.at("pictures");
  p.capture_seconds = number_or_nan(json, "capture_seconds");
  p.peak_mib = number_or_nan(json, "peak_mib");
  read_seconds(json, against, p);
  return p;
}

}  // namespace

Json chart_summary(const Chart& chart, const std::string& specification, std::uint64_t seed) {
  Json points = Json::array();
  for (const ChartPoint& p : chart.points)
    points.push_back({{"label", p.label},
                      {"error_px", finite_or_null(p.error_px.middle)},
                      {"bound_px", finite_or_null(p.bound_px)},
                      {"seconds", finite_or_null(p.seconds)},
                      {"spread_px", finite_or_null(spread_px(p))},
                      {"command", command_of(p, specification, seed)}});
  return {{"points", points}, {"pareto", labels_of(chart, pareto_front(chart.points))}};
}

Json chart_json(const Chart& chart, const std::string& specification, std::uint64_t seed) {
  Json json = chart_summary(chart, specification, seed);
  json.update({{"chart", chart.name}, {"against", chart.against}, {"threads", thread_count()}});
  for (std::size_t k = 0; k < chart.points.size(); ++k) {
    const ChartPoint& p = chart.points[k];
    json["points"][k].update(results_of(p));
    json["points"][k].update({{"reason", p.reason},
                              {"seconds_low", finite_or_null(p.seconds_low)},
                              {"seconds_high", finite_or_null(p.seconds_high)},
                              {"stages", Json::object()},
                              {"peak_mib", finite_or_null(p.peak_mib)},
                              {"x", finite_or_null(p.x)}});
    for (const auto& [name, seconds] : p.stages) json["points"][k]["stages"][name] = seconds;
  }
  return json;
}

Json chart_reference(const Chart& chart) {
  double fastest = INFINITY;
  for (const ChartPoint& p : chart.points)
    if (p.seconds > 0) fastest = std::min(fastest, p.seconds);
  Json points = Json::array();
  for (const ChartPoint& p : chart.points) {
    points.push_back(results_of(p));
    points.back()["seconds_ratio"] = finite_or_null(std::round(100 * p.seconds / fastest) / 100);
  }
  return {{"chart", chart.name},
          {"against", chart.against},
          {"points", points},
          {"pareto", labels_of(chart, pareto_front(chart.points))}};
}

Chart read_chart(const Json& json) {
  Chart chart;
  chart.name = json.at("chart"), chart.against = json.at("against");
  for (const Json& point : json.at("points")) {
    chart.points.push_back(point_of(point, chart.against));
    chart.ratios |= point.contains("seconds_ratio");
  }
  chart.done = chart.all = chart.points.size();
  return chart;
}

Chart read_chart_reference(const std::string& text, const std::string& place) {
  try {
    return read_chart(Json::parse(text));
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: no reference of a chart: {}", place, plain_json_message(error.what())));
  }
}

std::string chart_csv(const Chart& chart) {
  const auto cell = [](double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; };
  const auto text_cell = [](const std::string& text) {
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
  };
  std::string csv =
      "label,series,method,seeds,ok,weak,refused,crashed,error_px,error_low_px,error_high_px,error_mm,"
      "bound_px,seconds,seconds_low,seconds_high,peak_mib,pictures,capture_seconds\n";
  for (const ChartPoint& p : chart.points)
    csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", text_cell(p.label),
                       text_cell(p.series), p.method, p.seeds, p.ok, p.weak, p.refused, p.crashed,
                       cell(p.error_px.middle), cell(p.error_px.low), cell(p.error_px.high), cell(p.error_mm),
                       cell(p.bound_px), cell(p.seconds), cell(p.seconds_low), cell(p.seconds_high),
                       cell(p.peak_mib), p.pictures, cell(p.capture_seconds));
  return csv;
}

namespace {

std::string digits(double value, int significant) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, significant) : "-";
}

}  // namespace

std::string chart_text(const Chart& chart) {
  const std::vector<std::size_t> front = pareto_front(chart.points);
  std::string text = fmt::format("  {:>10} {:>10} {:>10} {:>10} {:>10} {:>9}  {}\n", "error px", "quartiles",
                                 "bound px", "seconds", "run to run", "peak MiB", "point");
  std::string failures;
  for (std::size_t k = 0; k < chart.points.size(); ++k) {
    const ChartPoint& p = chart.points[k];
    const bool best = std::find(front.begin(), front.end(), k) != front.end();
    text += fmt::format("{} {:>10} {:>10} {:>10} {:>10} {:>10} {:>9}  {}\n", best ? '*' : ' ',
                        digits(p.error_px.middle, 4), digits(spread_px(p), 3), digits(p.bound_px, 4),
                        digits(p.seconds, 3), digits(p.seconds_high - p.seconds_low, 2),
                        digits(p.peak_mib, 4), p.label);
    if (p.refused + p.crashed > 0)
      failures += fmt::format("{}: {} of {} seeds refused, {} crashed: {}\n", p.label, p.refused, p.seeds,
                              p.crashed, p.reason);
  }
  return text + fmt::format("* nothing has less error for as little of {}\n", chart.against) + failures;
}

}  // namespace laterna
