#include "apps/lab/live_page.h"

#include "apps/lab/matrices.h"
#include "apps/lab/simulation.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace laterna {

extern const char live_script[], live_style[];  // made by the build of apps/live

namespace {

// The shortest decimal that single precision reads as this number.
double shortest(double x) { return std::stod(fmt::format("{}", float(x))); }

nlohmann::json mesh_json(const Object& object) {
  auto positions = nlohmann::json::array(), triangles = nlohmann::json::array();
  for (const glm::dvec3& x : object.mesh.positions)
    for (int i = 0; i < 3; ++i) positions.push_back(shortest(x[i]));
  for (const glm::uvec3& t : object.mesh.triangles)
    for (int i = 0; i < 3; ++i) triangles.push_back(t[i]);
  return {{"name", object.name},
          {"albedo", object.albedo},
          {"world_from_object", json_of(object.world_from_object)},
          {"positions", positions},
          {"triangles", triangles}};
}

// A coded picture changes along one axis only, so that a line tells all of it.
nlohmann::json patterns_json(const PatternSequence& sequence) {
  auto patterns = nlohmann::json::array();
  if (!is_coded(sequence.parameters.kind)) return patterns;
  for (const PatternGroup& group : pattern_groups(sequence)) {
    for (int k = group.first; k < group.first + group.count; ++k) {
      const Image<std::uint8_t> picture = pattern_picture(sequence, k);
      std::string values;
      const int count = group.axis == 0 ? picture.width : picture.height;
      for (int i = 0; i < count; ++i)
        values += fmt::format("{:02x}", group.axis == 0 ? picture(i, 0) : picture(0, i));
      patterns.push_back({{"name", picture_name(sequence, k)}, {"axis", group.axis}, {"values", values}});
    }
  }
  return patterns;
}

// A script element ends at the first "</": JSON may write it otherwise.
std::string for_script(std::string text) {
  for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3)
    text.insert(at + 1, "\\");
  return text;
}

constexpr char test_hook[] = R"(
const wanted = /^#picture=(\d+)(?:&keys=(.*))?$/.exec(location.hash);
if (wanted) {
  for (const key of decodeURIComponent(wanted[2] ?? "")) view.key(key);
  view.setSlide(Number(wanted[1]));
  const { rgba } = view.renderer.picture(view.state);
  const digits = [];
  for (let i = 0; i < rgba.length; i += 4)
    digits.push((rgba[i + 3] > 127 ? "1" : "0") + rgba[i].toString(16).padStart(2, "0"));
  document.body.append(Object.assign(document.createElement("pre"), { id: "picture", hidden: true, textContent: digits.join("") }));
}
)";

}  // namespace

nlohmann::json live_json(const Scene& scene, const std::string& name) {
  StageTimes times;
  const SceneRays rig = make_rig(scene, times);
  const Projector& projector = scene.projectors[0];
  nlohmann::json data = matrices_json(scene);
  data["name"] = name;
  data["flux_lm"] = projector.flux_lm;
  data["ambient_lx"] = scene.ambient_lx;
  data["saturation_cd_per_m2"] = saturation_cd_per_m2(scene, rig, 0, 0, times);
  data["texture_from_clip"] = json_of(texture_from_clip());
  data["switches"] = {{"in_front", true},
                      {"border", scene.effects.border && projector.border == Border::black},
                      {"back_face", scene.effects.back_face},
                      {"shadow", scene.effects.shadow},
                      {"irradiance", scene.effects.irradiance},
                      {"bilinear", projector.lookup == Lookup::bilinear}};
  data["meshes"] = nlohmann::json::array();
  for (const Object& object : scene.objects) data["meshes"].push_back(mesh_json(object));
  data["patterns"] = patterns_json({scene.patterns, projector.device.intrinsics.size});
  return data;
}

std::string live_page(const nlohmann::json& data) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>Laterna, live</title>\n<style>\n{}</style>\n<main></main>\n"
      "<script type=\"application/json\" id=\"scene\">{}</script>\n<script type=\"module\">\n{}\n"
      "const scene = JSON.parse(document.getElementById(\"scene\").textContent);\n"
      "document.title = `${{scene.name}}, live`;\n"
      "const view = show(scene, document.querySelector(\"main\"));\n{}</script>\n</html>\n",
      live_style, for_script(data.dump()), live_script, test_hook);
}

std::string live_omissions(const Scene& scene) {
  std::string left_out;
  const auto add = [&](const std::string& what) { left_out += (left_out.empty() ? "" : ", ") + what; };
  if (scene.projectors.size() + scene.cameras.size() > 2) add("all but the first camera and projector");
  for (const Device* device : {&scene.projectors[0].device, &scene.cameras[0].device})
    if (!is_pinhole(device->lens)) add("the lens of " + device->name);
  for (const Object& object : scene.objects)
    if (object.albedo_map) add("the albedo map of " + object.name);
  constexpr Effects none{};
  for (const EffectSwitch& effect : all_effects)
    if (scene.effects.*effect.on && !(none.*effect.on)) add(effect.name);
  return left_out.empty() ? "" : "the live view leaves out: " + left_out;
}

}  // namespace laterna
