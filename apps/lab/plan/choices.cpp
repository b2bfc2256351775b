#include "apps/lab/plan/choices.h"

#include "apps/lab/plan/fixed_exposure.h"
#include "sim/error.h"
#include "sim/scene_build.h"
#include "sim/scene_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace laterna {

namespace {

constexpr int least_side_px = 160;  // fewer pixels than that are no camera's picture of a scene

bool has_lens(const Device& device) { return !is_pinhole(device.lens); }

// Whether an effect that is on has anything to act on.
bool is_there(const Scene& scene, const EffectSwitch& effect) {
  const std::string_view name = effect.name;
  const auto& p = scene.projectors;
  const auto& c = scene.cameras;
  if (name == "projector_lens")
    return std::any_of(p.begin(), p.end(), [](const Projector& x) { return has_lens(x.device); });
  if (name == "camera_lens")
    return std::any_of(c.begin(), c.end(), [](const Camera& x) { return has_lens(x.device); });
  if (name == "light_planes")
    return std::any_of(p.begin(), p.end(), [](const Projector& x) {
      return x.device.planes.near_m.has_value() || x.device.planes.far_m.has_value();
    });
  return true;
}

Choice effect_choice(const EffectSwitch& effect) {
  return {effect.name, true,
          "on",        {{"off", [on = effect.on](SceneSpec& spec) { spec.effects.*on = false; }}},
          true,        [on = effect.on](const SceneSpec& spec) { return spec.effects.*on; }};
}

bool spreads_samples(const SceneSpec& spec) {
  return spec.effects.antialiasing || spec.effects.camera_defocus || spec.effects.diffraction;
}
bool reflects(const SceneSpec& spec) { return spec.effects.inter_reflection; }
// Whether a camera pixel gathers from more than one place of a projector's picture.
bool has_long_rows(const SceneSpec& spec) {
  return spreads_samples(spec) || reflects(spec) || spec.effects.projector_defocus ||
         spec.effects.fill_factor;
}

// A number that is divided by `divisor` and rounded up, again and again, down to `least`.
Choice number_choice(const char* name, int full, int divisor, int least,
                     const std::function<void(SceneSpec&, int)>& set, bool (*is_needed)(const SceneSpec&)) {
  Choice choice{name, false, std::to_string(full), {}, true, is_needed};
  for (int n = full; n > least;) {
    n = std::max(least, (n + divisor - 1) / divisor);
    choice.levels.push_back({std::to_string(n), [set, n](SceneSpec& spec) { set(spec, n); }});
  }
  return choice;
}

Choice samples_choice(const SceneSpec& spec) {
  int most = 1;
  for (const CameraSpec& camera : spec.cameras) most = std::max(most, camera.samples_per_pixel);
  const auto set = [](SceneSpec& s, int n) {
    for (CameraSpec& camera : s.cameras) camera.samples_per_pixel = std::min(camera.samples_per_pixel, n);
  };
  return number_choice("samples_per_pixel", most, 4, 2, set, spreads_samples);
}

Choice resolution_choice(const SceneSpec& spec, const Scene& scene, const std::filesystem::path& folder) {
  const auto text = [&](int halvings) {
    std::string sizes;
    for (const CameraSpec& c : with_cameras_halved(spec, halvings, folder).cameras)
      sizes += fmt::format("{}{}x{}", sizes.empty() ? "" : ", ", c.device.size->x, c.device.size->y);
    return sizes;
  };
  Choice choice{"resolution", false, "", {}, true, [](const SceneSpec&) { return true; }};
  for (int n = 1; longest_side_px(scene) >> n >= least_side_px; ++n)
    choice.levels.push_back(
        {text(n), [n, folder](SceneSpec& s) { s = with_cameras_halved(std::move(s), n, folder); }});
  if (choice.levels.empty()) return choice;
  for (const Camera& c : scene.cameras)
    choice.full += fmt::format("{}{}x{}", choice.full.empty() ? "" : ", ", c.device.intrinsics.size.x,
                               c.device.intrinsics.size.y);
  return choice;
}

std::string kind_text(const PatternParameters& p) {
  const std::string kind = names_of(p.kind)[std::size_t(p.kind)];
  const bool is_code = p.kind == PatternKind::gray || p.kind == PatternKind::xor_gray;
  return kind + (is_code ? "" : fmt::format(", {} steps", p.steps)) +
         (p.repeat_first ? ", first repeated" : "");
}

// How many pictures all projectors show; none where one of them cannot show the patterns.
int pictures_of(const Scene& scene, const PatternParameters& parameters) {
  int count = 0;
  try {
    for (const Projector& p : scene.projectors) {
      validate({parameters, p.device.intrinsics.size});
      count += picture_count({parameters, p.device.intrinsics.size});
    }
  } catch (const InputError&) {
    return 0;
  }
  return count;
}

Choice patterns_choice(const Scene& scene) {
  const PatternParameters& own = scene.patterns;
  Choice choice{"patterns", false, kind_text(own), {}, false, [](const SceneSpec&) { return true; }};
  int least = pictures_of(scene, own);
  if (!is_coded(own.kind)) return choice;
  const auto add = [&](PatternParameters p) {
    p.repeat_first = false;
    const int pictures = pictures_of(scene, p);
    if (pictures == 0 || pictures >= least) return;
    least = pictures;
    choice.levels.push_back({kind_text(p), [p](SceneSpec& spec) { spec.patterns.parameters = p; }});
  };
  add(own);
  const auto with = [&](PatternKind kind, int steps) {
    PatternParameters p = own;
    p.kind = kind, p.steps = steps;
    return p;
  };
  if (own.kind == PatternKind::gray || own.kind == PatternKind::xor_gray) {
    for (const int steps : {4, 3}) add(with(PatternKind::gray_phase, steps));
    for (const int steps : {4, 3}) add(with(PatternKind::micro_phase, steps));
  } else {
    for (const int steps : {16, 8, 6, 5, 4, 3})
      if (steps < own.steps) add(with(own.kind, steps));
  }
  return choice;
}

Choice exposure_choice(const Scene& scene, const std::filesystem::path& folder) {
  Choice choice{"exposure", false, "automatic", {}, true, has_long_rows};
  if (exposure_takes_rays(scene)) choice.levels.push_back({"fixed", fixed_exposure(folder)});
  return choice;
}

struct LensModel {
  const char* name;
  std::size_t parameters;
};
constexpr std::array<LensModel, 4> opencv_models{{{"LENSMODEL_OPENCV12", 12},
                                                  {"LENSMODEL_OPENCV8", 8},
                                                  {"LENSMODEL_OPENCV5", 5},
                                                  {"LENSMODEL_OPENCV4", 4}}};

void cut_lens(Lens& lens, const LensModel& model) {
  const bool is_opencv = std::string_view(lens.model).starts_with("LENSMODEL_OPENCV");
  if (!is_opencv || lens.parameters.size() <= model.parameters) return;
  lens = {model.name, {lens.parameters.begin(), lens.parameters.begin() + std::ptrdiff_t(model.parameters)}};
}

template <class Devices>
Choice lens_choice(const char* name, const SceneSpec& spec, Devices SceneSpec::*devices, bool Effects::*on) {
  Choice choice{name, false, "", {}, true, [on](const SceneSpec& s) { return s.effects.*on; }};
  std::size_t most = 0;
  for (const auto& d : spec.*devices)
    if (d.device.lens.model.starts_with("LENSMODEL_OPENCV"))
      most = std::max(most, d.device.lens.parameters.size());
  choice.full = std::to_string(most);
  for (const LensModel& model : opencv_models)
    if (model.parameters < most)
      choice.levels.push_back({std::to_string(model.parameters), [devices, model](SceneSpec& s) {
                                 for (auto& d : s.*devices) cut_lens(d.device.lens, model);
                               }});
  return choice;
}

bool is_sound(const SceneSpec& spec) {
  try {
    check(spec);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

std::vector<Choice> choices_of(const SceneSpec& spec, const Scene& scene,
                               const std::filesystem::path& folder) {
  std::vector<Choice> choices;
  for (const EffectSwitch& effect : all_effects)
    if (spec.effects.*effect.on && is_there(scene, effect)) choices.push_back(effect_choice(effect));
  const auto [bounces, paths] = spec.inter_reflection;
  std::vector<Choice> settings{
      samples_choice(spec),
      number_choice(
          "paths", paths, 4, 1, [](SceneSpec& s, int n) { s.inter_reflection.paths = n; }, reflects),
      number_choice(
          "bounces", bounces, 2, 1, [](SceneSpec& s, int n) { s.inter_reflection.bounces = n; }, reflects),
      resolution_choice(spec, scene, folder),
      patterns_choice(scene),
      lens_choice("projector_lens_terms", spec, &SceneSpec::projectors, &Effects::projector_lens),
      lens_choice("camera_lens_terms", spec, &SceneSpec::cameras, &Effects::camera_lens),
      exposure_choice(scene, folder)};
  for (Choice& choice : settings)
    if (!choice.levels.empty() && choice.is_needed(spec)) choices.push_back(std::move(choice));
  return choices;
}

SceneSpec at_levels(SceneSpec spec, const std::vector<Choice>& choices, const Levels& levels) {
  for (std::size_t k = 0; k < choices.size(); ++k) {
    if (levels[k] == 0) continue;
    choices[k].levels[std::size_t(levels[k]) - 1].edit(spec);
    if (spec.effects.fill_factor && !is_sound(spec)) spec.effects.fill_factor = false;
  }
  return spec;
}

std::string levels_text(const std::vector<Choice>& choices, const Levels& levels) {
  std::string text;
  for (std::size_t k = 0; k < choices.size(); ++k)
    if (levels[k] > 0)
      text += fmt::format("{}{}={}", text.empty() ? "" : " ", choices[k].name,
                          choices[k].levels[std::size_t(levels[k]) - 1].value);
  return text.empty() ? "full" : text;
}

}  // namespace laterna
