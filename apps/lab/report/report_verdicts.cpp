#include "apps/lab/report/report_verdicts.h"

#include <fmt/format.h>

namespace laterna {

using Json = nlohmann::json;

namespace {

void add_fact(Json& facts, const char* name, const Json& value, const char* unit) {
  if (!value.is_null()) facts.push_back({{"name", name}, {"value", value}, {"unit", unit}});
}

Json member(const Json& json, const char* outer, const char* inner) {
  const auto found = json.find(outer);
  return found == json.end() || !found->is_object() ? Json() : found->value(inner, Json());
}

Json projector_verdict(const Json& p) {
  Json facts = Json::array();
  add_fact(facts, "error over the volume", member(p, "volume_error_px", "rms"), "px rms");
  add_fact(facts, "noise predicts", member(p, "volume_error_px", "predicted_rms"), "px rms");
  add_fact(facts, "error on the surface", member(p, "surface_error_px", "rms"), "px rms");
  add_fact(facts, "beyond the volume", member(p, "extrapolation_error_px", "rms"), "px rms");
  add_fact(facts, "fit", p.value("fit_rms_px", Json()), "px rms");
  add_fact(facts, "correspondences", p.value("correspondences", Json()), "");
  return {{"of", fmt::format("projector \"{}\"", p.at("name").get<std::string>())},
          {"status", p.at("status")},
          {"reason", p.at("reason")},
          {"facts", facts}};
}

Json board_verdict(const Json& b) {
  Json facts = Json::array();
  add_fact(facts, "poses left out, predicted", member(b, "held_out_px", "rms"), "px rms");
  add_fact(facts, "error over the volume, by noise alone", member(b, "predicted_volume_px", "independent"),
           "px rms");
  add_fact(facts, "error over the volume, by leaving poses out",
           member(b, "predicted_volume_px", "jackknife"), "px rms");
  add_fact(facts, "the same in the camera's own frame", member(b, "predicted_volume_px", "camera_frame"),
           "px rms");
  if (b.contains("poses")) add_fact(facts, "poses", b["poses"].size(), "");
  return {{"of", "calibration from boards"},
          {"status", b.at("status")},
          {"reason", b.at("reason")},
          {"facts", facts}};
}

Json chart_verdict(const Json& chart) {
  Json facts = Json::array();
  add_fact(facts, "points", chart.at("points").size(), "");
  add_fact(facts, "on the Pareto front", chart.at("pareto").size(), "");
  for (const Json& p : chart["points"])  // the front ends with the least error
    if (!chart["pareto"].empty() && p.at("label") == chart["pareto"].back())
      add_fact(facts, "least error", p.at("error_px"), "px rms");
  return {{"of", "speed against accuracy"}, {"status", ""}, {"reason", ""}, {"facts", facts}};
}

Json atlas_verdict(const Json& summary) {
  Json facts = Json::array();
  add_fact(facts, "conditions", summary.at("conditions"), "");
  add_fact(facts, "seeds each, at least", summary.at("seeds"), "");
  const Json own = summary.at("methods").value("laterna", Json());
  bool failed = false;
  if (own.is_object()) {
    failed = own.at("silent").get<int>() + own.at("crashed").get<int>() > 0;
    for (const char* word : {"right", "weak", "refused", "silent", "crashed"})
      add_fact(facts, word, own.at(word), "");
  }
  const char* reason = failed            ? "Laterna's own method is silently wrong or crashes somewhere"
                       : own.is_object() ? ""
                                         : "Laterna's own method was not run";
  return {{"of", "atlas, method laterna"},
          {"status", failed            ? "failed"
                     : own.is_object() ? "ok"
                                       : ""},
          {"reason", reason},
          {"facts", facts}};
}

}  // namespace

Json verdicts_of(const Json& data) {
  Json verdicts = Json::array();
  if (data.contains("result"))
    for (const Json& p : data["result"].at("projectors")) verdicts.push_back(projector_verdict(p));
  if (data.contains("estimate"))
    for (const Json& p : data["estimate"].at("projectors")) verdicts.push_back(projector_verdict(p));
  if (data.contains("board")) verdicts.push_back(board_verdict(data["board"]));
  if (data.contains("chart")) verdicts.push_back(chart_verdict(data["chart"]));
  if (data.contains("atlas")) verdicts.push_back(atlas_verdict(data["atlas"]["summary"]));
  return verdicts;
}

}  // namespace laterna
