#include "render/effects/rig_move.h"

#include "sim/rigid.h"

#include <algorithm>

namespace laterna {

bool moves(const Scene& scene, int camera, int projector) {
  const std::string& name = scene.timing.moved.device;
  return scene.effects.timing && !name.empty() &&
         (name == scene.cameras[camera].device.name || name == scene.projectors[projector].device.name);
}

Scene after_move(const Scene& scene) {
  Scene moved = scene;
  const RigMove& move = scene.timing.moved;
  const Rigid after_from_before = rigid_from_rotation_vector(move.rotation_vector_rad, move.translation);
  const auto apply_to = [&](Device& device) {
    if (device.name == move.device)
      device.device_from_world = compose(after_from_before, device.device_from_world);
  };
  for (Camera& camera : moved.cameras) apply_to(camera.device);
  for (Projector& projector : moved.projectors) apply_to(projector.device);
  moved.timing.moved = {};
  return moved;
}

void splice(CapturedStack& to, const CapturedStack& from, int first) {
  std::visit(
      [&](auto& pictures) {
        const auto& others = std::get<std::decay_t<decltype(pictures)>>(from);
        const auto offset = std::ptrdiff_t(std::size_t(first) * pictures.picture_size());
        std::copy(others.values.begin() + offset, others.values.end(), pictures.values.begin() + offset);
      },
      to);
}

}  // namespace laterna
