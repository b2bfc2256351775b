#include "sim/formats/opencv_storage.h"

#include "sim/error.h"
#include "sim/formats/fisheye.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace laterna {

namespace {

// The keys of a layout that holds one camera and one projector.
struct PairLayout {
  const char *name, *camera_k, *camera_d, *projector_k, *projector_d, *rotation, *translation;
  bool xml;
};
constexpr std::size_t slstudio_terms = 5;
constexpr std::array layouts = {
    PairLayout{"scan3d", "cam_K", "cam_kc", "proj_K", "proj_kc", "R", "T", false},
    PairLayout{"scan3d", "Cam_K", "Cam_kc", "Proj_K", "Proj_Kc", "R", "T", false},
    PairLayout{"procam", "cam_int", "cam_dist", "proj_int", "proj_dist", "roration", "translation", true},
    PairLayout{"procam", "cam_int", "cam_dist", "proj_int", "proj_dist", "rotation", "translation", true},
    PairLayout{"slstudio", "Kc", "kc", "Kp", "kp", "Rp", "Tp", true},
    PairLayout{"opencv-stereo", "M1", "D1", "M2", "D2", "R", "T", false},
};

// A matrix of OpenCV's, or a plain list; `count` 0: any number.
std::vector<double> matrix(const Place& place, std::size_t count) {
  if (!place.tree->is_object()) return place.numbers(count);
  const int rows = place.at("rows").whole_number(), cols = place.at("cols").whole_number();
  std::vector<double> data = place.at("data").numbers(count);
  if (rows < 0 || cols < 0 || std::size_t(rows) * std::size_t(cols) != data.size())
    throw InputError(
        fmt::format("{}: {} rows and {} columns, but {} numbers", place.name, rows, cols, data.size()));
  return data;
}

Rigid motion(const Place& rotation, const Place& translation) {
  const std::vector<double> t = matrix(translation, 3);
  return rigid_from_rotation_rows(matrix(rotation, 9), {t[0], t[1], t[2]}, rotation.name);
}

Device device_of(const std::string& name, const Place& k, const Place& d, glm::ivec2 size) {
  Device device;
  device.name = name;
  device.intrinsics = intrinsics_from_k(matrix(k, 9), size, k.name);
  device.lens = lens_from_opencv(matrix(d, 0), d.name);
  return device;
}

glm::ivec2 size_at(const Place& file, const char* key, bool height_first = false) {
  if (!file.has(key)) return {0, 0};
  const std::vector<double> numbers = matrix(file.at(key), 2);
  if (!is_whole(numbers[0]) || !is_whole(numbers[1])) fail_at(file.at(key), "whole numbers of pixels");
  const glm::ivec2 size(numbers[0], numbers[1]);
  return height_first ? glm::ivec2(size.y, size.x) : size;
}

glm::ivec2 size_at(const Place& file, const char* width, const char* height) {
  if (!file.has(width) || !file.has(height)) return {0, 0};
  return {file.at(width).whole_number(), file.at(height).whole_number()};
}

// The first that the file says.
glm::ivec2 camera_size(const Place& file) {
  for (const glm::ivec2 size : {size_at(file, "cam_size"), size_at(file, "img_shape", true),
                                size_at(file, "frameWidth", "frameHeight")})
    if (size.x != 0) return size;
  return {0, 0};
}

glm::ivec2 projector_size(const Place& file) {
  const glm::ivec2 size = size_at(file, "proj_size");
  return size.x != 0 ? size : size_at(file, "screenResX", "screenResY");
}

Rig pair_of(const Place& file, const PairLayout& layout) {
  Rig rig;
  rig.cameras.push_back(
      device_of("camera", file.at(layout.camera_k), file.at(layout.camera_d), camera_size(file)));
  rig.projectors.push_back(
      device_of("projector", file.at(layout.projector_k), file.at(layout.projector_d), projector_size(file)));
  rig.projectors[0].device_from_world = motion(file.at(layout.rotation), file.at(layout.translation));
  return rig;
}

std::vector<Device> devices_at(const Place& file, const char* key) {
  std::vector<Device> devices;
  if (!file.has(key)) return devices;
  const Place list = file.at(key);
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Place entry = list.at(i);
    const glm::ivec2 size = entry.has("size") ? size_at(entry, "size") : glm::ivec2(0, 0);
    devices.push_back(device_of(entry.at("name").text(), entry.at("K"), entry.at("D"), size));
    devices.back().device_from_world = motion(entry.at("R"), entry.at("T"));
  }
  return devices;
}

// What OpenCV's calibration sample writes of one camera.
struct SampleLayout {
  const char *k, *d, *width, *height;
};
constexpr std::array samples = {
    SampleLayout{"camera_matrix", "distortion_coefficients", "image_width", "image_height"},
    SampleLayout{"Camera_Matrix", "Distortion_Coefficients", "image_Width", "image_Height"},
};

Rig sample_of(const Place& file, const SampleLayout& layout) {
  const Place k = file.at(layout.k), d = file.at(layout.d);
  const glm::ivec2 size = size_at(file, layout.width, layout.height);
  if (!file.has("fisheye_model") || file.at("fisheye_model").whole_number() == 0)
    return {{device_of("camera", k, d, size)}, {}};
  Rig rig;
  Device camera;
  camera.name = "camera";
  camera.intrinsics = intrinsics_from_k(matrix(k, 9), size, k.name);
  camera.lens = lens_from_fisheye(camera, matrix(d, 4), d.name, rig.notes);
  rig.cameras.push_back(std::move(camera));
  return rig;
}

std::string matrix_text(const char* key, int rows, const std::vector<double>& data, bool xml,
                        const char* indent = "") {
  const std::size_t cols = data.size() / std::size_t(rows);
  if (xml)
    return fmt::format(
        "<{0} type_id=\"opencv-matrix\">\n  <rows>{1}</rows>\n  <cols>{2}</cols>\n  <dt>d</dt>\n"
        "  <data>\n    {3}</data></{0}>\n",
        key, rows, cols, joined(data, " "));
  return fmt::format(
      "{4}{0}: !!opencv-matrix\n{4}   rows: {1}\n{4}   cols: {2}\n{4}   dt: d\n{4}   data: [ {3} ]\n", key,
      rows, cols, joined(data), indent);
}

std::vector<double> translation_of(const Device& device) {
  const glm::dvec3 t = device.device_from_world.translation;
  return {t.x, t.y, t.z};
}

// A distortion matrix is never empty in these files: a pinhole has five zeros.
std::vector<double> written_coefficients(const Device& device) {
  std::vector<double> c = opencv_coefficients(device, "OpenCV's storage");
  return c.empty() ? std::vector<double>(5, 0.0) : c;
}

std::vector<double> written_coefficients(const Device& device, const std::string& layout) {
  if (layout != "slstudio") return written_coefficients(device);
  std::vector<double> c = opencv_coefficients(device, "SLStudio", slstudio_terms);
  c.resize(slstudio_terms, 0.0);
  return c;
}

glm::dmat3 k_matrix(const Intrinsics& k) { return {k.fx, 0, 0, 0, k.fy, 0, k.cx, k.cy, 1}; }

// E = [T]×·R, and F = K_projector⁻ᵀ·E·K_camera⁻¹: pixel_projectorᵀ·F·pixel_camera = 0 without lenses.
std::string epipolar_text(const Device& camera, const Device& projector) {
  const auto& [r, t] = projector.device_from_world;
  const glm::dmat3 e = glm::dmat3(0, t.z, -t.y, -t.z, 0, t.x, t.y, -t.x, 0) * r;
  const glm::dmat3 f = glm::transpose(glm::inverse(k_matrix(projector.intrinsics))) * e *
                       glm::inverse(k_matrix(camera.intrinsics));
  return matrix_text("E", 3, rotation_rows({e, {}}), false) +
         matrix_text("F", 3, rotation_rows({f, {}}), false);
}

std::string sizes_text(const Device& camera, const Device& projector, const std::string& layout, bool xml) {
  const glm::ivec2 c = camera.intrinsics.size, p = projector.intrinsics.size;
  if (layout == "slstudio")
    return fmt::format(
        "<frameWidth>{}</frameWidth>\n<frameHeight>{}</frameHeight>\n<screenResX>{}</screenResX>\n"
        "<screenResY>{}</screenResY>\n",
        c.x, c.y, p.x, p.y);
  const auto two = [&](const char* key, int a, int b) {
    return matrix_text(key, 2, {double(a), double(b)}, xml);
  };
  if (layout == "procam") return two("img_shape", c.y, c.x) + two("proj_size", p.x, p.y);
  return two("cam_size", c.x, c.y) + two("proj_size", p.x, p.y);
}

std::string pair_text(const Rig& given, const PairLayout& layout, Notes& notes) {
  if (given.cameras.size() != 1 || given.projectors.size() != 1)
    throw InputError(fmt::format("{} holds one camera and one projector, found {} and {}", layout.name,
                                 given.cameras.size(), given.projectors.size()));
  const Rig rig = relative_to(given, given.cameras[0], layout.name, notes);
  const Device &camera = rig.cameras[0], &projector = rig.projectors[0];
  const auto text = [&](const char* key, int rows, const std::vector<double>& data) {
    return matrix_text(key, rows, data, layout.xml);
  };
  std::string body = sizes_text(camera, projector, layout.name, layout.xml) +
                     text(layout.camera_k, 3, k_of(camera.intrinsics)) +
                     text(layout.camera_d, 1, written_coefficients(camera, layout.name)) +
                     text(layout.projector_k, 3, k_of(projector.intrinsics)) +
                     text(layout.projector_d, 1, written_coefficients(projector, layout.name)) +
                     text(layout.rotation, 3, rotation_rows(projector.device_from_world)) +
                     text(layout.translation, 3, translation_of(projector));
  if (layout.name == std::string("scan3d")) body += epipolar_text(camera, projector);
  return layout.xml ? "<?xml version=\"1.0\"?>\n<opencv_storage>\n" + body + "</opencv_storage>\n"
                    : "%YAML:1.0\n---\n" + body;
}

std::string list_text(const char* key, const std::vector<Device>& devices) {
  if (devices.empty()) return "";
  std::string text = fmt::format("{}:\n", key);
  for (const Device& d : devices) {
    text += fmt::format("   -\n      name: {}\n      size: [ {}, {} ]\n", Tree(d.name).dump(),
                        d.intrinsics.size.x, d.intrinsics.size.y);
    text += matrix_text("K", 3, k_of(d.intrinsics), false, "      ") +
            matrix_text("D", 1, written_coefficients(d), false, "      ") +
            matrix_text("R", 3, rotation_rows(d.device_from_world), false, "      ") +
            matrix_text("T", 3, translation_of(d), false, "      ");
  }
  return text;
}

}  // namespace

bool is_opencv_layout(const Tree& tree) {
  if (!tree.is_object()) return false;
  const auto has = [&](const char* key) { return tree.contains(key); };
  return has("Cameras") || has("Projectors") || (has("camera_matrix") && !has("distortion_model")) ||
         has("Camera_Matrix") ||
         std::any_of(layouts.begin(), layouts.end(), [&](const PairLayout& l) { return has(l.camera_k); });
}

Rig parse_opencv_storage(const std::string& text, const std::string& file_name,
                         const std::string& extrinsics) {
  Tree tree = any_tree(text, file_name);
  if (!extrinsics.empty())
    if (const Tree more = any_tree(extrinsics, "extrinsics"); tree.is_object() && more.is_object())
      tree.update(more);
  const Place file{&tree, file_name};
  if (file.has("Cameras") || file.has("Projectors"))
    return {devices_at(file, "Cameras"), devices_at(file, "Projectors")};
  for (const PairLayout& layout : layouts)
    if (file.has(layout.camera_k) &&
        (file.has(layout.rotation) || std::string(layout.rotation) != "roration"))
      return pair_of(file, layout);
  for (const SampleLayout& layout : samples)
    if (file.has(layout.k)) return sample_of(file, layout);
  throw InputError(fmt::format(
      "{}: no layout that is known, expected cam_K, cam_int, Kc, M1, camera_matrix, Cameras or Projectors",
      file_name));
}

std::string opencv_storage_text(const Rig& rig, const std::string& layout, Notes& notes) {
  for (const PairLayout& pair : layouts)
    if (layout == pair.name) return pair_text(rig, pair, notes);
  if (layout != "opencv")
    throw InputError(fmt::format("no layout of OpenCV's storage is called \"{}\"", layout));
  return "%YAML:1.0\n---\n" + list_text("Cameras", rig.cameras) + list_text("Projectors", rig.projectors);
}

}  // namespace laterna
