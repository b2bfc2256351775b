#include "sim/formats/kalibr.h"

#include "sim/error.h"
#include "sim/formats/fisheye.h"

#include <fmt/format.h>

namespace laterna {

namespace {

constexpr std::size_t most_fitted = 16;  // lenses of a file: each takes some 15 ms

// "/projector/image_raw" to "projector"; the key where there is no topic.
std::string name_of(const Place& camera, const std::string& key) {
  if (!camera.has("rostopic")) return key;
  const std::string topic = camera.at("rostopic").text();
  const std::size_t first = topic.find_first_not_of('/');
  if (first == topic.npos) return key;
  return topic.substr(first, topic.find('/', first) - first);
}

// `device` has its name and intrinsics.
Lens lens_of(const Place& camera, const Device& device, Notes& notes) {
  const Place model = camera.at("distortion_model");
  const std::string name = model.text();
  if (name == "none") return {};
  if (name != "radtan" && name != "equidistant") fail_at(model, "radtan, equidistant or none");
  const std::vector<double> coefficients = camera.at("distortion_coeffs").numbers(4);
  if (name == "radtan") return lens_from_opencv(coefficients, camera.name);
  if (notes.size() == most_fitted)
    fail_at(model, fmt::format("no more than {} equidistant lenses in a file", most_fitted));
  return lens_from_fisheye(device, coefficients, camera.name, notes);
}

Rigid link_of(const Place& camera) {
  const Place link = camera.at("T_cn_cnm1");
  const std::vector<double> t = link.numbers(16);
  if (t[12] != 0 || t[13] != 0 || t[14] != 0 || t[15] != 1) fail_at(link, "a last row of 0, 0, 0, 1");
  return rigid_from_rotation_rows(std::vector<double>{t[0], t[1], t[2], t[4], t[5], t[6], t[8], t[9], t[10]},
                                  {t[3], t[7], t[11]}, link.name);
}

std::string link_text(const Rigid& motion) {
  const std::vector<double> r = rotation_rows(motion);
  std::string text = "  T_cn_cnm1:\n";
  for (int i = 0; i < 3; ++i)
    text +=
        fmt::format("  - [{}, {}, {}, {}]\n", r[3 * i], r[3 * i + 1], r[3 * i + 2], motion.translation[i]);
  return text + "  - [0, 0, 0, 1]\n";
}

}  // namespace

Rig parse_kalibr(const std::string& text, const std::string& file_name) {
  const Tree tree = yaml_tree(text, file_name);
  const Place file{&tree, file_name};
  Rig rig;
  Rigid device_from_world{};
  for (int i = 0; i == 0 || file.has(fmt::format("cam{}", i).c_str()); ++i) {
    const std::string key = fmt::format("cam{}", i);
    const Place camera = file.at(key);
    if (camera.at("camera_model").text() != "pinhole") fail_at(camera.at("camera_model"), "pinhole");
    const std::vector<double> k = camera.at("intrinsics").numbers(4);
    if (i > 0) device_from_world = compose(link_of(camera), device_from_world);
    Device device;
    device.name = name_of(camera, key);
    device.intrinsics = {camera.at("resolution").size_px(), k[0], k[1], k[2], k[3]};
    device.device_from_world = device_from_world;
    device.lens = lens_of(camera, device, rig.notes);
    add_by_name(rig, std::move(device));
  }
  return rig;
}

std::string kalibr_text(const Rig& given, Notes& notes) {
  note_projectors(given, "kalibr", notes);
  const std::vector<Device> devices =
      devices_of(relative_to(given, devices_of(given).at(0), "kalibr", notes));
  std::string text;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const Device& d = devices[i];
    const Intrinsics& k = d.intrinsics;
    std::vector<double> lens = opencv_coefficients(d, "kalibr", 4);
    text += fmt::format("cam{}:\n", i);
    if (i > 0) text += link_text(compose(d.device_from_world, inverse(devices[i - 1].device_from_world)));
    text += fmt::format(
        "  camera_model: pinhole\n  distortion_coeffs: [{}]\n  distortion_model: {}\n"
        "  intrinsics: [{}, {}, {}, {}]\n  resolution: [{}, {}]\n  rostopic: /{}/image_raw\n",
        joined(lens), lens.empty() ? "none" : "radtan", k.fx, k.fy, k.cx, k.cy, k.size.x, k.size.y, d.name);
  }
  return text;
}

}  // namespace laterna
