#include "apps/lab/matrices.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace laterna {

nlohmann::json json_of(const glm::dmat4& m) {
  auto rows = nlohmann::json::array();
  for (int i = 0; i < 4; ++i) rows.push_back({m[0][i], m[1][i], m[2][i], m[3][i]});
  return rows;
}

namespace {

nlohmann::json json_of(const Device& device) {
  const Intrinsics& k = device.intrinsics;
  return {{"name", device.name},
          {"size", {k.size.x, k.size.y}},
          {"fx", k.fx},
          {"fy", k.fy},
          {"cx", k.cx},
          {"cy", k.cy},
          {"lens", {{"model", device.lens.model}, {"parameters", device.lens.parameters}}},
          {"texture_from_clip", laterna::json_of(texture_from_clip())},
          {"clip_from_projector", laterna::json_of(clip_from_projector(k, device.planes))},
          {"projector_from_world", laterna::json_of(projector_from_world(device.device_from_world))},
          {"texture_from_world", laterna::json_of(texture_from_world(device))}};
}

std::string text_of(const char* kind, const Device& device) {
  const Intrinsics& k = device.intrinsics;
  const glm::dvec3 c = center_in_world(device.device_from_world);
  std::string text = fmt::format(
      "{} \"{}\"  {} × {} px  fx {:.3f}  fy {:.3f}  cx {:.3f}  cy {:.3f}  at ({:.4f}, {:.4f}, {:.4f}) m\n",
      kind, device.name, k.size.x, k.size.y, k.fx, k.fy, k.cx, k.cy, c.x, c.y, c.z);
  if (!is_pinhole(device.lens))
    text += fmt::format("  lens {} [{:.6g}]\n", device.lens.model, fmt::join(device.lens.parameters, ", "));
  const glm::dmat4 t = texture_from_world(device);
  for (int i = 0; i < 4; ++i) {
    text += fmt::format("  {}{:>16.9f} {:>16.9f} {:>16.9f} {:>16.9f}\n", i == 0 ? "T = " : "    ", t[0][i],
                        t[1][i], t[2][i], t[3][i]);
  }
  return text;
}

}  // namespace

nlohmann::json matrices_json(const Scene& scene) {
  nlohmann::json json{{"projectors", nlohmann::json::array()}, {"cameras", nlohmann::json::array()}};
  for (const Projector& p : scene.projectors) json["projectors"].push_back(json_of(p.device));
  for (const Camera& c : scene.cameras) json["cameras"].push_back(json_of(c.device));
  return json;
}

std::string matrices_text(const Scene& scene) {
  std::string text;
  for (const Object& object : scene.objects) {
    text += fmt::format("mesh \"{}\"  {} vertices  {} triangles\n", object.name, object.mesh.positions.size(),
                        object.mesh.triangles.size());
  }
  for (const Projector& p : scene.projectors) text += text_of("projector", p.device);
  for (const Camera& c : scene.cameras) text += text_of("camera", c.device);
  return text;
}

}  // namespace laterna
