#include "apps/lab/live_page.h"

#include "apps/lab/matrices.h"
#include "apps/lab/report/thumbnails.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <bit>

namespace laterna {

extern const char live_script[], live_style[];  // made by the build of apps/live

namespace {

static_assert(std::endian::native == std::endian::little, "the page reads bytes as they stand here");

template <class T>
std::string base64_of(const std::vector<T>& values) {
  return base64({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

nlohmann::json mesh_json(const Object& object) {
  const std::vector<glm::vec3> positions(object.mesh.positions.begin(), object.mesh.positions.end());
  return {{"name", object.name},
          {"albedo", object.albedo},
          {"world_from_object", json_of(object.world_from_object)},
          {"positions", base64_of(positions)},
          {"triangles", base64_of(object.mesh.triangles)}};
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

nlohmann::json live_json(const Scene& scene, const SceneRays& rig, const std::string& name) {
  StageTimes times;
  nlohmann::json data = matrices_json(scene);
  data["name"] = name;
  data["ambient_lx"] = scene.ambient_lx;
  data["texture_from_clip"] = json_of(texture_from_clip());
  data["left_out"] = live_omissions(scene);
  data["switches"] = {{"in_front", true},
                      {"back_face", scene.effects.back_face},
                      {"shadow", scene.effects.shadow},
                      {"irradiance", scene.effects.irradiance}};
  for (std::size_t p = 0; p < scene.projectors.size(); ++p) {
    const Projector& projector = scene.projectors[p];
    data["projectors"][p].update(
        {{"flux_lm", projector.flux_lm},
         {"border", scene.effects.border && projector.border == Border::black},
         {"bilinear", projector.lookup == Lookup::bilinear},
         {"patterns", patterns_json({scene.patterns, projector.device.intrinsics.size})}});
    for (std::size_t c = 0; c < scene.cameras.size(); ++c)
      data["cameras"][c]["saturation_cd_per_m2"].push_back(
          saturation_cd_per_m2(scene, rig, int(c), int(p), times));
  }
  data["meshes"] = nlohmann::json::array();
  for (const Object& object : scene.objects) data["meshes"].push_back(mesh_json(object));
  return data;
}

nlohmann::json live_json(const Scene& scene, const std::string& name) {
  StageTimes times;
  return live_json(scene, make_rig(scene, times), name);
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
  const auto add_lens = [&](const Device& device) {
    if (!is_pinhole(device.lens)) add("the lens of " + device.name);
  };
  for (const Projector& projector : scene.projectors) add_lens(projector.device);
  for (const Camera& camera : scene.cameras) add_lens(camera.device);
  for (const Object& object : scene.objects)
    if (object.albedo_map) add("the albedo map of " + object.name);
  constexpr Effects none{};
  for (const EffectSwitch& effect : all_effects)
    if (scene.effects.*effect.on && !(none.*effect.on)) add(effect.name);
  return left_out.empty() ? "" : "the live view leaves out: " + left_out;
}

}  // namespace laterna
