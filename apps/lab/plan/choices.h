// What a scene has that can be left out or made cheaper, each with its levels.
#pragma once

#include "sim/scene.h"
#include "sim/scene_spec.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace laterna {

/// One way of making something cheaper.
struct Level {
  std::string value;  ///< for people: "off", "4", "320x200", "gray_phase, 3 steps"
  std::function<void(SceneSpec&)> edit;
};

/// Something that can be cheaper; its edits come after those of the choices before it. Its levels go from the
/// scene's own value downwards.
struct Choice {
  std::string name;  ///< of an effect: its switch (sim/effects.h); else of the setting
  bool is_effect = false;
  std::string full;           ///< its value in the scene
  std::vector<Level> levels;  ///< cheaper and cheaper
  bool is_ordered = true;     ///< whether a level that changes too much rules out all below it
  std::function<bool(const SceneSpec&)> is_needed;  ///< whether a scene looks at it at all
};

/// Which level of each choice a scene takes: 0 is the scene's own, k is levels[k - 1].
using Levels = std::vector<int>;

/// The choices of a scene, `scene` being build_scene(spec, folder):
///
///   every effect that is on                → off. Not counted are a lens where no device has one, and light
///                                            planes where no projector has them: nothing is there to drop.
///   samples_per_pixel                      → a quarter, a sixteenth, ... down to 2 (one ray per pixel is
///                                            `antialiasing` off)
///   paths, bounces of inter-reflection     → quarters, halves, ... down to 1
///   resolution of the cameras              → halves (with_cameras_halved()), longer side 160 pixels or more
///   patterns                               → no repeated first picture; fewer steps of the sinusoids; of
///                                            codes, gray_phase and micro_phase where they take fewer
///                                            pictures
///   projector_lens_terms, camera_lens_terms → LENSMODEL_OPENCV12 → 8 → 5 → 4, the highest orders cut off
///                                            (none at all is projector_lens, camera_lens off)
///   exposure                               → fixed, at what the scene as it then stands is exposed to
///                                            automatically (fixed_exposure.h): only where that takes rays
///                                            of its own
std::vector<Choice> choices_of(const SceneSpec& spec, const Scene& scene,
                               const std::filesystem::path& folder);

/// The scene at these levels. Where fill_factor is left without what it needs (a camera's needs
/// antialiasing), it goes too.
SceneSpec at_levels(SceneSpec spec, const std::vector<Choice>& choices, const Levels& levels);

/// "shadow=off paths=4"; "full" where all levels are 0.
std::string levels_text(const std::vector<Choice>& choices, const Levels& levels);

/// The scene seen by cameras of 1/2ⁿ of the pixels each way and the same angles of view; what is believed of
/// them in pixels is divided likewise. A camera model's file in `folder` is replaced by its numbers.
SceneSpec with_cameras_halved(SceneSpec spec, int halvings, const std::filesystem::path& folder);

/// The longest side of the scene's cameras, in pixels; 0 without cameras.
int longest_side_px(const Scene& scene);

}  // namespace laterna
