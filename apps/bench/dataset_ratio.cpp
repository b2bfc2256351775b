#include "apps/bench/dataset_ratio.h"

#include "apps/bench/timing.h"
#include "apps/lab/dataset/dataset.h"
#include "apps/lab/keep_memory.h"
#include "sim/capture_folder.h"
#include "sim/image_file.h"
#include "sim/parallel.h"
#include "sim/safe_write.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>
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

/// The pictures of one sample, read back.
struct Pictures {
  std::string key;
  CaptureSequence sequence;
  CapturedStack stack;
};

std::vector<Pictures> read_samples(const fs::path& set, int first, int count) {
  std::vector<Pictures> samples;
  for (int k = first; k < first + count; ++k) {
    const std::string key = fmt::format("{:08}", k);
    const fs::path sample = set / "samples" / fmt::format("{:06}", k / 10) / key;
    const CaptureSequence sequence = read_manifest(sample).sequences.at(0);
    samples.push_back({key, sequence, read_pictures(sample, sequence)});
  }
  return samples;
}

void write_sample(const Pictures& pictures, const fs::path& target) {
  PendingFolder pending(target / pictures.key);
  std::vector<fs::path> files;
  for (const std::string& picture : pictures.sequence.pictures) files.push_back(pending.path() / picture);
  fs::create_directories(files[0].parent_path());
  write_stack(files, pictures.stack);
  pending.commit();
}

/// The seconds that the same pictures take, written as the data set writes them: sample by sample in
/// parallel, each in a folder that appears whole.
double write_again(const fs::path& set, const fs::path& target, int samples) {
  constexpr int held = 32;  // pictures of so many samples are in memory at once
  fs::create_directory(target);
  double sum_s = 0;
  for (int first = 0; first < samples; first += held) {
    const std::vector<Pictures> some = read_samples(set, first, std::min(held, samples - first));
    sum_s +=
        seconds([&] { parallel_for(some.size(), [&](std::size_t k) { write_sample(some[k], target); }); });
  }
  return sum_s;
}

}  // namespace

DatasetTimes time_dataset(int samples, int threads) {
  keep_freed_memory();  // as the command does; for the yardstick too
  const Folder folder;
  const auto make = [&](const char* name, int of_threads) {
    set_thread_count(of_threads);
    return make_dataset(folder.path / "spec.toml", folder.path / name, {.count = std::uint64_t(samples)});
  };
  make("warm", threads);  // loads what is loaded on first use
  const DatasetOutcome one = make("one", 1);
  std::vector<double> ratios, rates;
  for (int round = 0; round < 3; ++round) {  // in turn: the machine's speed drifts
    const DatasetOutcome all = make("all", threads);
    ratios.push_back(all.cost.wall_s / write_again(folder.path / "one", folder.path / "again", samples));
    rates.push_back(samples / all.cost.wall_s);
    for (const char* name : {"all", "again"}) fs::remove_all(folder.path / name);
  }
  return {median(ratios), samples / one.cost.wall_s, median(rates), one.cost.cpu_s / samples,
          double(one.totals.bytes) / samples};
}

}  // namespace laterna
