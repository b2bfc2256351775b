#include "apps/lab/truth_picture.h"

#include "sim/formats/exr_camera.h"
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

void write_strip(const Scene& scene, const SceneRays& rig, const SurfaceMap& surface, const LightMap& light,
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

void write_truth(const std::filesystem::path& path, const Scene& given, const SceneRays& rig, int camera,
                 int projector) {
  const Scene& scene = rig.as_seen(given);
  const CameraRays& directions = rig.directions[camera];
  const int width = directions.width(), height = directions.height();
  const StripTracer tracer(scene, rig, camera, projector);
  std::vector<float> data(std::size_t(width) * height * layers().size());
  parallel_for(std::size_t(tracer.count()), [&](std::size_t row) {
    const Strip strip = tracer.trace(int(row));
    write_strip(scene, rig, strip.surface, strip.light,
                data.data() + row * tile_edge * std::size_t(width) * layers().size());
  });
  write_picture(path, {data.data(), width, height, int(layers().size()), PixelType::f32, layers(),
                       picture_camera(scene.cameras[camera].device)});
}

}  // namespace laterna
