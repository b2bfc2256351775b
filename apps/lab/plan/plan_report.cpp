#include "apps/lab/plan/plan_report.h"

#include "apps/lab/json_number.h"
#include "sim/scene_file.h"
#include "sim/self_contained.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace laterna {

namespace {

using Json = nlohmann::json;

const char* word_of(Verdict verdict) {
  return verdict == Verdict::small ? "small" : verdict == Verdict::large ? "large" : "unsure";
}

Json tried_json(const LevelTried& tried) {
  return {{"value", tried.value},
          {"change_px", finite_or_null(tried.change.change_px)},
          {"doubt_px", finite_or_null(tried.change.doubt_px)},
          {"seeds", tried.seeds},
          {"seconds_saved", finite_or_null(tried.seconds_saved)},
          {"verdict", word_of(tried.verdict)},
          {"reason", tried.change.reason}};
}

Json choice_json(const ChoiceMade& choice) {
  Json tried = Json::array();
  for (const LevelTried& t : choice.tried) tried.push_back(tried_json(t));
  return {{"name", choice.name}, {"effect", choice.is_effect}, {"full", choice.full},
          {"plan", choice.plan}, {"end", choice.end},          {"tried", tried}};
}

std::vector<std::string> effects_of(const Plan& plan, bool dropped) {
  std::vector<std::string> names;
  for (const ChoiceMade& choice : plan.choices)
    if (choice.is_effect && (choice.end == "dropped") == dropped) names.push_back(choice.name);
  return names;
}

std::string digits(double value, int significant) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, significant) : "-";
}

std::string end_text(const ChoiceMade& choice) {
  return choice.end == "cheaper" ? "now " + choice.plan : choice.end;
}

std::string row(const ChoiceMade& choice, const LevelTried& tried) {
  const std::string to = fmt::format("{} -> {}", choice.full, tried.value);
  const bool is_last = &tried == &choice.tried.back();
  return fmt::format("{:<21} {:<48} {:>9} {:>8} {:>8}  {:<7} {}\n", choice.name, to,
                     digits(tried.change.change_px, 3), digits(tried.change.doubt_px, 2),
                     std::isfinite(tried.seconds_saved) ? fmt::format("{:.3f}", tried.seconds_saved) : "-",
                     word_of(tried.verdict), is_last ? end_text(choice) : "") +
         (tried.change.reason.empty() ? "" : fmt::format("{:<22}{}\n", "", tried.change.reason));
}

std::string list(const std::vector<std::string>& names) {
  return names.empty() ? "nothing" : fmt::format("{}", fmt::join(names, ", "));
}

std::string settings_text(const Plan& plan) {
  std::vector<std::string> lines;
  for (const ChoiceMade& choice : plan.choices)
    if (!choice.is_effect && choice.end == "cheaper")
      lines.push_back(fmt::format("{} {} -> {}", choice.name, choice.full, choice.plan));
  return list(lines);
}

}  // namespace

Json plan_json(const Plan& plan, const std::string& scene_file) {
  Json json = plan_reference(plan);
  json["scene"] = scene_file;
  json["seconds_full"] = finite_or_null(plan.seconds_full);
  json["seconds_plan"] = finite_or_null(plan.seconds_plan);
  json["choices"] = Json::array();
  for (const ChoiceMade& choice : plan.choices) json["choices"].push_back(choice_json(choice));
  return json;
}

Json plan_reference(const Plan& plan) {
  Json settings = Json::object(), choices = Json::array();
  for (const ChoiceMade& choice : plan.choices) {
    if (!choice.is_effect)
      settings[choice.name] = {{"full", choice.full}, {"plan", choice.plan}, {"end", choice.end}};
    choices.push_back(choice_json(choice));
    for (Json& tried : choices.back()["tried"]) tried.erase("seconds_saved");
  }
  return {{"kept", effects_of(plan, false)},
          {"dropped", effects_of(plan, true)},
          {"change_px", finite_or_null(plan.confirmed.change_px)},
          {"doubt_px", finite_or_null(plan.confirmed.doubt_px)},
          {"rms_px", finite_or_null(plan.confirmed.rms_px)},
          {"noise_px", finite_or_null(plan.noise_px)},
          {"tolerance_px", plan.tolerance_px},
          {"seeds", plan.confirmed_seeds},
          {"full_is_weak", plan.weak},
          {"low_cost_halvings", plan.halvings},
          {"settings", settings},
          {"choices", choices}};
}

std::string plan_text(const Plan& plan) {
  std::string text;
  if (!plan.weak.empty()) text += fmt::format("the full scene's own answer is weak: {}\n", plan.weak);
  text += fmt::format("{:<21} {:<48} {:>9} {:>8} {:>8}  {:<7} {}\n", "alone, at low cost", "", "change px",
                      "+-", "saves s", "alone", "in the plan");
  for (const ChoiceMade& choice : plan.choices)
    for (const LevelTried& tried : choice.tried) text += row(choice, tried);
  text += fmt::format("kept:    {}\ndropped: {}\ncheaper: {}\n", list(effects_of(plan, false)),
                      list(effects_of(plan, true)), settings_text(plan));
  text += fmt::format(
      "together: {} px +- {} of {} px allowed, seed by seed {} px rms, on {} fresh seeds at full cost\n",
      digits(plan.confirmed.change_px, 3), digits(plan.confirmed.doubt_px, 2), plan.tolerance_px,
      digits(plan.confirmed.rms_px, 3), plan.confirmed_seeds);
  if (plan.noise_px > plan.tolerance_px)
    text += fmt::format(
        "noise: the full scene's answer scatters by {} px, more than the tolerance: single answers differ by "
        "more than it, their means do not\n",
        digits(plan.noise_px, 3));
  return text + fmt::format("seconds: {:.3f} full, {:.3f} planned\n", plan.seconds_full, plan.seconds_plan);
}

std::string planned_scene_toml(const Plan& plan, const std::filesystem::path& scene_file,
                               const std::filesystem::path& target) {
  const auto folder_of = [](const std::filesystem::path& file) {
    return std::filesystem::absolute(file).parent_path();
  };
  return fmt::format(
             "# As much of {} as its calibration answer needs, to {} px.\n# Dropped: {}.\n# Cheaper: {}.\n",
             scene_file.filename().string(), plan.tolerance_px, list(effects_of(plan, true)),
             settings_text(plan)) +
         scene_toml(seen_from(plan.scene, folder_of(scene_file), folder_of(target)));
}

}  // namespace laterna
