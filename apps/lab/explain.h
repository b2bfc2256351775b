// What each effect costs and changes: the scene captured with the effect toggled, beside the scene as it is.
#pragma once

#include "apps/lab/simulation.h"
#include "sim/scene_spec.h"

#include <string>
#include <vector>

namespace laterna {

/// One effect. The changes are between the scene as it is and the same with this switch turned, over all
/// views together, at the exposure and the noise of the scene as it is. NaN where they cannot be compared: a
/// slide has other pictures than the code, and a map is empty where nothing decodes.
struct EffectCost {
  std::string name, stage;
  bool on = false;               ///< in the scene
  double entries_per_pixel = 0;  ///< of the rows, over all camera pixels, with the effect on
  double seconds =
      0;  ///< of tracing and capture, more with it than without, both measured in turn: the median
          ///< of three rounds (one where a capture takes over a second); 0 where it is within noise
  double max_dn = 0, rms_dn = 0;        ///< over all pixels of all pictures
  double max_uv_px = 0, rms_uv_px = 0;  ///< |Δ(u, v)| of the decoded map, where both decode
};

/// One entry per switch of all_effects, in its order. A switch that is off and whose parameters the scene
/// does not give changes nothing. `scene` is built from `spec` in `folder`.
std::vector<EffectCost> explain_effects(const SceneSpec& spec, const Scene& scene,
                                        const std::filesystem::path& folder, std::uint64_t seed,
                                        const Progress& progress = {});

/// A table for people.
std::string explain_text(const std::vector<EffectCost>& costs);

/// {"effects":[{"name","stage","on","entries_per_pixel","seconds","max_dn","rms_dn","max_uv_px","rms_uv_px"}]},
/// null for NaN.
std::string explain_json(const std::vector<EffectCost>& costs);

}  // namespace laterna
