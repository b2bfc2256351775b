#include "apps/laterna/command.h"

#include "apps/lab/score/cloud_score.h"
#include "apps/lab/score/score.h"
#include "sim/error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace laterna {

namespace {

struct ScoreWords {
  std::string truth, result, align;
  ScoreOptions options;
  CloudScoreOptions cloud;
};

void score_points(const ScoreWords& words, Common& common) {
  CloudScoreOptions options = words.cloud;
  if (!words.align.empty()) options.alignment = alignment_of(words.align);
  options.tolerance_px = words.options.tolerance_px;
  options.seed = common.seed;
  const CloudScore scored = score_cloud(read_score_truth(words.truth), read_point_cloud(words.result),
                                        options, [&](const std::string& line) { progress(common, line); });
  if (common.json)
    fmt::print("{}\n", cloud_score_json(scored).dump());
  else
    fmt::print("{}", cloud_score_text(scored));
  common.exit_code = scored.status == Status::ok ? exit_ok : exit_weak;
}

// Throws where an option for clouds of points stands beside a calibration.
void expect_no_cloud_options(const CLI::App& command) {
  for (const char* option : {"--frame", "--camera", "--projector", "--outlier-mm"})
    if (command.count(option))
      throw InputError(fmt::format("{} is for a cloud of points, expected a PLY file as RESULT", option));
}

void run_score(ScoreWords words, const CLI::App& command, Common& common) {
  if (is_ply_file(words.result)) return score_points(words, common);
  expect_no_cloud_options(command);
  if (!words.align.empty()) words.options.alignment = alignment_of(words.align);
  words.options.seed = common.seed;
  const ScoreTruth truth = read_score_truth(words.truth);
  const ScoreResult result = read_score_result(words.result, unsaid_by(truth.scene));
  const auto scores =
      score(truth, result, words.options, [&](const std::string& line) { progress(common, line); });
  if (common.json) {
    fmt::print("{}\n", score_json(scores, result.rig.notes).dump());
  } else {
    for (const std::string& note : result.rig.notes) fmt::print("note: {}\n", note);
    fmt::print("{}", score_text(scores));
  }
  const auto has = [&](Status status) {
    return std::any_of(scores.begin(), scores.end(), [&](const auto& s) { return s.status == status; });
  };
  common.exit_code = has(Status::refused) ? exit_refused : has(Status::weak) ? exit_weak : exit_ok;
}

}  // namespace

void add_score(CLI::App& app, Common& common) {
  auto words = std::make_shared<ScoreWords>();
  CLI::App* command = add_command(
      app, "score", "laterna score scene.toml calibration.yml",
      "Says whether someone's calibration is right: its error in projector pixels over the lit surface and "
      "the volume in\nfront of the projector and in mm on the surface, beside what noise alone predicts; "
      "and, of "
      "a wrong one, which of\nthe usual mistakes explains it. Exit code 4 where the error is beyond five "
      "times "
      "the noise and the tolerance.\n"
      "Of a cloud of points (PLY: x, y, z in metres, and where they are there projector_u, projector_v, "
      "camera_u,\n"
      "camera_v): the distances to the nearest surface, outliers counted; to the true point of the same "
      "pixel; and "
      "the\nprojector pixel's error. Exit code 4 where one is beyond twice the noise and the tolerance.");
  command
      ->add_option("TRUTH", words->truth, "Scene file, or a capture folder (its pictures are looked at too)")
      ->required();
  command
      ->add_option("RESULT", words->result,
                   "Calibration file of any format that `laterna convert` reads, or a cloud of points (PLY)")
      ->required();
  command->add_option(
      "--align", words->align,
      "What of the result is not to be judged: none, world (moved until its camera stands where "
      "the true one does), scale (of the camera-projector baseline), world+scale. Default: "
      "world where the result has a camera, else none. Of a cloud, which needs pixels: world moves and scale "
      "scales it to fit the true points of its pixels; default: none");
  command
      ->add_option("--tolerance-px", words->options.tolerance_px,
                   "Errors below it are ok, whatever noise predicts")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->add_option("--frame", words->cloud.frame,
                      "Of a cloud: the device in whose frame its points stand (default: the scene's world)");
  command->add_option("--camera", words->cloud.camera,
                      "Of a cloud: whose pixels it has (default: the only one's)");
  command->add_option("--projector", words->cloud.projector, "Of a cloud: likewise");
  command
      ->add_option(
          "--outlier-mm", words->cloud.outlier_mm,
          "Of a cloud: points farther than this from the surface are counted as outliers (default: three "
          "times what 95 % of the points keep to with noise alone)")
      ->check(CLI::PositiveNumber);
  command->callback([words, command, &common] { run_score(*words, *command, common); });
}

}  // namespace laterna
