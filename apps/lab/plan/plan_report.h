// What a plan says, for machines and for people.
#pragma once

#include "apps/lab/plan/plan.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>

namespace laterna {

/// {"kept": [EFFECT], "dropped": [EFFECT], "change_px", "seconds_full", "seconds_plan", "scene": FILE}, and
/// beside them "settings": {NAME: {"full", "plan", "end"}} of samples, resolution, patterns and lens terms;
/// "tolerance_px", "doubt_px", "rms_px", "noise_px", "seeds", "full_is_weak", "low_cost_halvings"; and
/// "choices": [{"name", "effect", "full", "plan", "end", "tried": [{"value", "change_px", "doubt_px",
/// "seeds", "seconds_saved", "verdict", "reason"}]}], changes alone at low cost. Effects are named by their
/// switches, in the order of sim/effects.h. A number that is not finite is null.
nlohmann::json plan_json(const Plan& plan, const std::string& scene_file);

/// What holds on every machine: the same without seconds and files.
nlohmann::json plan_reference(const Plan& plan);

/// A table: each choice, what it would change and save alone, and what became of it.
std::string plan_text(const Plan& plan);

/// The reduced scene as a file for `target`: TOML, complete, its relative file names found from target's
/// folder, with what was dropped in a comment. `scene_file` is the full scene's.
std::string planned_scene_toml(const Plan& plan, const std::filesystem::path& scene_file,
                               const std::filesystem::path& target);

}  // namespace laterna
