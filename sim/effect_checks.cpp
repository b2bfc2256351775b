#include "sim/effect_checks.h"

#include "sim/error.h"
#include "sim/field_text.h"
#include "sim/scene_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace laterna {

namespace {

double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const glm::dvec2 ab = b - a, bc = c - b;
  return ab.x * bc.y - ab.y * bc.x;
}

template <class Nouns, class Given>
void expect_given(bool on, const char* name, const char* heading, const char* key, const Nouns& nouns,
                  const Given& given) {
  if (!on || std::any_of(nouns.begin(), nouns.end(), given)) return;
  throw InputError(fmt::format("[effects]: {} is on, but no [[{}]] has the key {}, expected at least one",
                               name, heading, key));
}

void check_projector_effects(const SceneSpec& scene) {
  const auto expect = [&](bool on, const char* name, const char* key, auto&& given) {
    expect_given(on, name, "projector", key, scene.projectors,
                 [&](const ProjectorSpec& projector) { return given(projector.effects); });
  };
  using P = ProjectorEffects;
  const Effects& on = scene.effects;
  expect(on.projector_vignetting, "projector_vignetting", "vignetting",
         [](const P& p) { return p.vignetting.model != VignettingModel::none; });
  expect(on.veiling_glare, "veiling_glare", "veiling_glare",
         [](const P& p) { return p.veiling_glare.has_value(); });
  expect(on.scaler, "scaler", "scaler", [](const P& p) { return !(p.scaler == Scaler{}); });
  expect(on.spotlight, "spotlight", "spotlight", [](const P& p) { return !(p.spotlight == Spotlight{}); });
  expect(on.attenuation, "attenuation", "attenuation", [](const P& p) { return p.attenuation.has_value(); });
  expect(on.response, "response", "response_exponent (or response_table)",
         [](const P& p) { return p.response_exponent || !p.response_table.empty(); });
  expect(on.black_level, "black_level", "black_level", [](const P& p) { return p.black_level.has_value(); });
}

bool focuses(const Optics& optics) { return optics.aperture_m && optics.focus_m; }

void check_camera_samples(const SceneSpec& scene) {
  const Effects& on = scene.effects;
  for (const CameraSpec& camera : scene.cameras) {
    const Optics& optics = camera.optics;
    const bool spreads = (on.camera_defocus && focuses(optics)) || (on.diffraction && optics.aperture_m);
    if (spreads && camera.samples_per_pixel < 2)
      throw InputError(fmt::format(
          "[effects]: {} is on, but samples_per_pixel of a [[camera]] is 1, expected more: its rays are "
          "spread over the aperture",
          on.camera_defocus ? "camera_defocus" : "diffraction"));
    if (on.fill_factor && optics.fill_factor < 1 && !on.antialiasing)
      throw InputError(
          "[effects]: fill_factor is on and a [[camera]] has it, but antialiasing is off, expected on: it "
          "is the antialiasing's rays that leave a pixel's rim out");
  }
}

template <class Given>
bool any_optics(const SceneSpec& scene, const Given& given) {
  return std::any_of(scene.cameras.begin(), scene.cameras.end(),
                     [&](const CameraSpec& c) { return given(c.optics); }) ||
         std::any_of(scene.projectors.begin(), scene.projectors.end(),
                     [&](const ProjectorSpec& p) { return given(p.effects.optics); });
}

void check_optics(const SceneSpec& scene) {
  const Effects& on = scene.effects;
  expect_given(on.camera_defocus, "camera_defocus", "camera", "aperture_m (with focus_m)", scene.cameras,
               [](const CameraSpec& c) { return focuses(c.optics); });
  expect_given(on.projector_defocus, "projector_defocus", "projector", "aperture_m (with focus_m)",
               scene.projectors, [](const ProjectorSpec& p) { return focuses(p.effects.optics); });
  if (on.diffraction && !any_optics(scene, [](const Optics& o) { return o.aperture_m.has_value(); }))
    throw InputError(
        "[effects]: diffraction is on, but no device has the key aperture_m, expected at least one");
  if (on.fill_factor && !any_optics(scene, [](const Optics& o) { return o.fill_factor < 1; }))
    throw InputError("[effects]: fill_factor is on, but no device has one below 1, expected at least one");
  check_camera_samples(scene);
}

void check_slide(const SceneSpec& scene) {
  const PatternKind kind = scene.patterns.parameters.kind;
  const bool is_slide = kind == PatternKind::slide, is_list = kind == PatternKind::pictures;
  if (scene.effects.slide && !is_slide)
    throw InputError(fmt::format("[effects]: slide is on, but kind of [patterns] is {}, expected \"slide\"",
                                 toml_text(kind)));
  if (!scene.effects.slide && is_slide)
    throw InputError(
        "[patterns]: kind is \"slide\", but slide of [effects] is off, expected slide = true there");
  if (is_slide && scene.patterns.file.empty())
    throw InputError("[effects]: slide is on, but [patterns] has no key file, expected a picture");
  if (is_list == scene.patterns.files.empty())
    throw InputError(is_list ? "[patterns]: kind is \"pictures\", but files is empty, expected pictures"
                             : "[patterns]: files is given, but kind is not \"pictures\"");
}

void check_inter_reflection(const SceneSpec& scene) {
  if (!scene.effects.inter_reflection) return;
  const auto [bounces, paths] = scene.inter_reflection;
  if (bounces < 1)
    throw InputError(
        "[effects]: inter_reflection is on, but [inter_reflection] has no bounces, expected at least 1");
  const Effects& on = scene.effects;
  const bool spread = on.antialiasing || on.camera_defocus || on.diffraction;
  for (const CameraSpec& camera : scene.cameras) {
    const long samples = spread ? camera.samples_per_pixel : 1;
    const long entries = samples * bounces * paths;
    if (entries > most_entries_per_pixel) {
      throw InputError(
          fmt::format("[inter_reflection]: {} samples per pixel × {} paths × {} bounces = {}, expected at "
                      "most {}",
                      samples, paths, bounces, entries, most_entries_per_pixel));
    }
  }
}

void check_colour_and_timing(const SceneSpec& scene) {
  const Effects& on = scene.effects;
  const auto filtered = [](const CameraSpec& c) { return c.colour_filter != ColourFilter::mono; };
  if (on.colour && scene.colours.empty() && !comes_from_files(scene.patterns.parameters.kind) &&
      scene.patterns.colour == PatternsSpec{}.colour &&
      std::none_of(scene.cameras.begin(), scene.cameras.end(), filtered))
    throw InputError(
        "[effects]: colour is on, but nothing has a colour, expected [[colour]], colour of [patterns], a "
        "slide, or colour_filter of a [[camera]]");
  if (on.timing && scene.timing == Timing{})
    throw InputError("[effects]: timing is on, but [timing] has no key, expected at least one");
  if (on.timing && scene.timing.colour_wheel && !on.colour)
    throw InputError("[timing]: colour_wheel is on, but colour of [effects] is off, expected it on");
  expect_given(on.camera_glare, "camera_glare", "camera", "veiling_glare", scene.cameras,
               [](const CameraSpec& c) { return c.veiling_glare > 0; });
}

template <class Devices>
bool has_device(const Devices& devices, const std::string& name) {
  return std::any_of(devices.begin(), devices.end(), [&](const auto& d) { return d.device.name == name; });
}

}  // namespace

std::array<glm::dvec2, 4> keystone_corners(const Scaler& scaler) {
  if (scaler.keystone.empty()) return {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  std::array<glm::dvec2, 4> corners;
  for (int i = 0; i < 4; ++i) corners[i] = {scaler.keystone[2 * i], scaler.keystone[2 * i + 1]};
  return corners;
}

void check(const Vignetting& vignetting) {
  if (vignetting.model == VignettingModel::polynomial && vignetting.coefficients.empty())
    throw InputError("vignetting: the model is \"polynomial\", but coefficients are missing");
  if (vignetting.model == VignettingModel::map && vignetting.map.empty())
    throw InputError("vignetting: the model is \"map\", but map is missing, expected a picture file");
}

void check(const Scaler& scaler) {
  if (!scaler.keystone.empty() && scaler.keystone.size() != 8)
    throw InputError(fmt::format("scaler: keystone has {} numbers, expected 8", scaler.keystone.size()));
  const auto c = keystone_corners(scaler);
  for (int i = 0; i < 4; ++i) {
    // 1e-6: a corner this flat would blow a pixel up to the whole panel.
    if (!(turn(c[i], c[(i + 1) % 4], c[(i + 2) % 4]) > 1e-6))
      throw InputError(
          "scaler: keystone is no convex quadrilateral, expected upper left, upper right, lower right, lower "
          "left");
  }
}

void check(const ProjectorEffects& effects) {
  check(effects.vignetting);
  check(effects.scaler);
  if (effects.attenuation && !(effects.attenuation->x + effects.attenuation->y + effects.attenuation->z > 0))
    throw InputError("attenuation: all three numbers are 0, expected one above 0");
  if (effects.response_exponent && !effects.response_table.empty())
    throw InputError("response_exponent and response_table are both given, expected one of the two");
  if (effects.response_table.size() == 1)
    throw InputError("response_table has 1 number, expected at least 2");
}

void check(const Gloss& gloss, double albedo) {
  if (gloss.model == GlossModel::phong && !gloss.exponent)
    throw InputError("gloss: the model is \"phong\", but exponent is missing");
  if (gloss.model == GlossModel::ggx && !gloss.roughness)
    throw InputError("gloss: the model is \"ggx\", but roughness is missing");
  // 1e-12: decimal fractions that add to 1 may miss it by a rounding.
  if (gloss.model != GlossModel::none && !(albedo + gloss.strength <= 1 + 1e-12)) {
    throw InputError(fmt::format("gloss: strength {} and albedo {} together reflect more than all light",
                                 gloss.strength, albedo));
  }
}

void check_references(const SceneSpec& named) {
  std::set<std::pair<std::string, std::string>> pairs;
  const auto fail = [](const std::string& where, const char* kind, const std::string& name) {
    throw InputError(
        fmt::format("{}: no {} is called \"{}\", expected one of the scene's", where, kind, name));
  };
  for (const ColourSpec& c : named.colours) {
    if (!has_device(named.projectors, c.projector)) fail("[[colour]]", "projector", c.projector);
    if (!has_device(named.cameras, c.camera)) fail("[[colour]]", "camera", c.camera);
    if (!pairs.insert({c.projector, c.camera}).second)
      throw InputError(
          fmt::format("[[colour]]: \"{}\" and \"{}\" have two mixings, expected one", c.projector, c.camera));
  }
  const std::string& moved = named.timing.moved.device;
  if (!moved.empty() && !has_device(named.projectors, moved) && !has_device(named.cameras, moved))
    fail("[timing]: moved", "projector or camera", moved);
}

void check(const MeshEffects& effects, double albedo) {
  check(effects.gloss, albedo);
  if (!effects.displacement_map.empty() && effects.displacement == 0)
    throw InputError(
        "displacement_map is given, but displacement is missing or 0, expected how far white moves");
  if (effects.displacement_map.empty() && effects.displacement != 0)
    throw InputError("displacement is given, but displacement_map is missing, expected a picture file");
}

void check_effects(const SceneSpec& scene) {
  check_projector_effects(scene);
  check_slide(scene);
  check_inter_reflection(scene);
  check_optics(scene);
  check_colour_and_timing(scene);
  const Effects& on = scene.effects;
  expect_given(on.camera_vignetting, "camera_vignetting", "camera", "vignetting", scene.cameras,
               [](const CameraSpec& c) { return c.vignetting.model != VignettingModel::none; });
  expect_given(on.antialiasing, "antialiasing", "camera", "samples_per_pixel above 1", scene.cameras,
               [](const CameraSpec& c) { return c.samples_per_pixel > 1; });
  expect_given(on.gloss, "gloss", "mesh", "gloss", scene.meshes,
               [](const MeshSpec& m) { return m.effects.gloss.model != GlossModel::none; });
  expect_given(on.displacement, "displacement", "mesh", "displacement_map", scene.meshes,
               [](const MeshSpec& m) { return !m.effects.displacement_map.empty(); });
  expect_given(on.normal_map, "normal_map", "mesh", "normal_map", scene.meshes,
               [](const MeshSpec& m) { return !m.effects.normal_map.empty(); });
  expect_given(on.solid_albedo, "solid_albedo", "mesh", "solid", scene.meshes,
               [](const MeshSpec& m) { return m.effects.solid.kind != SolidKind::none; });
}

}  // namespace laterna
