// The scene's [effects]: one switch for each physical effect, and the stage on which it acts.
#pragma once

#include <array>

namespace laterna {

/// Off, an effect leaves no trace: maps, stacks and pictures have the bits that they have without its code.
struct Effects {
  bool shadow = true, back_face = true, border = true, light_planes = true, irradiance = true;
  bool projector_vignetting = false, camera_vignetting = false, veiling_glare = false;
  bool scaler = false, spotlight = false, attenuation = false, slide = false;
  bool gloss = false, normal_map = false, solid_albedo = false;
  bool response = false, black_level = false;
  bool projector_lens = true, camera_lens = true;
  bool antialiasing = false, camera_defocus = false, projector_defocus = false;
  bool diffraction = false, fill_factor = false;
  bool inter_reflection = false, displacement = false;
  bool colour = false, timing = false, camera_glare = false;
  bool operator==(const Effects&) const = default;
};

/// One switch. The description of [effects], its checks and the report of costs go through all_effects.
struct EffectSwitch {
  const char* name;      ///< its key
  const char* stage;     ///< warp, rays, surface, rows, weight, pattern, replay or exposure
  const char* sentence;  ///< what it does, for the docs
  bool Effects::*on;
};

inline constexpr auto all_effects = std::to_array<EffectSwitch>({
    {"shadow", "rows", "What stands between a point and the projector takes its light.", &Effects::shadow},
    {"back_face", "rows",
     "A surface is lit and seen on its front only. Off: both sides, whichever of them each device is on.",
     &Effects::back_face},
    {"border", "rows",
     "Light ends at the picture's edge, as `border` of [[projector]] says. Off: the edge pixel's light goes "
     "on.",
     &Effects::border},
    {"light_planes", "rows", "Light begins at `near` and ends at `far` of [[projector]].",
     &Effects::light_planes},
    {"irradiance", "weight",
     "Light falls with distance and incidence. Off: every lit point gets what a facing plane at 1 m gets.",
     &Effects::irradiance},
    {"projector_vignetting", "weight", "Needs `vignetting` of a [[projector]].",
     &Effects::projector_vignetting},
    {"camera_vignetting", "weight", "Needs `vignetting` of a [[camera]].", &Effects::camera_vignetting},
    {"veiling_glare", "pattern", "Needs `veiling_glare` of a [[projector]].", &Effects::veiling_glare},
    {"scaler", "pattern", "Needs `scaler` of a [[projector]].", &Effects::scaler},
    {"spotlight", "weight", "Needs `spotlight` of a [[projector]].", &Effects::spotlight},
    {"attenuation", "weight", "Needs `attenuation` of a [[projector]].", &Effects::attenuation},
    {"slide", "pattern", "Needs `kind = \"slide\"` and `file` of [patterns].", &Effects::slide},
    {"gloss", "weight", "Needs `gloss` of a [[mesh]].", &Effects::gloss},
    {"normal_map", "weight", "Needs `normal_map` of a [[mesh]].", &Effects::normal_map},
    {"displacement", "surface", "Needs `displacement_map` of a [[mesh]].", &Effects::displacement},
    {"solid_albedo", "surface", "Needs `solid` of a [[mesh]].", &Effects::solid_albedo},
    {"response", "pattern", "Needs `response_exponent` or `response_table` of a [[projector]].",
     &Effects::response},
    {"black_level", "pattern", "Needs `black_level` of a [[projector]].", &Effects::black_level},
    {"projector_lens", "warp", "`lens` of [[projector]]. Off: a pinhole.", &Effects::projector_lens},
    {"camera_lens", "warp", "`lens` of [[camera]]. Off: a pinhole.", &Effects::camera_lens},
    {"antialiasing", "rays", "Needs `samples_per_pixel` above 1 of a [[camera]].", &Effects::antialiasing},
    {"camera_defocus", "rays",
     "Needs `aperture_m` and `focus_m` of a [[camera]], and `samples_per_pixel` above 1.",
     &Effects::camera_defocus},
    {"projector_defocus", "rows", "Needs `aperture_m` and `focus_m` of a [[projector]].",
     &Effects::projector_defocus},
    {"diffraction", "rows",
     "Needs `aperture_m` of a [[projector]], or of a [[camera]] with `samples_per_pixel` above 1.",
     &Effects::diffraction},
    {"fill_factor", "rows",
     "Needs `fill_factor` below 1 of a [[projector]], or, with `antialiasing`, of a [[camera]].",
     &Effects::fill_factor},
    {"inter_reflection", "rows",
     "Surfaces light each other, diffusely. Needs `bounces` above 0 of [inter_reflection].",
     &Effects::inter_reflection},
    {"colour", "weight",
     "Projectors have a red, a green and a blue primary. Needs a coloured slide, `colour` of [patterns], "
     "[[colour]], or a `colour_filter` of a [[camera]].",
     &Effects::colour},
    {"timing", "replay", "Needs [timing].", &Effects::timing},
    {"camera_glare", "replay", "Needs `veiling_glare` of a [[camera]].", &Effects::camera_glare},
});

/// Whether the panel shows anything but the pattern sequence as it stands.
inline bool edits_patterns(const Effects& e) {
  return e.veiling_glare || e.scaler || e.slide || e.response || e.black_level;
}

}  // namespace laterna
