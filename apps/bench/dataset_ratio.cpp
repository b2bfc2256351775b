#include "apps/bench/dataset_ratio.h"

#include "apps/bench/timing.h"
#include "apps/lab/dataset/dataset.h"
#include "sim/capture_folder.h"
#include "sim/image_file.h"
#include "sim/parallel.h"
#include "sim/safe_write.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <vector>

namespace laterna {

namespace {

namespace fs = std::filesystem;

constexpr const char* scene = R"(
[[mesh]]
shape = "relief"
shape_size = [1.4, 1.1, 0.2]
detail = 158
[[projector]]
size = [1024, 768]
throw_ratio = 1.4
position = [-0.2, 0, 1.6]
look_at = [0, 0, 0]
up = [0, 1, 0]
[[camera]]
size = [640, 480]
fov_x_deg = 40
position = [0.2, 0, 1.6]
look_at = [0, 0, 0]
up = [0, 1, 0]
sensor = { noise_sigma_dn = 1.5 }
[patterns]
kind = "gray"
)";

constexpr const char* specification = R"(
scene = "scene.toml"
tar_samples = 10
[random]
"mesh.seed" = { whole = [1, 1000] }
"camera.fov_x_deg" = { uniform = [35, 45] }
"projector.flux_lm" = { log_uniform = [100, 1000] }
)";

/// A folder that goes with this object.
struct Folder {
  fs::path path = fs::temp_directory_path() / fmt::format("laterna-bench-dataset-{}", ::getpid());
  Folder() {
    fs::remove_all(path);
    fs::create_directory(path);
    write_file(path / "scene.toml", scene);
    write_file(path / "spec.toml", specification);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

/// The seconds that the same pictures take, sample by sample in parallel as the data set does it.
double write_again(const fs::path& set, const fs::path& target, int samples) {
  std::vector<CapturedStack> stacks;
  std::vector<std::vector<fs::path>> files;
  for (int k = 0; k < samples; ++k) {
    const fs::path sample = set / "samples" / fmt::format("{:06}", k / 10) / fmt::format("{:08}", k);
    const CaptureSequence sequence = read_manifest(sample).sequences.at(0);
    stacks.push_back(read_pictures(sample, sequence));
    const fs::path folder = target / fmt::format("{:08}", k);
    fs::create_directories(folder);
    auto& names = files.emplace_back();
    for (const std::string& picture : sequence.pictures)
      names.push_back(folder / fs::path(picture).filename());
  }
  return seconds(
      [&] { parallel_for(stacks.size(), [&](std::size_t k) { write_stack(files[k], stacks[k]); }); });
}

}  // namespace

DatasetTimes time_dataset(int samples, int threads) {
  const Folder folder;
  const auto make = [&](const char* name, int of_threads) {
    set_thread_count(of_threads);
    return make_dataset(folder.path / "spec.toml", folder.path / name, {.count = std::uint64_t(samples)});
  };
  make("warm", threads);  // loads what is loaded on first use
  const DatasetOutcome one = make("one", 1), all = make("all", threads);
  const double write_s = write_again(folder.path / "all", folder.path / "again", samples);
  return {all.cost.wall_s / write_s, samples / one.cost.wall_s, samples / all.cost.wall_s,
          one.cost.cpu_s / samples, double(all.totals.bytes) / samples};
}

}  // namespace laterna
