#include "apps/lab/capture_writer.h"

#include "apps/lab/matrices.h"
#include "render/effects/apply_effects.h"
#include "sim/capture_folder.h"
#include "sim/error.h"
#include "sim/image_file.h"
#include "sim/parallel.h"
#include "sim/safe_write.h"
#include "sim/self_contained.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace laterna {

namespace {

void write_pictures(const std::filesystem::path& root, const CapturedStack& stack,
                    const std::vector<std::string>& names) {
  std::visit(
      [&](const auto& pictures) {
        using Value = typename std::decay_t<decltype(pictures)>::value_type;
        parallel_for(names.size(), [&](std::size_t k) {
          const PixelType type = sizeof(Value) == 1 ? PixelType::u8 : PixelType::u16;
          write_picture(root / names[k],
                        {pictures.picture(int(k)).data(), pictures.width, pictures.height, 1, type, {"Y"}});
        });
      },
      stack);
}

int count_of(const CapturedStack& stack) {
  return std::visit([](const auto& pictures) { return pictures.count; }, stack);
}

CaptureSequence describe(const Scene& scene, const View& view, const std::string& format, int pictures,
                         bool truth) {
  const Camera& camera = scene.cameras[view.camera];
  const Device& projector = scene.projectors[view.projector].device;
  CaptureSequence s;
  s.camera = camera.device.name;
  s.projector = projector.name;
  s.camera_size = camera.device.intrinsics.size;
  const PatternSequence patterns = pattern_sequence(scene, scene.projectors[view.projector]);
  s.projector_size = patterns.projector_size;
  s.patterns = patterns.parameters;
  s.bit_depth = camera.sensor.bit_depth;
  s.saturation_cd_per_m2 = view.saturation_cd_per_m2;
  if (camera.sensor.kind == SensorKind::emva1288)
    s.exposure_time_s = exposure_time_s(camera.sensor, view.saturation_cd_per_m2);
  for (int k = 0; k < pictures; ++k)
    s.pictures.push_back(fmt::format("{}/{}/{:02}.{}", s.camera, s.projector, k, format));
  if (truth) s.truth = fmt::format("truth/{}_{}.exr", s.camera, s.projector);
  return s;
}

}  // namespace

void write_truth(const std::filesystem::path& path, const Traced& traced, const View& view) {
  const std::vector<std::string> names{"projector.u", "projector.v", "projector.lit", "depth.m",
                                       "normal.x",    "normal.y",    "normal.z",      "world.x",
                                       "world.y",     "world.z",     "object.id"};
  const SurfaceMap& surface = traced.surfaces[view.camera];
  const LightMap& light = view.light;
  const PixelArray<glm::dvec3>& points = traced.points_world[view.camera];
  const PixelArray<glm::dvec3> normals = normals_world(surface, traced.rays);
  const std::size_t channels = names.size(), pixels = std::size_t(surface.width) * surface.height;
  std::vector<float> data(pixels * channels);
  parallel_for(std::size_t(surface.height), [&](std::size_t y) {
    for (std::size_t i = y * surface.width; i < (y + 1) * surface.width; ++i) {
      const glm::dvec3 n = normals.values[i], x = points.values[i];
      const double row[] = {light.u_px.values[i],
                            light.v_px.values[i],
                            double(light.lit(i)),
                            surface.depth_m.values[i],
                            n.x,
                            n.y,
                            n.z,
                            x.x,
                            x.y,
                            x.z,
                            surface.hit(i) ? double(surface.object.values[i]) : -1.0};
      for (std::size_t c = 0; c < channels; ++c) data[i * channels + c] = float(row[c]);
    }
  });
  write_picture(path, {data.data(), surface.width, surface.height, int(channels), PixelType::f32, names});
}

void write_capture(const SceneSpec& spec, const Scene& scene, const std::filesystem::path& folder,
                   const std::filesystem::path& target, const CaptureOptions& options, StageTimes& times,
                   const Progress& progress) {
  if (options.format != "png" && options.format != "tif" && options.format != "pgm") {
    throw InputError(fmt::format("--format: found \"{}\", expected png, tif or pgm", options.format));
  }
  PendingFolder pending(target);
  const std::filesystem::path root = pending.path();
  const Traced traced = trace(scene, times, progress);
  write_self_contained(spec, scene, folder, root);
  write_file(root / "matrices.json", matrices_json(scene).dump(2) + "\n");
  CaptureManifest manifest{"scene.toml", options.seed, "matrices.json", {}};
  if (options.truth) std::filesystem::create_directory(root / "truth");
  for (const View& view : traced.views) {
    const CapturedStack stack = capture_view(scene, traced, view, options.seed, times);
    const CaptureSequence sequence = describe(scene, view, options.format, count_of(stack), options.truth);
    if (progress) {
      progress(fmt::format(
          "writing {} pictures of \"{}\" by \"{}\", exposed so that {:.4g} cd/m² fill the scale",
          sequence.pictures.size(), sequence.projector, sequence.camera, view.saturation_cd_per_m2));
    }
    times.measure("write", [&] {
      std::filesystem::create_directories(root / sequence.camera / sequence.projector);
      write_pictures(root, stack, sequence.pictures);
      if (options.truth) write_truth(root / sequence.truth, traced, view);
    });
    manifest.sequences.push_back(sequence);
  }
  write_file(root / "manifest.json", manifest_json(manifest));
  pending.commit();
}

}  // namespace laterna
