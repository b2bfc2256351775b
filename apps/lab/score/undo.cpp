#include "apps/lab/score/undo.h"

#include <algorithm>
#include <utility>

namespace laterna {

namespace {

using Edit = std::function<void(Device&)>;

std::function<ScoreRig(const ScoreRig&)> of_projector(const Edit& edit) {
  return [edit](ScoreRig rig) {
    edit(rig.projector);
    return rig;
  };
}

std::function<ScoreRig(const ScoreRig&)> of_all(const Edit& edit) {
  return [edit](ScoreRig rig) {
    edit(rig.projector);
    if (rig.camera) edit(*rig.camera);
    return rig;
  };
}

// Edits projector_from_camera; the camera stays where it is.
std::function<ScoreRig(const ScoreRig&)> of_pair(const std::function<Rigid(const Rigid&)>& edit) {
  return [edit](ScoreRig rig) {
    if (!rig.camera) return rig;
    Rigid& projector_from_world = rig.projector.device_from_world;
    const Rigid camera_from_world = rig.camera->device_from_world;
    const Rigid projector_from_camera = compose(projector_from_world, inverse(camera_from_world));
    projector_from_world = compose(edit(projector_from_camera), camera_from_world);
    return rig;
  };
}

Rigid transposed(const Rigid& m) { return {glm::transpose(m.rotation), m.translation}; }

Rigid transposed_in_place(const Rigid& device_from_world) {
  const glm::dmat3 rotation = glm::transpose(device_from_world.rotation);
  return {rotation, -(rotation * center_in_world(device_from_world))};
}

void exchange_size(Intrinsics& k) { std::swap(k.size.x, k.size.y); }
void exchange_centre(Intrinsics& k) { std::swap(k.cx, k.cy); }
void exchange_focal(Intrinsics& k) { std::swap(k.fx, k.fy); }

// Left-multiplies device_from_world by a linear map of the device frame.
void turn(Device& d, const glm::dmat3& new_from_old) {
  d.device_from_world = {new_from_old * d.device_from_world.rotation,
                         new_from_old * d.device_from_world.translation};
}

// Right-multiplies it by a linear map of the world.
void turn_world(Device& d, const glm::dmat3& old_from_new) {
  d.device_from_world.rotation = d.device_from_world.rotation * old_from_new;
}

glm::dmat3 signs(double x, double y, double z) { return {x, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, z}; }

void add_sizes(std::vector<Undo>& undos) {
  const auto add = [&](const Edit& edit) { undos.push_back({"size_swapped", of_projector(edit)}); };
  add([](Device& d) { exchange_size(d.intrinsics); });
  add([](Device& d) { exchange_size(d.intrinsics), exchange_centre(d.intrinsics); });
  add([](Device& d) {
    exchange_size(d.intrinsics), exchange_centre(d.intrinsics), exchange_focal(d.intrinsics);
  });
  add([](Device& d) { exchange_centre(d.intrinsics); });
  add([](Device& d) { exchange_centre(d.intrinsics), exchange_focal(d.intrinsics); });
  const Edit to_middle = [](Device& d) {
    const double half = (d.intrinsics.size.x - d.intrinsics.size.y) / 2.0;
    d.intrinsics.cx += half, d.intrinsics.cy -= half;
  };
  add(to_middle);
  add([to_middle](Device& d) { exchange_size(d.intrinsics), to_middle(d); });
}

void add_half_pixels(std::vector<Undo>& undos) {
  for (const double du : {-0.5, 0.0, 0.5}) {
    for (const double dv : {-0.5, 0.0, 0.5}) {
      if (du == 0 && dv == 0) continue;
      undos.push_back(
          {"half_pixel", of_projector([=](Device& d) { d.intrinsics.cx += du, d.intrinsics.cy += dv; })});
    }
  }
}

void add_flips(glm::ivec2 size, std::vector<Undo>& undos) {
  const auto add = [&](const Edit& edit) { undos.push_back({"y_flipped", of_all(edit)}); };
  const auto add_projector = [&](const Edit& edit) { undos.push_back({"y_flipped", of_projector(edit)}); };
  const auto flipped = [h = size.y](const glm::dvec2& pixel) { return glm::dvec2(pixel.x, h - 1 - pixel.y); };
  const glm::dmat3 opengl = signs(1, -1, -1), mirror = signs(1, -1, 1), behind = signs(-1, -1, -1);
  for (const glm::dmat3& before : {glm::dmat3(1), behind}) {
    add_projector([=](Device& d) { turn(d, before); });
    undos.back().pixel = flipped;
  }
  for (const int edge : {1, 0})
    add_projector([edge](Device& d) { d.intrinsics.cy = d.intrinsics.size.y - edge - d.intrinsics.cy; });
  add_projector([=](Device& d) { turn(d, opengl); });
  add_projector([=](Device& d) { turn(d, mirror); });
  add([=](Device& d) { turn(d, opengl); });
  add([=](Device& d) { turn_world(d, opengl); });
  add([=](Device& d) { turn_world(d, mirror); });
  add([=](Device& d) { turn(d, opengl), turn_world(d, opengl); });
  add([=](Device& d) { turn(d, mirror), turn_world(d, mirror); });
}

void add_poses(std::vector<Undo>& undos) {
  const auto add = [&](const char* name, const std::function<Rigid(const Rigid&)>& edit) {
    const Edit of_device = [edit](Device& d) { d.device_from_world = edit(d.device_from_world); };
    undos.push_back({name, of_projector(of_device)});
    undos.push_back({name, of_all(of_device)});
    undos.push_back({name, of_pair(edit)});
  };
  add("inverse_pose", [](const Rigid& m) { return inverse(m); });
  add("rotation_transposed", transposed);
  add("rotation_transposed", transposed_in_place);
  for (const double unit : {1e-3, 1e3, 1e-2, 1e2, 0.0254, 1 / 0.0254, 0.3048, 1 / 0.3048})
    add("unit_scale", [unit](const Rigid& m) { return Rigid{m.rotation, m.translation * unit}; });
}

void add_exchanges(glm::ivec2 size, std::vector<Undo>& undos) {
  const auto exchange = [](const glm::dvec2& pixel) { return glm::dvec2(pixel.y, pixel.x); };
  const glm::dmat3 rows(glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1));
  const auto add = [&](const glm::dmat3& turned, bool moves_pixels) {
    undos.push_back({"axes_exchanged", of_projector([=](Device& d) {
                       d.intrinsics.size = size;
                       if (!moves_pixels) exchange_focal(d.intrinsics), exchange_centre(d.intrinsics);
                       turn(d, turned);
                     })});
    if (moves_pixels) undos.back().pixel = exchange;
  };
  add(glm::dmat3(1.0), true);
  add(signs(-1, -1, -1), true);        // a proper rotation that has every point behind
  add(rows, false);                    // the pose exchanged, the centre too
  add(rows * signs(1, 1, -1), false);  // the same, made proper by z
  add(rows * signs(-1, 1, 1), false);  // a quarter turn
  add(rows * signs(1, -1, 1), false);
  undos.push_back({"axes_exchanged", of_projector([=](Device& d) { turn(d, rows); })});  // the pose alone
}

}  // namespace

void undo_pixels(const Undo& undo, std::vector<glm::dvec2>& pixels) {
  if (undo.pixel) std::transform(pixels.begin(), pixels.end(), pixels.begin(), undo.pixel);
}

std::vector<Undo> undoings(glm::ivec2 size) {
  std::vector<Undo> undos;
  add_sizes(undos);
  add_half_pixels(undos);
  add_flips(size, undos);
  add_poses(undos);
  add_exchanges(size, undos);
  return undos;
}

}  // namespace laterna
