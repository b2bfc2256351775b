#include "sim/formats/rig_folders.h"

#include "sim/cameramodel_file.h"
#include "sim/capture_folder.h"
#include "sim/error.h"
#include "sim/formats/colmap.h"
#include "sim/formats/exr_camera.h"
#include "sim/formats/laterna_rig.h"
#include "sim/formats/ros_camera_info.h"
#include "sim/text_file.h"

#include <algorithm>

namespace laterna {

namespace fs = std::filesystem;

namespace {

// The files of a folder with an ending, sorted; the file itself.
std::vector<fs::path> files_at(const fs::path& path, const std::string& ending) {
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(path))
    if (entry.is_regular_file() && entry.path().extension() == ending) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

bool is_or_holds(const fs::path& path, const std::string& ending) {
  if (!fs::is_directory(path)) return path.extension() == ending;
  return !files_at(path, ending).empty();
}

// One file per device; a rig of one device is one file.
template <class Text>
std::vector<RigText> file_each(const Rig& rig, const std::string& ending, Text&& text_of_device) {
  std::vector<RigText> texts;
  for (const Device& device : devices_of(rig))
    texts.push_back({device.name + ending, text_of_device(device)});
  if (texts.size() == 1) texts[0].name.clear();
  return texts;
}

// A device of each file; projectors by their names.
template <class Read>
Rig device_each(const fs::path& path, const std::string& ending, Read&& read_device) {
  Rig rig;
  for (const fs::path& file : files_at(path, ending)) add_by_name(rig, read_device(file));
  return rig;
}

// The folder that holds both files, whichever of the three is named.
fs::path colmap_folder(const fs::path& path) { return fs::is_directory(path) ? path : path.parent_path(); }

}  // namespace

std::string text_of(const fs::path& path) { return read_text(path, most_tree_bytes); }

bool is_mrcal(const fs::path& path, const Tree&) { return is_or_holds(path, ".cameramodel"); }
Rig read_mrcal(const fs::path& path, const RigReadOptions&) {
  return device_each(path, ".cameramodel", read_cameramodel);
}
std::vector<RigText> mrcal_texts(const Rig& rig, Notes& notes) {
  note_projectors(rig, "mrcal", notes);
  return file_each(rig, ".cameramodel", cameramodel_text);
}

bool is_colmap(const fs::path& path, const Tree&) {
  const bool named = path.filename() == "cameras.txt" || path.filename() == "images.txt";
  return named || (fs::is_directory(path) && fs::exists(path / "cameras.txt"));
}
Rig read_colmap(const fs::path& path, const RigReadOptions&) {
  const fs::path folder = colmap_folder(path);
  return parse_colmap(text_of(folder / "cameras.txt"),
                      read_text(folder / "images.txt", std::size_t(64) << 20), folder.string());
}
std::vector<RigText> colmap_texts(const Rig& rig, Notes& notes) {
  const ColmapText text = colmap_text(rig, notes);
  return {{"cameras.txt", text.cameras_txt}, {"images.txt", text.images_txt}, {"points3D.txt", ""}};
}

bool is_ros(const fs::path& path, const Tree& tree) {
  if (fs::is_directory(path)) return !files_at(path, ".yaml").empty();
  return tree.is_object() && tree.contains("distortion_model");
}
Rig read_ros(const fs::path& path, const RigReadOptions&) {
  Notes notes;
  Rig rig = device_each(path, ".yaml", [&](const fs::path& file) {
    return parse_camera_info(text_of(file), file.string(), notes);
  });
  rig.notes = std::move(notes);
  return rig;
}
std::vector<RigText> ros_texts(const Rig& rig, Notes& notes) {
  note_projectors(rig, "ROS's camera_info", notes);
  return file_each(rig, ".yaml", [&](const Device& device) { return camera_info_text(device, notes); });
}

bool is_exr(const fs::path& path, const Tree&) {
  if (!fs::is_directory(path)) return path.extension() == ".exr";
  const std::vector<fs::path> files = files_at(path, ".exr");
  return !files.empty() && std::ptrdiff_t(files.size()) == std::distance(fs::directory_iterator(path), {});
}
Rig read_exr(const fs::path& path, const RigReadOptions&) {
  return device_each(path, ".exr", read_exr_camera);
}
std::vector<RigText> exr_texts(const Rig& rig, Notes& notes) {
  note_projectors(rig, "EXR", notes);
  return file_each(rig, ".exr", exr_camera_bytes);
}

bool is_scene(const fs::path& path, const Tree&) {
  return path.extension() == ".toml" || (fs::is_directory(path) && fs::exists(path / "manifest.json"));
}
Rig read_scene(const fs::path& path, const RigReadOptions&) {
  if (!fs::is_directory(path)) return read_scene_rig(path);
  const CaptureManifest manifest = read_manifest(path);
  if (manifest.scene.empty()) throw InputError(path.string() + ": the capture has no scene");
  return read_scene_rig(path / manifest.scene);
}
std::vector<RigText> scene_texts(const Rig& rig, Notes& notes) { return {{"", scene_rig_text(rig, notes)}}; }

}  // namespace laterna
