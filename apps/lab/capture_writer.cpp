#include "apps/lab/capture_writer.h"

#include "apps/lab/capture_warnings.h"
#include "apps/lab/matrices.h"
#include "apps/lab/truth_picture.h"
#include "render/effects/scaler.h"
#include "render/trace_rows.h"
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

CaptureSequence describe(const Scene& scene, int camera_index, int projector_index,
                         double saturation_cd_per_m2, const CaptureOptions& options, int pictures) {
  const Camera& camera = scene.cameras[camera_index];
  const Device& projector = scene.projectors[projector_index].device;
  CaptureSequence s;
  s.camera = camera.device.name;
  s.projector = projector.name;
  s.camera_size = camera.device.intrinsics.size;
  s.projector_size = input_size(scene.effects, scene.projectors[projector_index]);
  s.bit_depth = camera.sensor.bit_depth;
  s.saturation_cd_per_m2 = saturation_cd_per_m2;
  if (camera.sensor.kind == SensorKind::emva1288)
    s.exposure_time_s = exposure_time_s(camera.sensor, saturation_cd_per_m2);
  for (int k = 0; k < pictures; ++k)
    s.pictures.push_back(fmt::format("{}/{}/{:02}.{}", s.camera, s.projector, k, options.format));
  if (options.truth) s.truth = fmt::format("truth/{}_{}.exr", s.camera, s.projector);
  return s;
}

// One view to disk. The pictures are gone before the truth is made.
CaptureSequence write_view(const Scene& scene, const Rig& rig, int camera, int projector,
                           const std::filesystem::path& root, const CaptureOptions& options,
                           StageTimes& times, const Progress& progress) {
  const double saturation = saturation_cd_per_m2(scene, rig, camera, projector, times);
  CaptureSequence sequence;
  {
    const CapturedStack stack =
        capture_rows(scene, camera, projector,
                     rig_rows(scene, rig, camera, projector, samples_of(scene, camera, options.seed)),
                     saturation, options.seed, times);
    sequence = describe(scene, camera, projector, saturation, options, count_of(stack));
    if (progress) {
      progress(
          fmt::format("writing {} pictures of \"{}\" by \"{}\", exposed so that {:.4g} cd/m² fill the scale",
                      sequence.pictures.size(), sequence.projector, sequence.camera, saturation));
    }
    times.measure("write", [&] {
      std::filesystem::create_directories(root / sequence.camera / sequence.projector);
      write_pictures(root, stack, sequence.pictures);
    });
  }
  if (options.truth)
    times.measure("truth", [&] { write_truth(root / sequence.truth, scene, rig, camera, projector); });
  return sequence;
}

}  // namespace

std::vector<std::string> write_capture(const SceneSpec& spec, const Scene& scene,
                                       const std::filesystem::path& folder,
                                       const std::filesystem::path& target, const CaptureOptions& options,
                                       StageTimes& times, const Progress& progress) {
  if (options.format != "png" && options.format != "tif" && options.format != "pgm") {
    throw InputError(fmt::format("--format: found \"{}\", expected png, tif or pgm", options.format));
  }
  PendingFolder pending(target);
  const std::filesystem::path root = pending.path();
  const Rig rig = make_rig(scene, times);
  const std::vector<std::string> warnings = capture_warnings(scene, rig);
  for (const std::string& warning : warnings)
    if (progress) progress(warning);
  write_self_contained(spec, scene, folder, root);
  write_file(root / "matrices.json", matrices_json(scene).dump(2) + "\n");
  CaptureManifest manifest{"scene.toml", options.seed, "matrices.json", {}};
  if (options.truth) std::filesystem::create_directory(root / "truth");
  for (int camera = 0; camera < int(scene.cameras.size()); ++camera)
    for (int projector = 0; projector < int(scene.projectors.size()); ++projector)
      manifest.sequences.push_back(write_view(scene, rig, camera, projector, root, options, times, progress));
  write_file(root / "manifest.json", manifest_json(manifest));
  pending.commit();
  return warnings;
}

}  // namespace laterna
