#include "sim/formats/gltf.h"

#include "sim/error.h"

#include <fmt/format.h>

#include <cmath>

namespace laterna {

namespace {

const char* const block = "LATERNA_device";

Rigid parent_from_node(const Place& node) {
  if (node.has("matrix")) {
    const std::vector<double> m = node.at("matrix").numbers(16);
    return rigid_from_rotation_rows(
        std::vector<double>{m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10]}, {m[12], m[13], m[14]},
        node.name);
  }
  if (node.has("scale") && node.at("scale").numbers(3) != std::vector<double>{1, 1, 1})
    fail_at(node.at("scale"), "none: lengths would not be metres");
  Rigid motion;
  if (node.has("rotation")) {
    const std::vector<double> q = node.at("rotation").numbers(4);  // x, y, z, w
    motion = rigid_from_quaternion({q[3], q[0], q[1], q[2]}, {});
  }
  if (node.has("translation")) {
    const std::vector<double> t = node.at("translation").numbers(3);
    motion.translation = {t[0], t[1], t[2]};
  }
  return motion;
}

Device from_block(const Place& of) {
  Device device;
  device.intrinsics = {of.at("size").size_px(), of.at("fx").number(), of.at("fy").number(),
                       of.at("cx").number(), of.at("cy").number()};
  device.lens = {of.at("lens").at("model").text(), of.at("lens").at("parameters").numbers(0)};
  return device;
}

Device from_perspective(const Place& camera, glm::ivec2 size) {
  const Place perspective = camera.at("perspective");
  if (size.x == 0)
    throw InputError(
        fmt::format("{}: glTF does not say a picture's size, expected --camera-size WxH", camera.name));
  const double yfov = perspective.at("yfov").number();
  if (!(yfov > 0 && yfov < 3.14159)) fail_at(perspective.at("yfov"), "radians between 0 and pi");
  const double aspect =
      perspective.has("aspectRatio") ? perspective.at("aspectRatio").number() : double(size.x) / size.y;
  if (!(aspect > 0)) fail_at(perspective.at("aspectRatio"), "a number above 0");
  Device device;
  device.intrinsics = intrinsics_from_fov_y(size, yfov, aspect);
  return device;
}

class Reader {
 public:
  Reader(const Place& file, glm::ivec2 camera_size) : file_(file), camera_size_(camera_size) {}

  Rig read() {
    const std::size_t count = file_.has("nodes") ? file_.at("nodes").size() : 0;
    std::vector<bool> is_child(count, false);
    for (std::size_t i = 0; i < count; ++i)
      for (const std::size_t child : children_of(i, count)) {
        if (is_child[child]) throw InputError(fmt::format("{}: node {} has two parents", file_.name, child));
        is_child[child] = true;
      }
    for (std::size_t i = 0; i < count; ++i)
      if (!is_child[i]) visit_from(i, count);
    if (visited_ != count) throw InputError(file_.name + ": a node is its own parent");
    return std::move(rig_);
  }

 private:
  std::vector<std::size_t> children_of(std::size_t i, std::size_t count) const {
    std::vector<std::size_t> children;
    const Place node = file_.at("nodes").at(i);
    if (!node.has("children")) return children;
    for (const double child : node.at("children").numbers(0)) {
      if (!(child >= 0 && child < double(count))) fail_at(node.at("children"), "indices of nodes");
      children.push_back(std::size_t(child));
    }
    return children;
  }

  // Each node has one parent at most, so that a tree below a root is met once and ends.
  void visit_from(std::size_t root, std::size_t count) {
    std::vector<std::pair<std::size_t, Rigid>> open = {{root, Rigid{}}};
    while (!open.empty()) {
      const auto [i, world_from_parent] = open.back();
      open.pop_back();
      ++visited_;
      const Place node = file_.at("nodes").at(i);
      const Rigid world_from_node = compose(world_from_parent, parent_from_node(node));
      if (node.has("camera")) add(node, world_from_node, i);
      for (const std::size_t child : children_of(i, count)) open.emplace_back(child, world_from_node);
    }
  }

  void add(const Place& node, const Rigid& world_from_node, std::size_t i) {
    const int index = node.at("camera").whole_number();
    if (index < 0) fail_at(node.at("camera"), "the index of a camera");
    const Place camera = file_.at("cameras").at(std::size_t(index));
    if (camera.at("type").text() != "perspective") fail_at(camera.at("type"), "perspective");
    const bool ours = camera.has("extensions") && camera.at("extensions").has(block);
    Device device =
        ours ? from_block(camera.at("extensions").at(block)) : from_perspective(camera, camera_size_);
    device.name = node.has("name") ? node.at("name").text() : fmt::format("camera{}", i);
    device.device_from_world = compose(view_from_device(), inverse(world_from_node));
    if (!ours)
      add_by_name(rig_, std::move(device));
    else if (camera.at("extensions").at(block).at("kind").text() == "projector")
      rig_.projectors.push_back(std::move(device));
    else
      rig_.cameras.push_back(std::move(device));
  }

  Place file_;
  glm::ivec2 camera_size_;
  std::size_t visited_ = 0;
  Rig rig_;
};

Tree matrix_of_node(const Rigid& world_from_node) {
  Tree matrix = Tree::array();
  const glm::dmat4 m = matrix_of(world_from_node);
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) matrix.push_back(m[c][r]);
  return matrix;
}

Tree camera_json(const Device& d, const char* kind) {
  const Intrinsics& k = d.intrinsics;
  return {{"type", "perspective"},
          {"name", d.name},
          {"perspective",
           {{"yfov", 2 * std::atan(k.size.y / (2 * k.fy))},
            {"aspectRatio", (k.size.x / k.fx) / (k.size.y / k.fy)},
            {"znear", default_near_m}}},
          {"extensions",
           {{block,
             {{"kind", kind},
              {"size", {k.size.x, k.size.y}},
              {"fx", k.fx},
              {"fy", k.fy},
              {"cx", k.cx},
              {"cy", k.cy},
              {"lens", {{"model", d.lens.model}, {"parameters", d.lens.parameters}}}}}}}};
}

bool is_centred(const Intrinsics& k) {
  return std::abs(k.cx - (k.size.x - 1) / 2.0) < 1e-6 && std::abs(k.cy - (k.size.y - 1) / 2.0) < 1e-6;
}

}  // namespace

bool is_gltf(const Tree& tree) { return tree.is_object() && tree.contains("asset"); }

Rig parse_gltf(const std::string& text, glm::ivec2 camera_size, const std::string& file_name) {
  const Tree tree = json_tree(text, file_name);
  return Reader({&tree, file_name}, camera_size).read();
}

std::string gltf_text(const Rig& rig, Notes& notes) {
  Tree file = {{"asset", {{"version", "2.0"}, {"generator", "laterna"}}},
               {"extensionsUsed", {block}},
               {"scene", 0},
               {"cameras", Tree::array()},
               {"nodes", Tree::array()}};
  Tree roots = Tree::array();
  for (const Device& d : devices_of(rig)) {
    const bool projects = file["cameras"].size() >= rig.cameras.size();
    if (projects || !is_centred(d.intrinsics) || !is_pinhole(d.lens))
      notes.push_back(fmt::format("glTF holds no {}: of \"{}\" only the block {} tells",
                                  projects                    ? "projector"
                                  : !is_centred(d.intrinsics) ? "principal point"
                                                              : "lens",
                                  d.name, block));
    roots.push_back(file["nodes"].size());
    file["nodes"].push_back(
        {{"name", d.name},
         {"camera", file["cameras"].size()},
         {"matrix", matrix_of_node(compose(inverse(d.device_from_world), view_from_device()))}});
    file["cameras"].push_back(camera_json(d, projects ? "projector" : "camera"));
  }
  file["scenes"] = Tree::array({{{"nodes", roots}}});
  return file.dump(2) + "\n";
}

}  // namespace laterna
