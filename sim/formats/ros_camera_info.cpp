#include "sim/formats/ros_camera_info.h"

#include "sim/error.h"
#include "sim/formats/fisheye.h"

#include <fmt/format.h>

namespace laterna {

namespace {

std::vector<double> matrix(const Place& place, std::size_t count) { return place.at("data").numbers(count); }

// `device` has its name and intrinsics.
Lens lens_of(const Place& file, const Device& device, Notes& notes) {
  const Place model = file.at("distortion_model");
  const Place coefficients = file.at("distortion_coefficients");
  const std::string name = model.text();
  if (name == "equidistant" || name == "fisheye")
    return lens_from_fisheye(device, matrix(coefficients, 4), coefficients.name, notes);
  if (name != "plumb_bob" && name != "rational_polynomial")
    fail_at(model, "plumb_bob, rational_polynomial, equidistant or fisheye");
  return lens_from_opencv(matrix(coefficients, 0), coefficients.name);
}

// Where R and P stand for an identity, the origin.
Rigid placement_of(const Place& file) {
  Rigid rectified_from_world, device_from_rectified;
  if (file.has("projection_matrix")) {
    const Place place = file.at("projection_matrix");
    const std::vector<double> p = matrix(place, 12);
    if (p[3] != 0 || p[7] != 0) {
      if (!(p[0] > 0 && p[5] > 0)) fail_at(place, "focal lengths above 0 beside Tx, Ty");
      rectified_from_world.translation = {p[3] / p[0], p[7] / p[5], 0};
    }
  }
  if (file.has("rectification_matrix")) {
    const Place place = file.at("rectification_matrix");
    device_from_rectified = inverse(rigid_from_rotation_rows(matrix(place, 9), {}, place.name));
  }
  return compose(device_from_rectified, rectified_from_world);
}

std::string matrix_text(const char* key, int rows, const std::vector<double>& data) {
  return fmt::format("{}:\n  rows: {}\n  cols: {}\n  data: [{}]\n", key, rows,
                     data.size() / std::size_t(rows), joined(data));
}

}  // namespace

Device parse_camera_info(const std::string& text, const std::string& file_name, Notes& notes) {
  const Tree tree = yaml_tree(text, file_name);
  const Place file{&tree, file_name};
  Device device;
  device.name = file.at("camera_name").text();
  const Place k = file.at("camera_matrix");
  const glm::ivec2 size(file.at("image_width").whole_number(), file.at("image_height").whole_number());
  device.intrinsics = intrinsics_from_k(matrix(k, 9), size, k.name);
  device.lens = lens_of(file, device, notes);
  device.device_from_world = placement_of(file);
  return device;
}

std::string camera_info_text(const Device& device, Notes& notes) {
  const Intrinsics& k = device.intrinsics;
  std::vector<double> lens = opencv_coefficients(device, "ROS's camera_info", 8);
  const Rigid& place = device.device_from_world;
  if (place.translation != glm::dvec3(0.0) || place.rotation != glm::dmat3(1.0))
    notes.push_back(
        fmt::format("ROS's camera_info holds no placement: that of \"{}\" is left out", device.name));
  if (lens.size() < 5) lens.resize(5, 0.0);
  return fmt::format("image_width: {}\nimage_height: {}\ncamera_name: {}\n", k.size.x, k.size.y,
                     Tree(device.name).dump()) +
         matrix_text("camera_matrix", 3, k_of(k)) +
         fmt::format("distortion_model: {}\n", lens.size() == 8 ? "rational_polynomial" : "plumb_bob") +
         matrix_text("distortion_coefficients", 1, lens) +
         matrix_text("rectification_matrix", 3, {1, 0, 0, 0, 1, 0, 0, 0, 1}) +
         matrix_text("projection_matrix", 3, {k.fx, 0, k.cx, 0, 0, k.fy, k.cy, 0, 0, 0, 1, 0});
}

}  // namespace laterna
