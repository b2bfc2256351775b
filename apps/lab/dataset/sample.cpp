#include "apps/lab/dataset/sample.h"

#include "apps/lab/capture_writer.h"
#include "apps/lab/dataset/dataset_folder.h"
#include "apps/lab/dataset/npy.h"
#include "apps/lab/dataset/sample_maps.h"
#include "sim/error.h"
#include "sim/image_file.h"
#include "sim/safe_write.h"
#include "sim/scene_build.h"

#include <fmt/format.h>

namespace laterna {

namespace {

namespace fs = std::filesystem;

/// A drawn scene that was traced, not exposed.
struct Attempt {
  DrawnSample sample;
  std::unique_ptr<const Scene> scene;  // what `traced` was made from
  Traced traced;
};

Attempt attempt_at(const DatasetSpec& spec, DrawnSample sample) {
  auto scene = std::make_unique<const Scene>(build_scene(sample.spec, spec.scene_file.parent_path()));
  StageTimes times;
  Traced traced = trace_maps(*scene, times);
  sample.sights.clear();
  for (const View& view : traced.views) sample.sights.push_back(sight_of(*scene, traced, view));
  return {std::move(sample), std::move(scene), std::move(traced)};
}

std::string counts_text(const std::map<std::string, int>& rejected) {
  std::string text;
  for (const auto& [reason, count] : rejected)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", reason, count);
  return text;
}

Attempt draw_sample(const DatasetSpec& spec, std::uint64_t seed, std::uint64_t index) {
  DrawnSample sample;
  sample.key = sample_key(index), sample.seed = seed, sample.index = index;
  for (int k = 0; k < spec.reject.tries; ++k) {
    sample.drawn = draw_values(spec, seed, index, std::uint64_t(k));
    sample.spec = with_names(scene_of(spec, sample.drawn));
    if (sample.spec.meshes.empty()) {
      ++sample.rejected["nothing_seen"];
      continue;
    }
    Attempt attempt = attempt_at(spec, sample);
    const std::string reason = rejection(attempt.sample.sights, spec.reject);
    if (reason.empty()) {
      // 63 bits: a scene's and a command's seed are whole numbers of TOML and JSON.
      attempt.sample.capture_seed = RandomStream(seed, index, std::uint64_t(k), "capture").bits() >> 1;
      return attempt;
    }
    ++sample.rejected[reason];
  }
  throw InputError(
      fmt::format("all of {} attempts thrown away ({}), expected distributions of rigs that see more",
                  spec.reject.tries, counts_text(sample.rejected)));
}

void write_maps(const Attempt& attempt, const View& view, const CapturedStack& pictures, int step_px,
                const fs::path& root) {
  const Scene& scene = *attempt.scene;
  const std::string &camera = scene.cameras[view.camera].device.name,
                    &projector = scene.projectors[view.projector].device.name;
  const std::size_t height = std::size_t(view.light.height), width = std::size_t(view.light.width);
  write_npy(root / truth_file(camera, projector), truth_map(attempt.traced, view),
            {height, width, truth_channels.size()});
  const std::vector<float> rows = correspondences(scene, view, pictures, step_px);
  write_picture(root / mask_file(camera, projector), both_see_mask(view.light));
  write_npy(root / correspondence_file(camera, projector), rows,
            {rows.size() / correspondence_columns.size(), correspondence_columns.size()});
}

void fill_sample(const DatasetSpec& spec, Attempt& attempt, const fs::path& root) {
  const Scene& scene = *attempt.scene;
  for (const char* folder : {"truth", "mask", "correspondences"}) make_folders(root / folder);
  CaptureOptions options{.seed = attempt.sample.capture_seed, .format = spec.settings.format, .truth = false};
  options.on_view = [&](int camera, int projector, const CapturedStack& pictures) {
    write_maps(attempt, attempt.traced.view(camera, projector), pictures,
               spec.settings.correspondence_step_px, root);
  };
  StageTimes times;
  expose_views(scene, attempt.traced, times);
  const CaptureManifest manifest = fill_capture(attempt.sample.spec, scene, attempt.traced,
                                                spec.scene_file.parent_path(), root, options, times);
  write_file(root / "sample.json", sample_record(attempt.sample, scene, manifest).dump(1) + "\n");
}

}  // namespace

void make_sample(const DatasetSpec& spec, std::uint64_t seed, std::uint64_t index, const fs::path& target) {
  try {
    Attempt attempt = draw_sample(spec, seed, index);
    make_folders(target.parent_path());
    PendingFolder pending(target);
    fill_sample(spec, attempt, pending.path());
    pending.commit();
  } catch (const InputError& error) {
    throw InputError(fmt::format("sample {}: {}", sample_key(index), error.what()));
  } catch (const fs::filesystem_error& error) {
    throw InputError(
        fmt::format("sample {}: {}: {}", sample_key(index), error.path1().string(), error.code().message()));
  }
}

}  // namespace laterna
