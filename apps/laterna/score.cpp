#include "apps/laterna/command.h"

#include "apps/lab/score/score.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace laterna {

namespace {

struct ScoreWords {
  std::string truth, result, align;
  ScoreOptions options;
};

void run_score(ScoreWords words, Common& common) {
  if (!words.align.empty()) words.options.alignment = alignment_of(words.align);
  words.options.seed = common.seed;
  const ScoreTruth truth = read_score_truth(words.truth);
  const ScoreResult result = read_score_result(words.result, unsaid_by(truth.scene));
  const auto scores =
      score(truth, result, words.options, [&](const std::string& line) { progress(common, line); });
  if (common.json)
    fmt::print("{}\n", score_json(scores).dump());
  else
    fmt::print("{}", score_text(scores));
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
      "the "
      "volume in\nfront of the projector and in mm on the surface, beside what noise alone predicts; and, of "
      "a "
      "wrong one, which of\nthe usual mistakes explains it. Exit code 4 where the error is beyond five times "
      "the noise and the tolerance.");
  command
      ->add_option("TRUTH", words->truth, "Scene file, or a capture folder (its pictures are looked at too)")
      ->required();
  command->add_option("RESULT", words->result, "Calibration file of any format that `laterna convert` reads")
      ->required();
  command->add_option(
      "--align", words->align,
      "What of the result is not to be judged: none, world (moved until its camera stands where "
      "the true one does), scale (of the camera-projector baseline), world+scale. Default: "
      "world where the result has a camera, else none");
  command
      ->add_option("--tolerance-px", words->options.tolerance_px,
                   "Errors below it are ok, whatever noise predicts")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->callback([words, &common] { run_score(*words, common); });
}

}  // namespace laterna
