#include "apps/lab/score/cloud_undo.h"

#include <utility>

namespace laterna {

namespace {

// x_right = linear·x_told.
struct Map {
  std::vector<std::string> suspects;
  glm::dmat3 linear{1.0};
};

glm::dmat3 diagonal(double x, double y, double z) { return {x, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, z}; }

std::vector<Map> maps() {
  const std::vector<Map> flips{
      {{}, glm::dmat3(1.0)}, {{"y_flipped"}, diagonal(1, -1, -1)}, {{"y_flipped"}, diagonal(1, -1, 1)}};
  std::vector<Map> all = flips;
  for (const double unit : {1e-3, 1e3, 1e-2, 1e2, 0.0254, 1 / 0.0254, 0.3048, 1 / 0.3048})
    for (const Map& flip : flips) {
      all.push_back({{"unit_scale"}, unit * flip.linear});
      all.back().suspects.insert(all.back().suspects.end(), flip.suspects.begin(), flip.suspects.end());
    }
  return all;
}

void add_pixels(glm::ivec2 camera_size, glm::ivec2 projector_size, std::vector<CloudUndo>& undos) {
  undos.push_back(
      {{"y_flipped"}, "", [h = camera_size.y](CloudPoint& p) { p.camera_px.y = h - 1 - p.camera_px.y; }});
  undos.push_back({{"y_flipped"}, "", [h = projector_size.y](CloudPoint& p) {
                     p.projector_px.y = h - 1 - p.projector_px.y;
                   }});
  undos.push_back(
      {{"axes_exchanged"}, "", [](CloudPoint& p) { std::swap(p.projector_px.x, p.projector_px.y); }});
  for (const double du : {-0.5, 0.0, 0.5})
    for (const double dv : {-0.5, 0.0, 0.5})
      if (du != 0 || dv != 0)
        undos.push_back({{"half_pixel"}, "", [=](CloudPoint& p) { p.projector_px += glm::dvec2(du, dv); }});
}

std::vector<const Device*> devices_of(const Scene& scene) {
  std::vector<const Device*> devices;
  for (const Camera& camera : scene.cameras) devices.push_back(&camera.device);
  for (const Projector& projector : scene.projectors) devices.push_back(&projector.device);
  return devices;
}

}  // namespace

std::vector<CloudUndo> cloud_undoings(const Scene& scene, glm::ivec2 camera_size, glm::ivec2 projector_size,
                                      bool any_frame) {
  std::vector<CloudUndo> undos;
  for (const Map& map : maps()) {
    if (!map.suspects.empty())
      undos.push_back({map.suspects, "", [map](CloudPoint& p) { p.x_world = map.linear * p.x_world; }});
    if (!any_frame) continue;
    for (const Device* device : devices_of(scene))
      undos.push_back({map.suspects, device->name,
                       [map, world_from_device = inverse(device->device_from_world)](CloudPoint& p) {
                         p.x_world = apply(world_from_device, map.linear * p.x_world);
                       }});
  }
  for (const Device* device : devices_of(scene)) {
    const Rigid back = inverse(device->device_from_world);
    undos.push_back({{"inverse_pose"}, "", [twice = compose(back, back)](CloudPoint& p) {
                       p.x_world = apply(twice, p.x_world);
                     }});
  }
  add_pixels(camera_size, projector_size, undos);
  return undos;
}

}  // namespace laterna
