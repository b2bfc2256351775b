#include "sim/formats/laterna_rig.h"

#include "sim/device_spec.h"
#include "sim/error.h"
#include "sim/scene_file.h"

#include <fmt/format.h>

namespace laterna {

namespace {

Rigid placement_of(const Place& entry) {
  const char* key = entry.has("device_from_world") ? "device_from_world" : "device_from_camera";
  if (!entry.has(key)) return {};
  const std::vector<double> m = entry.at(key).numbers(12);
  return rigid_from_rotation_rows(std::vector<double>{m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]},
                                  {m[3], m[7], m[11]}, entry.name);
}

Device device_of(const Place& entry, const std::string& name) {
  Device device;
  device.name = name;
  device.intrinsics = {entry.at("size").size_px(), entry.at("fx").number(), entry.at("fy").number(),
                       entry.at("cx").number(), entry.at("cy").number()};
  device.lens = {entry.at("lens").at("model").text(), entry.at("lens").at("parameters").numbers(0)};
  device.device_from_world = placement_of(entry);
  return device;
}

std::vector<Device> devices_at(const Place& file, const char* kind) {
  std::vector<Device> devices;
  if (!file.has(kind)) return devices;
  const Place list = file.at(kind);
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Place entry = list.at(i);
    if (entry.has("status") && entry.at("status").text() == "refused") continue;
    devices.push_back(
        device_of(entry.has("estimate") ? entry.at("estimate") : entry, entry.at("name").text()));
  }
  return devices;
}

Tree json_of(const Device& d) {
  const Intrinsics& k = d.intrinsics;
  return {{"name", d.name},
          {"status", "ok"},
          {"reason", ""},
          {"size", {k.size.x, k.size.y}},
          {"fx", k.fx},
          {"fy", k.fy},
          {"cx", k.cx},
          {"cy", k.cy},
          {"lens", {{"model", d.lens.model}, {"parameters", d.lens.parameters}}},
          {"device_from_world", rows_of(d.device_from_world)}};
}

DeviceSpec spec_of(const Device& d) {
  DeviceSpec spec;
  const Intrinsics& k = d.intrinsics;
  spec.name = d.name;
  spec.size = k.size;
  spec.fx = k.fx;
  spec.fy = k.fy;
  spec.cx = k.cx;
  spec.cy = k.cy;
  spec.device_from_world = rows_of(d.device_from_world);
  spec.lens = d.lens;
  return spec;
}

}  // namespace

Rig read_scene_rig(const std::filesystem::path& path) {
  const SceneSpec spec = with_names(read_scene_spec(path));
  const std::filesystem::path folder = path.parent_path();
  Rig rig;
  for (const CameraSpec& camera : spec.cameras)
    rig.cameras.push_back(device_of(camera.device, folder,
                                    fmt::format("{}: [[camera]] \"{}\"", path.string(), camera.device.name)));
  for (const ProjectorSpec& projector : spec.projectors)
    rig.projectors.push_back(
        device_of(projector.device, folder,
                  fmt::format("{}: [[projector]] \"{}\"", path.string(), projector.device.name)));
  return rig;
}

std::string scene_rig_text(const Rig& rig, Notes& notes) {
  SceneSpec spec;
  for (const Device& device : rig.cameras) spec.cameras.emplace_back().device = spec_of(device);
  for (const Device& device : rig.projectors) spec.projectors.emplace_back().device = spec_of(device);
  const Device first = devices_of(rig).at(0);
  // The plane lies in its own x and y, and shows its front to +z: towards the device.
  const Rigid device_from_plane{glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1), {0, 0, 2}};
  MeshSpec& plane = spec.meshes.emplace_back();
  plane.name = "plane";
  plane.shape = "plane";
  plane.shape_size = {4, 4, 1};
  plane.world_from_object = rows_of(compose(inverse(first.device_from_world), device_from_plane));
  notes.push_back(
      fmt::format("a rig has no surface: a plane 2 m before \"{}\" stands in the scene", first.name));
  return scene_toml(spec);
}

bool is_laterna_json(const Tree& tree) {
  if (!tree.is_object()) return false;
  const auto projectors = tree.find("projectors");
  return projectors != tree.end() && projectors->is_array();
}

Rig parse_laterna_json(const std::string& text, const std::string& file_name) {
  const Tree tree = json_tree(text, file_name);
  const Place file{&tree, file_name};
  return {devices_at(file, "cameras"), devices_at(file, "projectors"), devices_at(file, "given_cameras")};
}

std::string laterna_json_text(const Rig& rig) {
  Tree file = {{"format", "laterna-estimate"},
               {"version", 1},
               {"cameras", Tree::array()},
               {"projectors", Tree::array()}};
  for (const Device& device : rig.cameras) file["cameras"].push_back(json_of(device));
  for (const Device& device : rig.projectors) file["projectors"].push_back(json_of(device));
  return file.dump(2) + "\n";
}

}  // namespace laterna
