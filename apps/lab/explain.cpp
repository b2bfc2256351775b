#include "apps/lab/explain.h"

#include "calib/decode.h"
#include "render/effects/apply_effects.h"
#include "sim/effect_checks.h"
#include "sim/error.h"
#include "sim/scene_build.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string_view>

namespace laterna {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Captured {
  std::vector<CapturedStack> stacks;  // one per view
  std::vector<DecodedMap> maps;
  std::vector<double> saturations;
  std::vector<int> projectors;
  double entries_per_pixel = 0, seconds = 0;
};

// Traces and captures every view once, at the given exposures or, where there are none, at those that suit
// the scene.
Captured capture_once(const Scene& scene, std::uint64_t seed, const std::vector<double>& saturations) {
  StageTimes times;
  Captured captured;
  Traced traced = trace(scene, times);
  std::atomic<std::uint64_t> entries{0};
  double pixels = 0;
  for (std::size_t i = 0; i < traced.views.size(); ++i) {
    View& view = traced.views[i];
    if (!saturations.empty()) view.saturation_cd_per_m2 = saturations[i];
    captured.saturations.push_back(view.saturation_cd_per_m2);
    captured.projectors.push_back(view.projector);
    const ImageRows rows = view_rows(scene, traced, view, seed);
    captured.stacks.push_back(capture_rows(scene, view.camera, view.projector, rows,
                                           view.saturation_cd_per_m2, seed, times, &entries));
    pixels += double(rows.size.x) * rows.size.y;
  }
  captured.entries_per_pixel = pixels > 0 ? double(entries) / pixels : 0;
  captured.seconds = times.total();
  return captured;
}

// The same, decoded.
Captured capture_all(const Scene& scene, std::uint64_t seed, const std::vector<double>& saturations) {
  Captured captured = capture_once(scene, seed, saturations);
  for (std::size_t i = 0; i < captured.stacks.size() && !comes_from_files(scene.patterns.kind); ++i) {
    const Projector& projector = scene.projectors[captured.projectors[i]];
    captured.maps.push_back(decode(captured.stacks[i], pattern_sequence(scene, projector)));
  }
  return captured;
}

// How much longer `with` takes than `without`: both in turn, so that a machine that others use is as slow for
// the one as for the other; the median of three rounds, of one where captures are long.
double seconds_more(const Scene& with, const Scene& without, std::uint64_t seed,
                    const std::vector<double>& saturations) {
  constexpr double long_capture_s = 1;
  std::vector<double> more;
  while (more.size() < 3) {
    const double base = capture_once(without, seed, saturations).seconds;
    more.push_back(capture_once(with, seed, saturations).seconds - base);
    if (base > long_capture_s) return std::max(0.0, more.back());
  }
  std::sort(more.begin(), more.end());
  return std::max(0.0, more[1]);
}

struct Spread {
  double largest = 0, sum2 = 0, count = 0;
  void add(double d) { largest = std::max(largest, d), sum2 += d * d, ++count; }
  double max() const { return count > 0 ? largest : nan; }
  double rms() const { return count > 0 ? std::sqrt(sum2 / count) : nan; }
};

void compare_pictures(const CapturedStack& a, const CapturedStack& b, Spread& spread) {
  std::visit(
      [&](const auto& pictures) {
        const auto& others = std::get<std::decay_t<decltype(pictures)>>(b);
        if (pictures.values.size() != others.values.size()) return;
        for (std::size_t i = 0; i < pictures.values.size(); ++i)
          spread.add(std::abs(int(pictures.values[i]) - int(others.values[i])));
      },
      a);
}

void compare_maps(const DecodedMap& a, const DecodedMap& b, Spread& spread) {
  for (std::size_t i = 0; i < a.valid.values.size(); ++i) {
    if (!a.valid.values[i] || !b.valid.values[i]) continue;
    spread.add(std::hypot(a.u_px.values[i] - b.u_px.values[i], a.v_px.values[i] - b.v_px.values[i]));
  }
}

void compare(const Captured& as_is, const Captured& toggled, EffectCost& cost) {
  Spread dn, uv;
  for (std::size_t i = 0; i < as_is.stacks.size(); ++i)
    compare_pictures(as_is.stacks[i], toggled.stacks[i], dn);
  for (std::size_t i = 0; i < std::min(as_is.maps.size(), toggled.maps.size()); ++i)
    compare_maps(as_is.maps[i], toggled.maps[i], uv);
  cost.max_dn = dn.max(), cost.rms_dn = dn.rms();
  cost.max_uv_px = uv.max(), cost.rms_uv_px = uv.rms();
  cost.entries_per_pixel = (cost.on ? as_is : toggled).entries_per_pixel;
}

bool has_parameters(const SceneSpec& given, const EffectSwitch& effect) {
  SceneSpec spec = given;
  spec.effects.*effect.on = true;
  try {
    check_effects(spec);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

// A lens that is off is gone from the scene: it comes from the specification.
Scene with_toggled(const SceneSpec& spec, const Scene& scene, const std::filesystem::path& folder,
                   const EffectSwitch& effect) {
  Scene toggled = scene;
  toggled.effects.*effect.on = !(scene.effects.*effect.on);
  if (std::string_view(effect.stage) != "warp") return toggled;
  SceneSpec changed = spec;
  changed.effects = toggled.effects;
  return build_scene(changed, folder);
}

}  // namespace

std::vector<EffectCost> explain_effects(const SceneSpec& spec, const Scene& scene,
                                        const std::filesystem::path& folder, std::uint64_t seed,
                                        const Progress& progress) {
  const Captured as_is = capture_all(scene, seed, {});
  std::vector<EffectCost> costs;
  for (const EffectSwitch& effect : all_effects) {
    EffectCost cost{.name = effect.name, .stage = effect.stage, .on = scene.effects.*effect.on};
    if (cost.on || has_parameters(spec, effect)) {
      if (progress) progress(fmt::format("capturing with {} switched {}", cost.name, cost.on ? "off" : "on"));
      const Scene toggled = with_toggled(spec, scene, folder, effect);
      compare(as_is, capture_all(toggled, seed, as_is.saturations), cost);
      cost.seconds = cost.on ? seconds_more(scene, toggled, seed, as_is.saturations)
                             : seconds_more(toggled, scene, seed, as_is.saturations);
    } else {
      cost.entries_per_pixel = as_is.entries_per_pixel;
    }
    costs.push_back(cost);
  }
  return costs;
}

std::string explain_text(const std::vector<EffectCost>& costs) {
  std::string text =
      fmt::format("{:<21} {:<8} {:<3} {:>13} {:>8} {:>8} {:>8} {:>10} {:>10}\n", "effect", "stage", "on",
                  "entries/pixel", "seconds", "max DN", "rms DN", "max uv px", "rms uv px");
  for (const EffectCost& c : costs) {
    text += fmt::format("{:<21} {:<8} {:<3} {:>13.3f} {:>8.3f} {:>8.0f} {:>8.2f} {:>10.2f} {:>10.3f}\n",
                        c.name, c.stage, c.on ? "yes" : "no", c.entries_per_pixel, c.seconds, c.max_dn,
                        c.rms_dn, c.max_uv_px, c.rms_uv_px);
  }
  return text;
}

std::string explain_json(const std::vector<EffectCost>& costs) {
  nlohmann::json effects = nlohmann::json::array();
  for (const EffectCost& c : costs) {
    effects.push_back({{"name", c.name},
                       {"stage", c.stage},
                       {"on", c.on},
                       {"entries_per_pixel", c.entries_per_pixel},
                       {"seconds", c.seconds},
                       {"max_dn", c.max_dn},
                       {"rms_dn", c.rms_dn},
                       {"max_uv_px", c.max_uv_px},
                       {"rms_uv_px", c.rms_uv_px}});
  }
  return nlohmann::json{{"effects", effects}}.dump();
}

}  // namespace laterna
