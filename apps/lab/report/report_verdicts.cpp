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
  return {{"of", "speed against accuracy: " + chart.at("chart").get<std::string>()},
          {"status", ""},
          {"reason", ""},
          {"facts", facts}};
}

Json plan_verdict(const Json& plan, const std::string& name) {
  Json facts = Json::array();
  add_fact(facts, "effects kept", plan.at("kept").size(), "");
  add_fact(facts, "effects dropped", plan.at("dropped").size(), "");
  add_fact(facts, "changes the answer, on fresh seeds at full cost", plan.at("change_px"), "px rms");
  add_fact(facts, "give or take", plan.value("doubt_px", Json()), "px rms");
  add_fact(facts, "allowed", plan.at("tolerance_px"), "px rms");
  add_fact(facts, "full", plan.value("seconds_full", Json()), "s");
  add_fact(facts, "planned", plan.value("seconds_plan", Json()), "s");
  const std::string weak = plan.value("full_is_weak", "");
  return {{"of", "plan: " + name},
          {"status", weak.empty() ? "ok" : "weak"},
          {"reason", weak.empty() ? "" : "the full scene's own answer: " + weak},
          {"facts", facts}};
}

Json selfcal_verdict(const Json& selfcal, const std::string& name) {
  Json facts = Json::array();
  add_fact(facts, "numbers that the pixels give", member(selfcal, "count", "given"), "");
  add_fact(facts, "numbers asked for", member(selfcal, "count", "needed"), "");
  add_fact(facts, "devices", selfcal.at("devices").size(), "");
  add_fact(facts, "stations", selfcal.at("stations").size(), "");
  add_fact(facts, "fit", selfcal.value("fit_rms_px", Json()), "px rms");
  return {{"of", "self-calibration: " + name},
          {"status", selfcal.at("status")},
          {"reason", selfcal.at("reason")},
          {"facts", facts}};
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
  const Json none = Json::array();
  for (std::size_t k = 0; k < data.value("selfcals", none).size(); ++k)
    verdicts.push_back(selfcal_verdict(data["selfcals"][k], data["selfcal_names"][k]));
  for (std::size_t k = 0; k < data.value("plans", none).size(); ++k)
    verdicts.push_back(plan_verdict(data["plans"][k], data["plan_names"][k]));
  for (const Json& chart : data.value("charts", none)) verdicts.push_back(chart_verdict(chart));
  if (data.contains("atlas")) verdicts.push_back(atlas_verdict(data["atlas"]["summary"]));
  for (const Json& atlas : data.value("atlas_references", none))
    verdicts.push_back(atlas_verdict(atlas.at("summary")));
  return verdicts;
}

}  // namespace laterna
