// The table of formats, in the order in which they are tried.
#include "sim/formats/bop.h"
#include "sim/formats/bop_scene.h"
#include "sim/formats/gltf.h"
#include "sim/formats/kalibr.h"
#include "sim/formats/laterna_rig.h"
#include "sim/formats/opencv_storage.h"
#include "sim/formats/rig_folders.h"
#include "sim/formats/usd_camera.h"

#include <array>

namespace laterna {

namespace {

namespace fs = std::filesystem;

std::vector<RigText> one_text(std::string text) { return {{"", std::move(text)}}; }

std::vector<RigText> opencv_texts(const Rig& rig, Notes& notes) {
  return one_text(opencv_storage_text(rig, "opencv", notes));
}
std::vector<RigText> scan3d_texts(const Rig& rig, Notes& notes) {
  return one_text(opencv_storage_text(rig, "scan3d", notes));
}
std::vector<RigText> procam_texts(const Rig& rig, Notes& notes) {
  return one_text(opencv_storage_text(rig, "procam", notes));
}
std::vector<RigText> slstudio_texts(const Rig& rig, Notes& notes) {
  return one_text(opencv_storage_text(rig, "slstudio", notes));
}
std::vector<RigText> stereo_texts(const Rig& rig, Notes& notes) {
  return one_text(opencv_storage_text(rig, "opencv-stereo", notes));
}
bool is_opencv(const fs::path&, const Tree& tree) { return is_opencv_layout(tree); }
bool never(const fs::path&, const Tree&) { return false; }

// OpenCV's stereo sample keeps R and T in a second file.
Rig read_opencv(const fs::path& path, const RigReadOptions&) {
  const fs::path beside = path.parent_path() / ("extrinsics" + path.extension().string());
  const bool two = path.stem() == "intrinsics" && fs::exists(beside);
  return parse_opencv_storage(text_of(path), path.string(), two ? text_of(beside) : "");
}

bool is_kalibr(const fs::path&, const Tree& tree) { return tree.is_object() && tree.contains("cam0"); }
Rig read_kalibr(const fs::path& path, const RigReadOptions&) {
  return parse_kalibr(text_of(path), path.string());
}
std::vector<RigText> kalibr_texts(const Rig& rig, Notes& notes) { return one_text(kalibr_text(rig, notes)); }

bool is_bop_file(const fs::path& path, const Tree& tree) { return is_bop(tree) || is_bop_scene(path); }
Rig read_bop(const fs::path& path, const RigReadOptions&) {
  return is_bop_scene(path) ? read_bop_cameras(path) : parse_bop(text_of(path), path.string());
}
std::vector<RigText> bop_texts(const Rig& rig, Notes& notes) { return one_text(bop_text(rig, notes)); }

bool is_gltf_file(const fs::path&, const Tree& tree) { return is_gltf(tree); }
Rig read_gltf(const fs::path& path, const RigReadOptions& options) {
  return parse_gltf(text_of(path), options.camera_size, path.string());
}
std::vector<RigText> gltf_texts(const Rig& rig, Notes& notes) { return one_text(gltf_text(rig, notes)); }

bool is_usd(const fs::path& path, const Tree&) { return path.extension() == ".usda"; }
Rig read_usd(const fs::path& path, const RigReadOptions& options) {
  return parse_usd_cameras(text_of(path), options.camera_size, path.string());
}
std::vector<RigText> usd_texts(const Rig& rig, Notes& notes) { return one_text(usd_camera_text(rig, notes)); }

bool is_estimate(const fs::path&, const Tree& tree) { return is_laterna_json(tree); }
Rig read_estimate(const fs::path& path, const RigReadOptions&) {
  return parse_laterna_json(text_of(path), path.string());
}
std::vector<RigText> estimate_texts(const Rig& rig, Notes&) { return one_text(laterna_json_text(rig)); }

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
              false, is_opencv, read_opencv, opencv_texts},
    RigFormat{"scan3d", "", "scan3d-capture's calibration.yml", false, never, read_opencv, scan3d_texts,
              true},
    RigFormat{"procam", ".xml", "procam-calibration's calibration_result.xml", false, never, read_opencv,
              procam_texts, true},
    RigFormat{"slstudio", "", "SLStudio's calibration.xml", false, never, read_opencv, slstudio_texts, true},
    RigFormat{"opencv-stereo", "", "M1, D1, M2, D2, R, T of OpenCV's stereo samples", false, never,
              read_opencv, stereo_texts, true},
};

}  // namespace

std::span<const RigFormat> rig_formats() { return formats; }

}  // namespace laterna
