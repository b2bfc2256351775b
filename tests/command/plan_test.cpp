#include "tests/command/run_command.h"
#include "tests/testing.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <sys/wait.h>

#include <cstdlib>

namespace laterna::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const char* const scene = R"(
[[mesh]]
shape = "sphere"
shape_size = [2, 2, 2]
detail = 24
[[projector]]
size = [256, 160]
throw_ratio = 1.4
position = [0.3, 0, 2.2]
look_at = [0, 0, 0.8]
up = [0, 1, 0]
[[camera]]
size = [224, 140]
fov_x_deg = 30
position = [-0.3, 0.1, 2.2]
look_at = [0, 0, 0.8]
up = [0.1, 1, 0]
[patterns]
kind = "gray_phase"
steps = 4
)";

TEST(Command, PlanKeepsItsContractAndItsSceneRuns) {
  const ScratchFolder scratch;
  write_text(scratch / "dome.toml", scene);
  const auto run = laterna("plan dome.toml --tolerance-px 0.05 --seeds 2 --json", scratch.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  const json plan = json::parse(run.out);
  EXPECT_EQ(plan.at("kept"), json::array());
  EXPECT_EQ(plan.at("dropped"), json({"shadow", "back_face", "border", "irradiance"}));
  EXPECT_LE(plan.at("change_px"), 0.05);
  EXPECT_GT(plan.at("seconds_full"), 0);
  EXPECT_GT(plan.at("seconds_plan"), 0);
  EXPECT_EQ(plan.at("scene"), "dome-planned.toml");
  EXPECT_EQ(listing(scratch.path()), "dome-planned.toml dome.toml ");
  EXPECT_EQ(laterna("roundtrip dome-planned.toml --json", scratch.path()).exit_code, 0);
  const auto again = laterna("plan dome.toml --tolerance-px 0.05 --seeds 2", scratch.path());
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("round trips, one by one, 0:00 left"));
  EXPECT_THAT(again.out, HasSubstr("dropped: shadow, back_face, border, irradiance"));
  EXPECT_EQ(read_text(scratch / "dome-planned-2.toml"), read_text(scratch / "dome-planned.toml"));
}

// Runs `laterna WORDS` in a folder and presses ctrl-C once the journal holds `results` ends of trials; the
// exit code.
int interrupted_after(int results, const std::string& words, const std::string& journal,
                      const std::filesystem::path& folder) {
  const std::string script = fmt::format(
      "cd '{}' || exit 9; '{}' {} >/dev/null 2>err & pid=$!\n"
      "until [ \"$(grep -c result {})\" -ge {} ] || ! kill -0 $pid; do sleep 0.01; done 2>/dev/null\n"
      "kill -INT $pid; wait $pid",
      folder.string(), laterna_path(), words, journal, results);
  return WEXITSTATUS(std::system(script.c_str()));
}

// All of plan.json that does not depend on the clock or on where it stands.
json without_seconds(const std::filesystem::path& plan_json) {
  json plan = json::parse(read_text(plan_json));
  for (const char* key : {"seconds_full", "seconds_plan", "scene"}) plan.erase(key);
  for (json& choice : plan.at("choices"))
    for (json& tried : choice.at("tried")) tried.erase("seconds_saved");
  return plan;
}

TEST(Command, APlanInterruptedInItsMiddleIsGoneOnWith) {
  const ScratchFolder scratch;
  write_text(scratch / "dome.toml", scene);
  const std::string words = "plan dome.toml --tolerance-px 0.05 --seeds 2 ";
  ASSERT_EQ(laterna(words + "-o whole.toml --work whole", scratch.path()).exit_code, 0);
  const std::string cut = words + "-o cut.toml --work cut";
  EXPECT_EQ(interrupted_after(5, cut, "cut/journal.jsonl", scratch.path()), 5);
  EXPECT_THAT(read_text(scratch / "err"), HasSubstr("the same command with --resume goes on"));
  EXPECT_EQ(listing(scratch / "cut"), "journal.jsonl ");
  EXPECT_FALSE(std::filesystem::exists(scratch / "cut.toml"));
  EXPECT_EQ(laterna(cut, scratch.path()).exit_code, 2);  // not without --resume
  const auto end = laterna(cut + " --resume", scratch.path());
  ASSERT_EQ(end.exit_code, 0) << end.err;
  EXPECT_EQ(read_text(scratch / "cut.toml"), read_text(scratch / "whole.toml"));
  EXPECT_EQ(without_seconds(scratch / "cut/plan.json"), without_seconds(scratch / "whole/plan.json"));
  EXPECT_EQ(read_text(scratch / "cut/reference.json"), read_text(scratch / "whole/reference.json"));
}

TEST(Command, PlanSaysWhatIsWrong) {
  const ScratchFolder scratch;
  write_text(scratch / "dome.toml", scene);
  const auto bad = [&](const std::string& words) {
    const auto run = laterna("plan " + words, scratch.path());
    EXPECT_EQ(run.exit_code, 2) << words;
    EXPECT_EQ(listing(scratch.path()), "dome.toml ") << words;
    return run.err;
  };
  EXPECT_THAT(bad("dome.toml --tolerance-px 0"), HasSubstr("expected a number above 0"));
  EXPECT_THAT(bad("dome.toml --tolerance-px nan"), HasSubstr("expected a number above 0"));
  EXPECT_THAT(bad("dome.toml"), HasSubstr("tolerance-px"));
  EXPECT_THAT(bad("dome.toml --tolerance-px 1 --seeds 1"), HasSubstr("seeds"));
  EXPECT_THAT(bad("dome.toml --tolerance-px 1 -o dome.toml"), HasSubstr("exists already"));
  EXPECT_THAT(bad("dome.toml --tolerance-px 1 --resume"), HasSubstr("holds no run"));
  EXPECT_THAT(bad("none.toml --tolerance-px 1"), HasSubstr("none.toml"));
  std::string flat = scene;
  write_text(scratch / "dome.toml", flat.replace(flat.find("sphere"), 6, "plane"));
  const auto refused = laterna("plan dome.toml --tolerance-px 1", scratch.path());
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, HasSubstr("refused: the full scene itself: "));
  EXPECT_EQ(listing(scratch.path()), "dome.toml ");
  EXPECT_THAT(laterna("plan --help", scratch.path()).out, StartsWith("Example: laterna plan"));
}

// The same keys and values as in a file of their own.
TEST(Command, SetChangesKeysOfTheScene) {
  const ScratchFolder scratch;
  write_text(scratch / "dome.toml", scene);
  std::string other = scene;
  write_text(scratch / "other.toml",
             other.replace(other.find("[224, 140]"), 10, "[256, 160]") + "pitch_px = 16\n");
  const std::string set = "--set camera.size=[256,160] --set patterns.pitch_px=16 ";
  const auto results = [&](const std::string& words) {
    const auto run = laterna(words, scratch.path());
    EXPECT_EQ(run.exit_code, 0) << words << run.err;
    json result = json::parse(run.out);
    if (result.contains("projectors") && result["projectors"].is_array())
      for (json& projector : result["projectors"]) projector.erase("seconds");
    result.erase("seconds");
    return result;
  };
  for (const std::string command : {"roundtrip ", "info "}) {
    EXPECT_EQ(results(command + set + "dome.toml --json"), results(command + "other.toml --json"));
    EXPECT_NE(results(command + "dome.toml --json"), results(command + "other.toml --json"));
  }
  EXPECT_EQ(laterna("check dome.toml --set effects.shadow=false", scratch.path()).exit_code, 0);
  const auto wrong = laterna("check dome.toml --set effects.shadows=false", scratch.path());
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--set effects.shadows: unknown key"));
  EXPECT_THAT(wrong.err, HasSubstr("did you mean \"shadow\""));
  EXPECT_EQ(laterna("check dome.toml --set effects", scratch.path()).exit_code, 2);
}

}  // namespace
}  // namespace laterna::testing
