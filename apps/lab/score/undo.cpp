#include "apps/lab/score/undo.h"

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

void add_sizes(glm::ivec2 size, std::vector<Undo>& undos) {
  const auto add = [&](const Edit& edit) { undos.push_back({"size_swapped", of_projector(edit)}); };
  add([](Device& d) { exchange_size(d.intrinsics); });
  add([](Device& d) { exchange_size(d.intrinsics), exchange_centre(d.intrinsics); });
  add([](Device& d) {
    exchange_size(d.intrinsics), exchange_centre(d.intrinsics), exchange_focal(d.intrinsics);
  });
  add([](Device& d) { exchange_centre(d.intrinsics); });
  add([](Device& d) { exchange_centre(d.intrinsics), exchange_focal(d.intrinsics); });
  const double half = (size.x - size.y) / 2.0;
  add([half](Device& d) { d.intrinsics.cx += half, d.intrinsics.cy -= half; });
  add([half](Device& d) {
    exchange_size(d.intrinsics);
    d.intrinsics.cx += half, d.intrinsics.cy -= half;
  });
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
  undos.push_back({"y_flipped", of_projector([](Device&) {}),
                   [h = size.y](const glm::dvec2& pixel) { return glm::dvec2(pixel.x, h - 1 - pixel.y); }});
  for (const double rows : {size.y - 1.0, double(size.y)})
    undos.push_back(
        {"y_flipped", of_projector([rows](Device& d) { d.intrinsics.cy = rows - d.intrinsics.cy; })});
  const glm::dmat3 opengl = signs(1, -1, -1), mirror = signs(1, -1, 1);
  undos.push_back({"y_flipped", of_projector([=](Device& d) { turn(d, opengl); })});
  undos.push_back({"y_flipped", of_projector([=](Device& d) { turn(d, mirror); })});
  add([=](Device& d) { turn(d, opengl); });
  add([=](Device& d) { turn_world(d, opengl); });
  add([=](Device& d) { turn_world(d, mirror); });
  add([=](Device& d) { turn(d, opengl), turn_world(d, opengl); });
  add([=](Device& d) { turn(d, mirror), turn_world(d, mirror); });
}

void add_poses(std::vector<Undo>& undos) {
  const auto add = [&](const char* name, const Edit& edit) {
    undos.push_back({name, of_projector(edit)});
    undos.push_back({name, of_all(edit)});
  };
  add("inverse_pose", [](Device& d) { d.device_from_world = inverse(d.device_from_world); });
  add("rotation_transposed",
      [](Device& d) { d.device_from_world.rotation = glm::transpose(d.device_from_world.rotation); });
  add("rotation_transposed", [](Device& d) {
    const glm::dvec3 centre_world = center_in_world(d.device_from_world);
    const glm::dmat3 rotation = glm::transpose(d.device_from_world.rotation);
    d.device_from_world = {rotation, -(rotation * centre_world)};
  });
  for (const double unit : {1e-3, 1e3, 1e-2, 1e2, 0.0254, 1 / 0.0254, 0.3048, 1 / 0.3048})
    add("unit_scale", [unit](Device& d) { d.device_from_world.translation *= unit; });
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

std::vector<Undo> undoings(glm::ivec2 size) {
  std::vector<Undo> undos;
  add_sizes(size, undos);
  add_half_pixels(undos);
  add_flips(size, undos);
  add_poses(undos);
  add_exchanges(size, undos);
  return undos;
}

}  // namespace laterna
