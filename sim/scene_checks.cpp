#include "sim/device_spec.h"
#include "sim/effect_checks.h"
#include "sim/error.h"
#include "sim/plain_name.h"
#include "sim/printed_board.h"
#include "sim/scene_build.h"
#include "sim/scene_heading.h"

#include <fmt/format.h>

#include <set>

namespace laterna {

namespace {

void check_device(const DeviceSpec& device, const char* kind) {
  const std::string what = heading(kind, device.name);
  if (device.cameramodel.empty())
    device_of(device, {}, what);
  else
    check_ways(device, what);
}

template <class Spec>
void name_devices(std::vector<Spec>& devices, const char* kind) {
  for (std::size_t i = 0; i < devices.size(); ++i) {
    std::string& name = devices[i].device.name;
    if (name.empty()) name = devices.size() == 1 ? kind : fmt::format("{}{}", kind, i + 1);
  }
}

std::string mesh_name(const MeshSpec& mesh) {
  if (!mesh.board.empty()) return "board";
  if (mesh.file.empty()) return mesh.shape;
  std::filesystem::path stem = std::filesystem::path(mesh.file).filename();
  if (stem.extension() == ".gz") stem = stem.stem();
  return stem.stem().string();
}

}  // namespace

void check(const MeshSpec& mesh) {
  about(heading("mesh", mesh.name), [&] {
    const int given = int(!mesh.file.empty()) + int(!mesh.shape.empty()) + int(!mesh.board.empty());
    if (given != 1)
      throw InputError(fmt::format("{} of file, shape and board are given, expected one", given));
    if (!mesh.board.empty()) {
      parse_board(mesh.board);
      if (!mesh.albedo_map.empty()) throw InputError("albedo_map is given for a board, which has a print");
    }
    world_from_file(mesh);
    check(mesh.effects, mesh.albedo);
  });
}

void check(const ProjectorSpec& projector) {
  check_device(projector.device, "projector");
  about(heading("projector", projector.device.name), [&] { check(projector.effects); });
}

void check(const CameraSpec& camera) {
  check_device(camera.device, "camera");
  about(heading("camera", camera.device.name), [&] { check(camera.vignetting); });
}

void check(const ColourSpec& colour) {
  if (colour.projector.empty() || colour.camera.empty())
    throw InputError("[[colour]]: the key projector or camera is missing, expected the names of both");
  if (colour.mixing.size() != 9)
    throw InputError(fmt::format("[[colour]]: mixing has {} numbers, expected 9", colour.mixing.size()));
}

void check(const SceneSpec& scene) {
  if (scene.meshes.empty()) throw InputError("there is no [[mesh]], expected at least one");
  check_effects(scene);
  const SceneSpec named = with_names(scene);
  std::set<std::string> names;
  for (const MeshSpec& mesh : named.meshes) check_plain_name(mesh.name, heading("mesh", ""));
  const auto add = [&](const char* kind, const std::string& name) {
    check_plain_name(name, heading(kind, ""));
    if (!names.insert(name).second)
      throw InputError(fmt::format("{}: the name is taken by another device, expected one of its own",
                                   heading(kind, name)));
  };
  for (const ProjectorSpec& projector : named.projectors) add("projector", projector.device.name);
  for (const CameraSpec& camera : named.cameras) add("camera", camera.device.name);
  check_references(named);
}

SceneSpec with_names(SceneSpec spec) {
  for (MeshSpec& mesh : spec.meshes)
    if (mesh.name.empty()) mesh.name = mesh_name(mesh);
  name_devices(spec.projectors, "projector");
  name_devices(spec.cameras, "camera");
  return spec;
}

}  // namespace laterna
