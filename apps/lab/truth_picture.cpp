#include "apps/lab/truth_picture.h"

#include "render/effects/apply_effects.h"
#include "sim/image_file.h"
#include "sim/parallel.h"

#include <string>

namespace laterna {

namespace {

const std::vector<std::string>& layers() {
  static const std::vector<std::string> names{"projector.u", "projector.v", "projector.lit", "depth.m",
                                              "normal.x",    "normal.y",    "normal.z",      "world.x",
                                              "world.y",     "world.z",     "object.id"};
  return names;
}

void write_strip(const Scene& scene, const Rig& rig, const SurfaceMap& surface, const LightMap& light,
                 float* to) {
  const PixelArray<glm::dvec3> points = points_world(surface, scene),
                               normals = normals_world(surface, rig.rays);
  for (std::size_t i = 0; i < points.values.size(); ++i) {
    const glm::dvec3 n = normals.values[i], x = points.values[i];
    for (const double value :
         {light.u_px.values[i], light.v_px.values[i], double(light.lit(i)), surface.depth_m.values[i], n.x,
          n.y, n.z, x.x, x.y, x.z, surface.hit(i) ? double(surface.object.values[i]) : -1.0})
      *to++ = float(value);
  }
}

}  // namespace

void write_truth(const std::filesystem::path& path, const Scene& scene, const Rig& rig, int camera,
                 int projector) {
  const CameraRays& directions = rig.directions[camera];
  const int width = directions.width(), height = directions.height();
  const CameraView eye = make_camera_view(rig.rays, scene, scene.cameras[camera]);
  const ProjectorView source = make_projector_view(rig.rays, scene, scene.projectors[projector]);
  std::vector<float> data(std::size_t(width) * height * layers().size());
  parallel_for((height + tile_edge - 1) / tile_edge, [&](std::size_t tile_row) {
    const int y = int(tile_row) * tile_edge;
    SurfaceMap surface = make_surface_map({0, y, width, std::min(tile_edge, height - y)});
    LightMap light = make_light_map(surface.width, surface.height);
    trace_surface_tiles(rig.rays, eye, directions, 0, surface);
    trace_light_tiles(rig.rays, source, surface, 0, light);
    apply_light_effects(light, surface, rig.rays, scene, scene.projectors[projector], scene.cameras[camera]);
    write_strip(scene, rig, surface, light, data.data() + std::size_t(y) * width * layers().size());
  });
  write_picture(path, {data.data(), width, height, int(layers().size()), PixelType::f32, layers()});
}

}  // namespace laterna
