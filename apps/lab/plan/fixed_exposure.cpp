#include "apps/lab/plan/fixed_exposure.h"

#include "apps/lab/simulation.h"
#include "render/trace_rows.h"
#include "sim/error.h"
#include "sim/scene_build.h"
#include "sim/scene_file.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace laterna {

namespace {

bool is_automatic(const Camera& camera) { return !fixed_saturation_cd_per_m2(camera.sensor); }

using Saturations = std::vector<std::optional<double>>;  // by camera; none: it does not expose automatically

// None where exposing takes no rays, nor for a scene that cannot be built: whoever runs it is told.
Saturations automatic_saturations(const SceneSpec& spec, const std::filesystem::path& folder) try {
  const Scene scene = build_scene(spec, folder);
  if (!exposure_takes_rays(scene)) return {};
  StageTimes times;
  const SceneRays rig = make_rig(scene, times);
  Saturations all(scene.cameras.size());
  for (std::size_t c = 0; c < all.size(); ++c)
    for (std::size_t p = 0; p < scene.projectors.size() && is_automatic(scene.cameras[c]); ++p)
      all[c] = std::max(all[c].value_or(0), saturation_cd_per_m2(scene, rig, int(c), int(p), times));
  return all;
} catch (const InputError&) {
  return {};
}

}  // namespace

bool exposure_takes_rays(const Scene& scene) {
  for (std::size_t c = 0; c < scene.cameras.size(); ++c)
    if (is_automatic(scene.cameras[c]) && !rows_are_direct(scene, int(c))) return true;
  return false;
}

std::function<void(SceneSpec&)> fixed_exposure(const std::filesystem::path& folder) {
  const auto known = std::make_shared<std::map<std::string, Saturations>>();
  return [known, folder](SceneSpec& spec) {
    const auto [found, is_new] = known->try_emplace(scene_toml(spec));
    if (is_new) found->second = automatic_saturations(spec, folder);
    for (std::size_t c = 0; c < found->second.size(); ++c)
      if (found->second[c]) spec.cameras[c].sensor.saturation_cd_per_m2 = found->second[c];
  };
}

}  // namespace laterna
