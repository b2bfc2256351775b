#include "sim/formats/bop_scene.h"

#include "sim/error.h"
#include "sim/formats/bop.h"
#include "sim/image_file.h"
#include "sim/safe_write.h"
#include "sim/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

namespace fs = std::filesystem;

constexpr double metres_per_millimetre = 1e-3, most_steps = 65535;

std::string picture_name(int id) { return fmt::format("{:06}.png", id); }
std::string mask_name(int id, std::size_t object) { return fmt::format("{:06}_{:06}.png", id, object); }

// ---- reading

int id_of(const std::string& key, const std::string& file) {
  double id = -1;
  if (!read_number(key, id) || id < 0 || id != std::floor(id) || id > 1e9)
    throw InputError(fmt::format("{}: found \"{}\", expected a picture's number", file, key));
  return int(id);
}

Tree tree_of(const fs::path& file) { return json_tree(read_text(file, most_tree_bytes), file.string()); }

Tree tree_or_none(const fs::path& file) { return fs::exists(file) ? tree_of(file) : Tree::object(); }

void check_size(const fs::path& file, glm::ivec2 found, glm::ivec2 expected) {
  if (found != expected)
    throw InputError(fmt::format("{}: {}x{} pixels, expected its camera's {}x{}", file.string(), found.x,
                                 found.y, expected.x, expected.y));
}

// A picture of one channel; empty where there is no file.
template <class T>
Image<T> read_channel(const fs::path& file, glm::ivec2 size) {
  if (file.empty() || !fs::exists(file)) return {};
  Picture picture = read_picture(file);
  auto* values = std::get_if<std::vector<T>>(&picture.values);
  if (values == nullptr || picture.channel_names.size() != 1)
    throw InputError(fmt::format("{}: expected one channel of {} bits", file.string(), 8 * sizeof(T)));
  check_size(file, {picture.width, picture.height}, size);
  Image<T> image;
  image.width = picture.width, image.height = picture.height, image.values = std::move(*values);
  return image;
}

Image<float> read_depth(const fs::path& file, glm::ivec2 size, const Place& camera) {
  const double scale = camera.has("depth_scale") ? camera.at("depth_scale").number() : 1;
  if (!(scale > 0)) fail_at(camera.at("depth_scale"), "a number above 0");
  const Image<std::uint16_t> steps = read_channel<std::uint16_t>(file, size);
  Image<float> depth_m(steps.width, steps.height);
  std::transform(steps.values.begin(), steps.values.end(), depth_m.values.begin(), [&](std::uint16_t step) {
    return step == 0 ? NAN : float(step * scale * metres_per_millimetre);
  });
  return depth_m;
}

BopObject object_of(const Place& entry, const fs::path& folder, const std::string& name, glm::ivec2 size) {
  const std::vector<double> t = entry.at("cam_t_m2c").numbers(3);
  return {entry.at("obj_id").whole_number(),
          rigid_from_rotation_rows(entry.at("cam_R_m2c").numbers(9),
                                   glm::dvec3(t[0], t[1], t[2]) * metres_per_millimetre, entry.name),
          read_channel<std::uint8_t>(folder / "mask" / name, size),
          read_channel<std::uint8_t>(folder / "mask_visib" / name, size)};
}

// A picture's file, whichever ending it has; without one where it is not there.
fs::path picture_at(const fs::path& folder, int id) {
  for (const char* ending : {".png", ".tif", ".jpg"})
    if (fs::path file = folder / fmt::format("{:06}{}", id, ending); fs::exists(file)) return file;
  return {};
}

glm::ivec2 size_by_picture(const fs::path& folder, int id) {
  for (const char* kind : {"depth", "gray", "rgb"}) {
    const fs::path file = picture_at(folder / kind, id);
    if (file.empty()) continue;
    const Picture picture = read_picture(file);
    return {picture.width, picture.height};
  }
  return {0, 0};
}

struct NumberedCamera {
  int id;
  Device camera;
};

std::vector<NumberedCamera> cameras_of(const Place& file, const fs::path& folder) {
  if (!is_bop(*file.tree)) fail_at(file, "a camera for each picture");
  std::vector<NumberedCamera> cameras;
  for (const auto& [key, unused] : file.tree->items()) {
    NumberedCamera numbered{id_of(key, file.name), bop_device(file.at(key), key)};
    glm::ivec2& size = numbered.camera.intrinsics.size;
    if (size.x == 0) size = size_by_picture(folder, numbered.id);
    cameras.push_back(std::move(numbered));
  }
  std::sort(cameras.begin(), cameras.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return cameras;
}

// ---- writing

double depth_scale_of(const Image<float>& depth_m) {
  double farthest_mm = 0;
  for (const float depth : depth_m.values)
    if (std::isfinite(depth)) farthest_mm = std::max(farthest_mm, depth / metres_per_millimetre);
  double scale = 0.1;
  while (std::round(farthest_mm / scale) > most_steps) scale *= 10;
  return scale;
}

// A surface nearer than half a step is still one.
Image<std::uint16_t> depth_steps(const Image<float>& depth_m, double scale) {
  Image<std::uint16_t> steps(depth_m.width, depth_m.height);
  std::transform(depth_m.values.begin(), depth_m.values.end(), steps.values.begin(), [&](float depth) {
    if (!std::isfinite(depth)) return std::uint16_t(0);
    return std::uint16_t(std::clamp(std::round(depth / metres_per_millimetre / scale), 1.0, most_steps));
  });
  return steps;
}

template <class T>
void write_channel(const fs::path& file, const Image<T>& image) {
  if (image.values.empty()) return;
  fs::create_directories(file.parent_path());
  write_picture(file, image);
}

Tree pose_json(const BopObject& object) {
  const glm::dvec3 t = object.camera_from_model.translation / metres_per_millimetre;
  return {{"obj_id", object.obj_id},
          {"cam_R_m2c", rotation_rows(object.camera_from_model)},
          {"cam_t_m2c", {t.x, t.y, t.z}}};
}

void write_masks(const fs::path& folder, int id, const std::vector<BopObject>& objects) {
  for (std::size_t i = 0; i < objects.size(); ++i) {
    write_channel(folder / "mask" / mask_name(id, i), objects[i].silhouette);
    write_channel(folder / "mask_visib" / mask_name(id, i), objects[i].visible);
  }
}

Tree info_json(const BopObject& object, const Image<float>& depth_m) {
  int valid = 0;
  for (std::size_t i = 0; i < depth_m.values.size(); ++i)
    valid += object.silhouette.values[i] != 0 && std::isfinite(depth_m.values[i]);
  return bop_info(object.whole.value_or(extent_of(object.silhouette)), valid, extent_of(object.visible));
}

// Of all pictures; null where an object has no masks.
Tree info_json(const std::vector<BopPicture>& pictures) {
  Tree info = Tree::object();
  for (std::size_t id = 0; id < pictures.size(); ++id) {
    Tree& list = info[std::to_string(id)] = Tree::array();
    for (const BopObject& object : pictures[id].objects) {
      if (object.silhouette.values.empty() || object.visible.values.empty()) return nullptr;
      list.push_back(info_json(object, pictures[id].depth_m));
    }
  }
  return info;
}

}  // namespace

bool is_bop_scene(const fs::path& folder) {
  return fs::is_directory(folder) && fs::exists(folder / "scene_camera.json");
}

Rig read_bop_cameras(const fs::path& folder) {
  const fs::path file = folder / "scene_camera.json";
  const Tree tree = tree_of(file);
  Rig rig;
  for (NumberedCamera& numbered : cameras_of({&tree, file.string()}, folder))
    add_by_name(rig, std::move(numbered.camera));
  return rig;
}

std::vector<BopPicture> read_bop_scene(const fs::path& folder) {
  const fs::path file = folder / "scene_camera.json", poses_file = folder / "scene_gt.json";
  const fs::path info_file = folder / "scene_gt_info.json";
  const Tree tree = tree_of(file), poses = tree_or_none(poses_file), info = tree_or_none(info_file);
  const Place cameras{&tree, file.string()}, poses_by_picture{&poses, poses_file.string()},
      info_by_picture{&info, info_file.string()};
  std::vector<BopPicture> pictures;
  for (NumberedCamera& numbered : cameras_of(cameras, folder)) {
    const std::string key = std::to_string(numbered.id);
    const glm::ivec2 size = numbered.camera.intrinsics.size;
    BopPicture& picture = pictures.emplace_back(BopPicture{std::move(numbered.camera)});
    picture.depth_m = read_depth(picture_at(folder / "depth", numbered.id), size, cameras.at(key));
    picture.gray = read_channel<std::uint8_t>(picture_at(folder / "gray", numbered.id), size);
    if (!poses_by_picture.has(key.c_str())) continue;
    const Place objects = poses_by_picture.at(key);
    for (std::size_t i = 0; i < objects.size(); ++i)
      picture.objects.push_back(object_of(objects.at(i), folder, mask_name(numbered.id, i), size));
    if (!info_by_picture.has(key.c_str())) continue;
    for (std::size_t i = 0; i < objects.size(); ++i)
      picture.objects[i].whole = bop_whole(info_by_picture.at(key).at(i));
  }
  return pictures;
}

void write_bop_scene(const fs::path& folder, const std::vector<BopPicture>& pictures, Notes& notes) {
  Rig rig;
  for (const BopPicture& picture : pictures) rig.cameras.push_back(picture.camera);
  Tree cameras = json_tree(bop_text(rig, notes), "scene_camera.json"), poses = Tree::object();
  for (int id = 0; id < int(pictures.size()); ++id) {
    const BopPicture& picture = pictures[std::size_t(id)];
    const double scale = depth_scale_of(picture.depth_m);
    cameras[std::to_string(id)]["depth_scale"] = scale;
    write_channel(folder / "depth" / picture_name(id), depth_steps(picture.depth_m, scale));
    write_channel(folder / "gray" / picture_name(id), picture.gray);
    poses[std::to_string(id)] = Tree::array();
    for (const BopObject& object : picture.objects) poses[std::to_string(id)].push_back(pose_json(object));
    write_masks(folder, id, picture.objects);
  }
  write_file(folder / "scene_camera.json", cameras.dump(2) + "\n");
  write_file(folder / "scene_gt.json", poses.dump(2) + "\n");
  if (const Tree info = info_json(pictures); !info.is_null())
    write_file(folder / "scene_gt_info.json", info.dump(2) + "\n");
}

}  // namespace laterna
