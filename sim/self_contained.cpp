#include "sim/self_contained.h"

#include "sim/error.h"
#include "sim/ply.h"
#include "sim/safe_write.h"
#include "sim/scene_build.h"
#include "sim/scene_file.h"
#include "sim/text_file.h"

#include <fmt/format.h>

namespace laterna {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_bytes = std::size_t(1) << 32;

/// Writes `bytes` under target/subfolder/name and gives the path from `target`.
std::string put(const fs::path& target, const char* subfolder, const std::string& name,
                const std::string& bytes) {
  std::error_code error;
  fs::create_directories(target / subfolder, error);
  if (error)
    throw InputError(fmt::format("{}: cannot be made: {}", (target / subfolder).string(), error.message()));
  write_file(target / subfolder / name, bytes);
  return std::string(subfolder) + "/" + name;
}

void copy_cameramodel(DeviceSpec& device, const char* kind, std::size_t index, const fs::path& folder,
                      const fs::path& target) {
  if (device.cameramodel.empty()) return;
  device.cameramodel = put(target, "cameramodels", fmt::format("{}{}.cameramodel", kind, index + 1),
                           read_text(folder / device.cameramodel, most_bytes));
}

/// Copies a picture byte for byte under maps/, unless there is none.
void copy_picture(std::string& file, const std::string& name, const fs::path& folder,
                  const fs::path& target) {
  if (file.empty()) return;
  const fs::path from = folder / file;
  file = put(target, "maps", name + from.extension().string(), read_text(from, most_bytes));
}

/// Calls visit(name) for every file name that a scene may hold.
template <class Visit>
void for_each_file(SceneSpec& spec, const Visit& visit) {
  for (MeshSpec& mesh : spec.meshes)
    for (std::string* file : {&mesh.file, &mesh.believed.file, &mesh.albedo_map, &mesh.effects.normal_map,
                              &mesh.effects.displacement_map})
      visit(*file);
  for (ProjectorSpec& projector : spec.projectors)
    visit(projector.device.cameramodel), visit(projector.effects.vignetting.map);
  for (CameraSpec& camera : spec.cameras) visit(camera.device.cameramodel), visit(camera.vignetting.map);
  visit(spec.patterns.file);
  for (std::string& file : spec.patterns.files) visit(file);
}

}  // namespace

SceneSpec write_self_contained(const SceneSpec& spec, const Scene& scene, const fs::path& folder,
                               const fs::path& target) {
  SceneSpec copy = with_names(spec);
  for (std::size_t i = 0; i < copy.meshes.size(); ++i) {
    MeshSpec& mesh = copy.meshes[i];
    if (!mesh.file.empty())
      mesh.file =
          put(target, "meshes", fmt::format("mesh{}.ply", i + 1), ply_bytes(scene.objects.at(i).mesh));
    if (!mesh.believed.file.empty())
      mesh.believed.file = put(target, "meshes", fmt::format("believed{}.ply", i + 1),
                               ply_bytes(*scene.objects.at(i).believed_mesh));
    copy_picture(mesh.albedo_map, fmt::format("map{}", i + 1), folder, target);
    copy_picture(mesh.effects.normal_map, fmt::format("normals{}", i + 1), folder, target);
    copy_picture(mesh.effects.displacement_map, fmt::format("heights{}", i + 1), folder, target);
  }
  for (std::size_t i = 0; i < copy.projectors.size(); ++i) {
    copy_cameramodel(copy.projectors[i].device, "projector", i, folder, target);
    copy_picture(copy.projectors[i].effects.vignetting.map, fmt::format("projector{}", i + 1), folder,
                 target);
  }
  for (std::size_t i = 0; i < copy.cameras.size(); ++i) {
    copy_cameramodel(copy.cameras[i].device, "camera", i, folder, target);
    copy_picture(copy.cameras[i].vignetting.map, fmt::format("camera{}", i + 1), folder, target);
  }
  copy_picture(copy.patterns.file, "slide", folder, target);
  for (std::size_t i = 0; i < copy.patterns.files.size(); ++i)
    copy_picture(copy.patterns.files[i], fmt::format("picture{}", i + 1), folder, target);
  write_file(target / "scene.toml", scene_toml(copy));
  return copy;
}

SceneSpec seen_from(SceneSpec spec, const fs::path& folder, const fs::path& target) {
  const fs::path from = fs::weakly_canonical(fs::absolute(folder)),
                 to = fs::weakly_canonical(fs::absolute(target));
  for_each_file(spec, [&](std::string& file) {
    if (!file.empty() && fs::path(file).is_relative())
      file = fs::weakly_canonical(from / file).lexically_proximate(to).generic_string();
  });
  return spec;
}

std::vector<fs::path> files_of(SceneSpec spec, const fs::path& folder) {
  std::vector<fs::path> files;
  for_each_file(spec, [&](const std::string& file) {
    if (!file.empty()) files.push_back(folder / file);
  });
  return files;
}

}  // namespace laterna
