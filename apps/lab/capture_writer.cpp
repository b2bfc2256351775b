#include "apps/lab/capture_writer.h"

#include "apps/lab/board_places.h"
#include "apps/lab/capture_warnings.h"
#include "apps/lab/matrices.h"
#include "apps/lab/truth_picture.h"
#include "render/effects/apply_effects.h"
#include "render/trace_rows.h"
#include "sim/capture_folder.h"
#include "sim/error.h"
#include "sim/image_file.h"
#include "sim/parallel.h"
#include "sim/safe_write.h"
#include "sim/scene_build.h"
#include "sim/self_contained.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>

namespace laterna {

namespace {

constexpr std::array formats{"png", "tif", "pgm", "exr", "tif-pages"};

/// The files of one sequence, relative to the folder.
std::vector<std::string> file_names(const std::string& folder, const std::string& format, int pictures) {
  if (format == "tif-pages") return {folder + "/pages.tif"};
  std::vector<std::string> names;
  for (int k = 0; k < pictures; ++k) names.push_back(fmt::format("{}/{:02}.{}", folder, k, format));
  return names;
}

void write_pictures(const std::filesystem::path& root, const CapturedStack& stack,
                    const std::vector<std::string>& names) {
  std::vector<std::filesystem::path> files;
  for (const std::string& name : names) files.push_back(root / name);
  write_stack(files, stack);
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
  const PatternSequence patterns = pattern_sequence(scene, scene.projectors[projector_index]);
  s.projector_size = patterns.projector_size;
  s.patterns = patterns.parameters;
  s.bit_depth = camera.sensor.bit_depth;
  s.saturation_cd_per_m2 = saturation_cd_per_m2;
  if (camera.sensor.kind == SensorKind::emva1288)
    s.exposure_time_s = exposure_time_s(camera.sensor, saturation_cd_per_m2);
  s.pictures = file_names(s.camera + "/" + s.projector, options.format, pictures);
  if (options.truth) s.truth = fmt::format("truth/{}_{}.exr", s.camera, s.projector);
  return s;
}

// Pictures of less than that are written beside the truth, larger ones before it: memory holds one of the
// two.
constexpr std::size_t small_stack_bytes = std::size_t{128} << 20;

std::size_t bytes_of(const CapturedStack& stack) {
  return std::visit([](const auto& s) { return s.values.size() * sizeof(s.values[0]); }, stack);
}

// What a view is captured from.
struct ViewRows {
  double saturation_cd_per_m2;
  ImageRows rows;
};
using RowsOfView = std::function<ViewRows(int camera, int projector)>;

// One view to disk.
CaptureSequence write_view(const Scene& scene, const SceneRays& rig, int camera, int projector,
                           const RowsOfView& rows_of, const std::filesystem::path& root,
                           const CaptureOptions& options, StageTimes& times, const Progress& progress) {
  const auto [saturation, rows] = rows_of(camera, projector);
  CapturedStack stack = capture_rows(scene, camera, projector, rows, saturation, options.seed, times);
  CaptureSequence sequence = describe(scene, camera, projector, saturation, options, count_of(stack));
  if (progress) {
    progress(
        fmt::format("writing {} pictures of \"{}\" by \"{}\", exposed so that {:.4g} cd/m² fill the scale",
                    count_of(stack), sequence.projector, sequence.camera, saturation));
  }
  if (options.on_view) options.on_view(camera, projector, stack);
  std::filesystem::create_directories(root / sequence.camera / sequence.projector);
  const auto write = [&](bool pictures, bool truth) {
    parallel_for(2, [&](std::size_t part) {
      if (part == 0 && pictures) write_pictures(root, stack, sequence.pictures);
      if (part == 1 && truth) write_truth(root / sequence.truth, scene, rig, camera, projector);
    });
  };
  times.measure("write", [&] {
    if (bytes_of(stack) <= small_stack_bytes) return write(true, options.truth);
    write(true, false);
    stack = {};
    write(false, options.truth);
  });
  return sequence;
}

CaptureManifest fill(const SceneSpec& spec, const Scene& scene, const SceneRays& rig,
                     const RowsOfView& rows_of, const std::filesystem::path& folder,
                     const std::filesystem::path& root, const CaptureOptions& options, StageTimes& times,
                     const Progress& progress) {
  check_format(options.format, scene);
  write_self_contained(spec, scene, folder, root);
  write_file(root / "matrices.json", matrices_json(scene).dump(2) + "\n");
  CaptureManifest manifest{"scene.toml", options.seed, "matrices.json", {}};
  if (options.truth) std::filesystem::create_directory(root / "truth");
  for (int camera = 0; camera < int(scene.cameras.size()); ++camera)
    for (int projector = 0; projector < int(scene.projectors.size()); ++projector)
      manifest.sequences.push_back(
          write_view(scene, rig, camera, projector, rows_of, root, options, times, progress));
  write_file(root / "manifest.json", manifest_json(manifest));
  return manifest;
}

}  // namespace

void check_format(const std::string& format, const Scene& scene, const std::string& place) {
  if (std::find(formats.begin(), formats.end(), format) == formats.end())
    throw InputError(fmt::format("{}: found \"{}\", expected {}", place, format, fmt::join(formats, ", ")));
  for (const Camera& camera : scene.cameras) {
    if (format == "pgm" && camera.sensor.bit_depth > 8)
      throw InputError(fmt::format("{}: pgm holds 8 bits, but camera \"{}\" has {}; expected another format",
                                   place, camera.device.name, camera.sensor.bit_depth));
  }
}

CaptureManifest fill_capture(const SceneSpec& spec, const Scene& scene, const SceneRays& rig,
                             const std::filesystem::path& folder, const std::filesystem::path& root,
                             const CaptureOptions& options, StageTimes& times, const Progress& progress) {
  const RowsOfView rows_of = [&](int camera, int projector) -> ViewRows {
    return {saturation_cd_per_m2(scene, rig, camera, projector, times),
            rig_rows(scene, rig, camera, projector, samples_of(scene, camera, options.seed))};
  };
  return fill(spec, scene, rig, rows_of, folder, root, options, times, progress);
}

CaptureManifest fill_capture(const SceneSpec& spec, const Scene& scene, const Traced& traced,
                             const std::filesystem::path& folder, const std::filesystem::path& root,
                             const CaptureOptions& options, StageTimes& times, const Progress& progress) {
  const RowsOfView rows_of = [&](int camera, int projector) -> ViewRows {
    const View& view = traced.view(camera, projector);
    return {view.saturation_cd_per_m2, view_rows(scene, traced, view, options.seed)};
  };
  return fill(spec, scene, traced, rows_of, folder, root, options, times, progress);
}

std::vector<std::string> write_capture(const SceneSpec& spec, const Scene& scene,
                                       const std::filesystem::path& folder,
                                       const std::filesystem::path& target, const CaptureOptions& options,
                                       StageTimes& times, const Progress& progress) {
  check_format(options.format, scene);
  PendingFolder pending(target);
  const SceneRays rig = make_rig(scene, times);
  std::vector<std::string> warnings = capture_warnings(scene, rig);
  for (const std::string& warning : warnings)
    if (progress) progress(warning);
  fill_capture(spec, scene, rig, folder, pending.path(), options, times, progress);
  pending.commit();
  return warnings;
}

std::vector<std::string> write_board_captures(const SceneSpec& spec, const std::filesystem::path& folder,
                                              const std::filesystem::path& target, int places,
                                              const CaptureOptions& options, StageTimes& times,
                                              const Progress& progress) {
  const std::vector<SceneSpec> scenes = board_places(spec, folder, {.count = places}, options.seed);
  PendingFolder pending(target);
  std::vector<std::string> warnings;
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    CaptureOptions one = options;
    one.seed += k;
    const std::string name = fmt::format("place_{:02}", k);
    if (progress) progress(name);
    const std::vector<std::string> said = write_capture(scenes[k], build_scene(scenes[k], folder), folder,
                                                        pending.path() / name, one, times, progress);
    for (const std::string& warning : said) warnings.push_back(fmt::format("{}: {}", name, warning));
  }
  pending.commit();
  return warnings;
}

}  // namespace laterna
