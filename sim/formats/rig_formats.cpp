// The table of formats, in the order in which they are tried.
#include "sim/cameramodel_file.h"
#include "sim/error.h"
#include "sim/formats/opencv_storage.h"
#include "sim/formats/rig_file.h"
#include "sim/plain_name.h"
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

Rig read_opencv(const fs::path& path) { return parse_opencv_storage(text_of(path), path.string()); }

bool is_mrcal(const fs::path& path, const Tree&) { return is_or_holds(path, ".cameramodel"); }

Rig read_mrcal(const fs::path& path) {
  Rig rig;
  for (const fs::path& file : files_at(path, ".cameramodel")) add_by_name(rig, read_cameramodel(file));
  return rig;
}

std::vector<RigText> mrcal_texts(const Rig& rig, Notes& notes) {
  note_projectors(rig, "mrcal", notes);
  return file_each(rig, ".cameramodel", cameramodel_text);
}

constexpr std::array formats = {
    RigFormat{"mrcal", ".cameramodel", "mrcal's .cameramodel, a file for each device", false, is_mrcal,
              read_mrcal, mrcal_texts},
    RigFormat{"opencv", ".yml", "OpenCV's storage: lists `Cameras` and `Projectors`; reads the four below",
              false, is_opencv, read_opencv, opencv_texts<opencv>},
    RigFormat{"scan3d", ".yml", "scan3d-capture's cam_K, cam_kc, proj_K, proj_kc, R, T", false, never,
              read_opencv, opencv_texts<scan3d>},
    RigFormat{"procam", ".xml", "procam-calibration's calibration_result.xml", false, never, read_opencv,
              opencv_texts<procam>},
    RigFormat{"slstudio", ".xml", "SLStudio's calibration", false, never, read_opencv,
              opencv_texts<slstudio>},
    RigFormat{"opencv-stereo", ".yml", "M1, D1, M2, D2, R, T of OpenCV's stereo samples", false, never,
              read_opencv, opencv_texts<stereo>},
};

}  // namespace

std::span<const RigFormat> rig_formats() { return formats; }

}  // namespace laterna
