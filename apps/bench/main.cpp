// laterna-bench: what the hot stages cost, beside what the machine can do, measured in one run.
#include "apps/bench/board_ratio.h"
#include "apps/bench/dataset_ratio.h"
#include "apps/bench/decode_ratio.h"
#include "apps/bench/picture_ratio.h"
#include "apps/bench/replay_ratio.h"
#include "apps/bench/scaling.h"
#include "apps/bench/solve_ratio.h"
#include "apps/bench/stage_ratio.h"
#include "apps/lab/family_table.h"
#include "sim/error.h"
#include "sim/instruction_sets.h"
#include "sim/parallel.h"
#include "sim/safe_write.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <string>

using namespace laterna;

namespace {

struct Options {
  bool json = false, families = false;
  int repeats = 9, threads = 2, triangles = 100000;
  int boards = 0, dataset = 0;
  std::string scaling{};
  std::string isa;
};

// The bare calls that are fastest here are the measure.
VisibilityTimes against_the_best(const Scene& scene, int repeats) {
  const VisibilityTimes wide = visibility_over_embree(scene, {16, true, false}, repeats);
  const VisibilityTimes narrow = visibility_over_embree(scene, {8, true, false}, repeats);
  return wide.bare < narrow.bare ? wide : narrow;
}

nlohmann::ordered_json measure_dataset(int samples, int threads) {
  const DatasetTimes dataset = time_dataset(samples, threads);
  return {{"dataset_over_write_png", dataset.over_write},
          {"dataset_per_second_1_thread", dataset.samples_per_s_one},
          {"dataset_per_second", dataset.samples_per_s},
          {"dataset_cpu_seconds", dataset.cpu_s_per_sample},
          {"dataset_bytes", dataset.bytes_per_sample}};
}

nlohmann::ordered_json measure(const Options& options) {
  set_thread_count(options.threads);
  cap_instruction_set(options.isa);
  const Scene scene = bench_scene(options.triangles);
  const VisibilityTimes visibility = against_the_best(scene, options.repeats);
  const ReplayTimes replay = time_replay(scene, options.repeats);
  const StackTimes stack = time_stack(scene, std::max(1, options.repeats / 3));
  const PictureTimes pictures = time_pictures(std::max(1, options.repeats / 3));
  const DecodeTimes decode = time_decode(options.repeats);
  const SolveTimes solve = time_solve(std::max(1, options.repeats / 3));
  const BoardTimes small = time_boards(5, std::max(1, options.repeats / 3));
  const BoardTimes large = time_boards(18, std::max(1, options.repeats / 3));
  nlohmann::ordered_json result{
      {"visibility_over_embree", visibility.ratio},
      {"replay_bilinear_over_fill", replay.bilinear_over_fill},
      {"replay_binary_over_fill", replay.binary_over_fill},
      {"std_normal_over_noise", replay.std_normal_over_noise},
      {"noise_over_replay", replay.noise_over_replay},
      {"spp16_over_spp1", stack.ratio},
      {"stack44_seconds", stack.one},
      {"stack44_spp16_seconds", stack.sixteen},
      {"roundtrip_seconds", time_roundtrip(scene, std::max(1, options.repeats / 3))},
      {"write_png44_over_copy", pictures.png_over_copy},
      {"write_tif44_over_copy", pictures.tif_over_copy},
      {"write_tif_pages44_over_copy", pictures.pages_over_copy},
      {"decode_gray_over_read", decode.gray_over_read},
      {"opencv_over_decode_gray", decode.opencv_over_gray},
      {"atan2_over_decode_phase", decode.atan2_over_phase},
      {"atan2f_over_decode_phase", decode.atan2f_over_phase},
      {"atan2_over_fit_with_sigma", decode.atan2_over_fit},
      {"decode_phase_ns_per_pixel", decode.phase_ns},
      {"solve_million_passes", solve.passes},
      {"solve_million_over_pass", solve.over_pass},
      {"solve_million_seconds", solve.seconds},
      {"opencv_over_joint_small", small.opencv_over_joint},
      {"mrcal_over_joint_small", small.mrcal_over_joint},
      {"joint_small_seconds", small.joint_seconds},
      {"joint_small_corners", small.corners},
      {"opencv_over_joint_large", large.opencv_over_joint},
      {"mrcal_over_joint_large", large.mrcal_over_joint},
      {"joint_large_seconds", large.joint_seconds},
      {"joint_large_corners", large.corners},
      {"threads", thread_count()},
      {"isa", instruction_set()},
      {"fill_seconds", replay.fill},
      {"visibility_seconds", visibility.visibility}};
  result.update(measure_dataset(10, options.threads));
  return result;
}

// Leaves FILE.csv and a plot beside it.
void write_scaling(const Options& options) {
  set_thread_count(options.threads);
  const auto points = time_scaling(bench_scene(options.triangles), std::max(1, options.repeats / 3));
  std::filesystem::path path = options.scaling;
  write_file(path, scaling_csv(points));
  write_file(path.replace_extension(".svg"), scaling_svg(points));
  fmt::print("{}", scaling_csv(points));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Measures the hot stages on 44 Gray patterns, 1280x800 projector and camera, in memory.");
  Options options;
  app.add_flag("--json", options.json, "print one JSON object");
  app.add_option("--repeats", options.repeats, "how often each is measured; medians are printed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--threads", options.threads)->check(CLI::Range(1, 1024))->capture_default_str();
  app.add_option("--triangles", options.triangles)->check(CLI::Range(2, 10000000))->capture_default_str();
  app.add_option(
      "--isa", options.isa,
      fmt::format("use no more than this instruction set: {}", fmt::join(instruction_set_names(), ", ")));
  app.add_option("--scaling", options.scaling,
                 "instead, time captures by patterns, samples, bounces and paths: a CSV file, and a plot "
                 "(.svg) beside it");
  app.add_flag("--families", options.families,
               "instead, print what goes wrong with each pattern family under each fault, and who notices");
  app.add_option("--boards", options.boards,
                 "instead, calibrate so many simulated board captures by every method: error over the "
                 "Cramer-Rao bound, seconds, failures")
      ->check(CLI::Range(1, 10000));
  app.add_option("--dataset", options.dataset,
                 "instead, make a data set of so many samples, and write their pictures again")
      ->check(CLI::Range(1, 100000));
  CLI11_PARSE(app, argc, argv);
  nlohmann::ordered_json result;
  try {
    if (!options.scaling.empty()) {
      write_scaling(options);
      return 0;
    }
    if (options.families) {
      set_thread_count(options.threads);
      fmt::print("{}", family_table_text(family_table(table_families(), all_faults())));
      return 0;
    }
    if (options.boards > 0) {
      set_thread_count(options.threads);
      fmt::print("{}", method_scores_text(score_board_methods(options.boards)));
      return 0;
    }
    result = options.dataset > 0 ? measure_dataset(options.dataset, options.threads) : measure(options);
  } catch (const InputError& error) {
    fmt::print(stderr, "laterna-bench: {}\n", error.what());
    return 2;
  }
  if (options.json) {
    fmt::print("{}\n", result.dump());
    return 0;
  }
  for (const auto& [name, value] : result.items())
    fmt::print("{:28}{}\n", name,
               value.is_number_float() ? fmt::format("{:.4g}", value.get<double>()) : value.dump());
}
