#include "sim/formats/bop.h"

#include "sim/error.h"

#include <fmt/format.h>

namespace laterna {

namespace {

constexpr double metres_per_millimetre = 1e-3;

}  // namespace

Device bop_device(const Place& entry, const std::string& key) {
  Device device;
  device.name = entry.has("name") ? entry.at("name").text() : key;
  const glm::ivec2 size =
      entry.has("width") ? glm::ivec2(entry.at("width").whole_number(), entry.at("height").whole_number())
                         : glm::ivec2(0, 0);
  const Place k = entry.at("cam_K");
  device.intrinsics = intrinsics_from_k(k.numbers(9), size, k.name);
  if (!entry.has("cam_R_w2c")) return device;
  const std::vector<double> t = entry.at("cam_t_w2c").numbers(3);
  device.device_from_world = rigid_from_rotation_rows(
      entry.at("cam_R_w2c").numbers(9), glm::dvec3(t[0], t[1], t[2]) * metres_per_millimetre, entry.name);
  return device;
}

bool is_bop(const Tree& tree) {
  return tree.is_object() && !tree.empty() && tree.begin()->is_object() && tree.begin()->contains("cam_K");
}

Rig parse_bop(const std::string& text, const std::string& file_name) {
  const Tree tree = json_tree(text, file_name);
  const Place file{&tree, file_name};
  if (!tree.is_object()) fail_at(file, "a camera for each picture");
  Rig rig;
  for (const auto& [key, entry] : tree.items()) add_by_name(rig, bop_device(file.at(key), key));
  return rig;
}

std::string bop_text(const Rig& rig, Notes& notes) {
  note_projectors(rig, "BOP", notes);
  Tree file = Tree::object();
  int id = 0;
  for (const Device& d : devices_of(rig)) {
    if (!is_pinhole(d.lens))
      throw InputError(fmt::format("BOP holds no lens, \"{}\" has {}", d.name, d.lens.model));
    const glm::dvec3 t = d.device_from_world.translation / metres_per_millimetre;
    file[std::to_string(id++)] = {{"cam_K", k_of(d.intrinsics)},
                                  {"cam_R_w2c", rotation_rows(d.device_from_world)},
                                  {"cam_t_w2c", {t.x, t.y, t.z}},
                                  {"depth_scale", 1.0},
                                  {"name", d.name},
                                  {"width", d.intrinsics.size.x},
                                  {"height", d.intrinsics.size.y}};
  }
  return file.dump(2) + "\n";
}

}  // namespace laterna
