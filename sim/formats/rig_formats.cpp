// The table of formats, in the order in which they are tried.
#include "sim/cameramodel_file.h"
#include "sim/capture_folder.h"
#include "sim/error.h"
#include "sim/formats/bop.h"
#include "sim/formats/bop_scene.h"
#include "sim/formats/colmap.h"
#include "sim/formats/exr_camera.h"
#include "sim/formats/gltf.h"
#include "sim/formats/kalibr.h"
#include "sim/formats/laterna_rig.h"
#include "sim/formats/opencv_storage.h"
#include "sim/formats/rig_file.h"
#include "sim/formats/ros_camera_info.h"
#include "sim/formats/usd_camera.h"
#include "sim/text_file.h"

#include <algorithm>
#include <array>

namespace laterna {

namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) { return read_text(path, most_tree_bytes); }

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

template <const char* const& layout>
std::vector<RigText> opencv_texts(const Rig& rig, Notes& notes) {
  return {{"", opencv_storage_text(rig, layout, notes)}};
}
constexpr const char *opencv = "opencv", *scan3d = "scan3d", *procam = "procam", *slstudio = "slstudio",
                     *stereo = "opencv-stereo";

bool is_opencv(const fs::path&, const Tree& tree) { return is_opencv_layout(tree); }
bool never(const fs::path&, const Tree&) { return false; }

Rig read_opencv(const fs::path& path, const RigReadOptions&) {
  return parse_opencv_storage(text_of(path), path.string());
}

bool is_mrcal(const fs::path& path, const Tree&) { return is_or_holds(path, ".cameramodel"); }
Rig read_mrcal(const fs::path& path, const RigReadOptions&) {
  Rig rig;
  for (const fs::path& file : files_at(path, ".cameramodel")) add_by_name(rig, read_cameramodel(file));
  return rig;
}
std::vector<RigText> mrcal_texts(const Rig& rig, Notes& notes) {
  note_projectors(rig, "mrcal", notes);
  return file_each(rig, ".cameramodel", cameramodel_text);
}

// The folder that holds both files, whichever of the three is named.
fs::path colmap_folder(const fs::path& path) { return fs::is_directory(path) ? path : path.parent_path(); }
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

bool is_kalibr(const fs::path&, const Tree& tree) { return tree.is_object() && tree.contains("cam0"); }
Rig read_kalibr(const fs::path& path, const RigReadOptions&) {
  return parse_kalibr(text_of(path), path.string());
}
std::vector<RigText> kalibr_texts(const Rig& rig, Notes& notes) { return {{"", kalibr_text(rig, notes)}}; }

bool is_ros(const fs::path& path, const Tree& tree) {
  if (fs::is_directory(path)) return !files_at(path, ".yaml").empty();
  return tree.is_object() && tree.contains("distortion_model");
}
Rig read_ros(const fs::path& path, const RigReadOptions&) {
  Rig rig;
  for (const fs::path& file : files_at(path, ".yaml"))
    add_by_name(rig, parse_camera_info(text_of(file), file.string()));
  return rig;
}
std::vector<RigText> ros_texts(const Rig& rig, Notes& notes) {
  note_projectors(rig, "ROS's camera_info", notes);
  return file_each(rig, ".yaml", [&](const Device& device) { return camera_info_text(device, notes); });
}

bool is_bop_file(const fs::path& path, const Tree& tree) { return is_bop(tree) || is_bop_scene(path); }
Rig read_bop(const fs::path& path, const RigReadOptions&) {
  return is_bop_scene(path) ? read_bop_cameras(path) : parse_bop(text_of(path), path.string());
}
std::vector<RigText> bop_texts(const Rig& rig, Notes& notes) { return {{"", bop_text(rig, notes)}}; }

bool is_gltf_file(const fs::path&, const Tree& tree) { return is_gltf(tree); }
Rig read_gltf(const fs::path& path, const RigReadOptions& options) {
  return parse_gltf(text_of(path), options.camera_size, path.string());
}
std::vector<RigText> gltf_texts(const Rig& rig, Notes& notes) { return {{"", gltf_text(rig, notes)}}; }

bool is_usd(const fs::path& path, const Tree&) { return path.extension() == ".usda"; }
Rig read_usd(const fs::path& path, const RigReadOptions& options) {
  return parse_usd_cameras(text_of(path), options.camera_size, path.string());
}
std::vector<RigText> usd_texts(const Rig& rig, Notes& notes) { return {{"", usd_camera_text(rig, notes)}}; }

// A folder of nothing else: others hold maps beside what they are about.
bool is_exr(const fs::path& path, const Tree&) {
  if (!fs::is_directory(path)) return path.extension() == ".exr";
  const std::vector<fs::path> files = files_at(path, ".exr");
  return !files.empty() && std::ptrdiff_t(files.size()) == std::distance(fs::directory_iterator(path), {});
}
Rig read_exr(const fs::path& path, const RigReadOptions&) {
  Rig rig;
  for (const fs::path& file : files_at(path, ".exr")) add_by_name(rig, read_exr_camera(file));
  return rig;
}
std::vector<RigText> exr_texts(const Rig& rig, Notes& notes) {
  note_projectors(rig, "EXR", notes);
  return file_each(rig, ".exr", exr_camera_bytes);
}

// A scene, or the scene of a capture folder.
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

bool is_estimate(const fs::path&, const Tree& tree) { return is_laterna_json(tree); }
Rig read_estimate(const fs::path& path, const RigReadOptions&) {
  return parse_laterna_json(text_of(path), path.string());
}
std::vector<RigText> estimate_texts(const Rig& rig, Notes&) { return {{"", laterna_json_text(rig)}}; }

constexpr std::array formats = {
    RigFormat{"scene", ".toml", "Laterna's scene file, or a capture folder", true, is_scene, read_scene,
              scene_texts},
    RigFormat{"estimate", ".json", "what laterna calibrate -o and roundtrip -o write", true, is_estimate,
              read_estimate, estimate_texts},
    RigFormat{"mrcal", ".cameramodel", "mrcal's .cameramodel; several devices: a folder of them", false,
              is_mrcal, read_mrcal, mrcal_texts},
    RigFormat{"colmap", "", "COLMAP's folder of cameras.txt and images.txt", false, is_colmap, read_colmap,
              colmap_texts},
    RigFormat{"gltf", ".gltf", "cameras of glTF, with a block LATERNA_device", true, is_gltf_file, read_gltf,
              gltf_texts},
    RigFormat{"usd", ".usda", "cameras of OpenUSD, as text", true, is_usd, read_usd, usd_texts},
    RigFormat{"exr", ".exr", "worldToCamera and worldToNDC of OpenEXR; several devices: a folder of them",
              false, is_exr, read_exr, exr_texts},
    RigFormat{"bop", "", "BOP's scene_camera.json, or a scene's folder with one", true, is_bop_file, read_bop,
              bop_texts},
    RigFormat{"kalibr", "", "kalibr's camchain.yaml", true, is_kalibr, read_kalibr, kalibr_texts},
    RigFormat{"ros", ".yaml", "ROS's camera_info; several devices: a folder of them", true, is_ros, read_ros,
              ros_texts},
    RigFormat{"opencv", ".yml", "OpenCV's storage: lists Cameras and Projectors; reads the next four too",
              false, is_opencv, read_opencv, opencv_texts<opencv>},
    RigFormat{"scan3d", "", "scan3d-capture's calibration.yml", false, never, read_opencv,
              opencv_texts<scan3d>},
    RigFormat{"procam", ".xml", "procam-calibration's calibration_result.xml", false, never, read_opencv,
              opencv_texts<procam>},
    RigFormat{"slstudio", "", "SLStudio's calibration.xml", false, never, read_opencv,
              opencv_texts<slstudio>},
    RigFormat{"opencv-stereo", "", "M1, D1, M2, D2, R, T of OpenCV's stereo samples", false, never,
              read_opencv, opencv_texts<stereo>},
};

}  // namespace

std::span<const RigFormat> rig_formats() { return formats; }

}  // namespace laterna
