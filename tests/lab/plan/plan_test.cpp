#include "apps/lab/plan/plan.h"

#include "apps/lab/plan/plan_report.h"
#include "sim/scene_build.h"
#include "sim/scene_file.h"
#include "sim/text_file.h"
#include "tests/lab/changed_files.h"

#include <gmock/gmock.h>

#include <unistd.h>

#include <csignal>
#include <sstream>
#include <thread>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using testing::input_error;
using testing::ScratchFolder;
using testing::write_text;
using Json = nlohmann::json;

const std::filesystem::path data = laterna::testing::data_folder();

// A dome under Gray codes, small enough to be planned in a second.
const std::string small = R"(
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
pitch_px = 32
steps = 4
)";

std::string lists(const Json& plan) {
  std::string text = "kept " + plan.at("kept").dump() + " dropped " + plan.at("dropped").dump();
  for (const auto& [name, setting] : plan.at("settings").items())
    text += " " + name + "=" + setting.at("plan").get<std::string>();
  return text;
}

struct Shipped {
  const char* scene;
  const char* reference;
  std::vector<std::string> kept;
};

class ShippedPlan : public ::testing::TestWithParam<Shipped> {};

// The planned scene beside the full one on seeds that planned nothing, seed by seed.
double rms_on_fresh_seeds(const SceneSpec& full, const SceneSpec& plan, const std::filesystem::path& folder) {
  std::vector<RoundTrip> a, b;
  for (int k = 0; k < 2; ++k) {
    a.push_back(round_trip(full, folder, testing::seed() + std::uint64_t(k)));
    b.push_back(round_trip(plan, folder, testing::seed() + std::uint64_t(k)));
  }
  return change_between(volumes_of(full, folder), a, b).rms_px;
}

// Keeps exactly the effect that matters; a change that moves a list or a setting of the reference fails, with
// both plans kept. The written scene's answer holds to the tolerance.
TEST_P(ShippedPlan, KeepsWhatMattersAndIsItsReference) {
  const ScratchFolder folder;
  const std::filesystem::path scene = data / GetParam().scene;
  const std::string text = read_text(data / "plan" / GetParam().reference, 1 << 20);
  const Json reference = Json::parse(text);
  const double tolerance_px = reference.at("tolerance_px");
  const Plan plan = make_plan(scene, folder / "work", {.tolerance_px = tolerance_px});
  const Json found = plan_reference(plan);
  write_text(folder / "found.json", found.dump(1)), write_text(folder / "reference.json", text);
  EXPECT_EQ(found["kept"].get<std::vector<std::string>>(), GetParam().kept);
  EXPECT_EQ(lists(found), lists(reference)) << "both plans are in " << folder.path();
  EXPECT_LE(plan.confirmed.change_px + plan.confirmed.doubt_px, tolerance_px);
  EXPECT_TRUE(std::isfinite(plan.seconds_full) && std::isfinite(plan.seconds_plan));
  const auto out =
      write_text(folder / "planned.toml", planned_scene_toml(plan, scene, folder / "planned.toml"));
  EXPECT_LE(rms_on_fresh_seeds(read_scene_spec(scene), read_scene_spec(out), folder.path()), tolerance_px);
}

INSTANTIATE_TEST_SUITE_P(
    Plan, ShippedPlan,
    ::testing::Values(Shipped{"plan/v_groove.toml", "v_groove.json", {"inter_reflection"}},
                      Shipped{"scenes/near_focus.toml", "near_focus.json", {"projector_defocus"}},
                      Shipped{"plan/convex.toml", "convex.json", {}}),
    [](const auto& of) { return std::filesystem::path(of.param.reference).stem().string(); });

// What does not depend on the clock.
std::string results(const Plan& plan) { return plan_reference(plan).dump() + scene_toml(plan.scene); }

TEST(Plan, AResumedRunEndsAsAnUninterruptedOne) {
  const ScratchFolder folder;
  const auto scene = write_text(folder / "s.toml", small);
  const Plan whole = make_plan(scene, folder / "whole", {.tolerance_px = 0.05, .seeds = 2});
  std::istringstream journal(read_text(folder / "whole" / "journal.jsonl", 1 << 20));
  std::string first_lines;
  for (int k = 0; k < 12; ++k) {  // the head, five trials, and the beginning of a sixth
    std::string line;
    std::getline(journal, line);
    first_lines += line + "\n";
  }
  std::filesystem::create_directories(folder / "cut");
  write_text(folder / "cut" / "journal.jsonl", first_lines);
  const Plan resumed = make_plan(scene, folder / "cut", {.tolerance_px = 0.05, .seeds = 2, .resume = true});
  EXPECT_FALSE(resumed.interrupted);
  EXPECT_EQ(results(resumed), results(whole));
}

TEST(Plan, AnInterruptLeavesWhatIsDone) {
  const ScratchFolder folder;
  const auto scene = write_text(folder / "s.toml", small);
  const auto journal = folder / "a" / "journal.jsonl";
  std::thread person([&] {  // presses ctrl-C when the first trial has begun
    while (!std::filesystem::exists(journal) ||
           read_text(journal, 1 << 20).find("begin") == std::string::npos)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    kill(getpid(), SIGINT);
  });
  const Plan plan = make_plan(scene, folder / "a", {.tolerance_px = 0.05, .seeds = 20});
  person.join();
  EXPECT_TRUE(plan.interrupted);
  EXPECT_THAT(read_text(journal, 1 << 20), HasSubstr("result"));
}

// Told of all the last run's trials, a person presses ctrl-C: nothing is left but to write the scene.
TEST(Plan, AnInterruptAfterTheLastTrialIsHeard) {
  const ScratchFolder folder;
  const auto scene = write_text(folder / "s.toml", small);
  const auto ends_a_run = [](const std::string& line) { return line.ends_with(", 0:00 left"); };
  int runs = 0;
  const Plan whole = make_plan(scene, folder / "whole", {.tolerance_px = 0.05, .seeds = 2},
                               [&](const std::string& line) { runs += ends_a_run(line); });
  int left = runs;
  const Plan stopped =
      make_plan(scene, folder / "a", {.tolerance_px = 0.05, .seeds = 2}, [&](const std::string& line) {
        if (ends_a_run(line) && --left == 0) std::raise(SIGINT);
      });
  EXPECT_FALSE(whole.interrupted);
  EXPECT_EQ(left, 0);
  EXPECT_TRUE(stopped.interrupted);
  const Plan resumed = make_plan(scene, folder / "a", {.tolerance_px = 0.05, .seeds = 2, .resume = true},
                                 [](const std::string& line) { ADD_FAILURE() << line; });  // nothing to run
  EXPECT_FALSE(resumed.interrupted);
  EXPECT_EQ(results(resumed), results(whole));
}

TEST(Plan, AChangedFileIsNotGoneOnWith) {
  const ScratchFolder folder;
  const auto scene = testing::write_roof_scene(folder.path());
  PlanOptions options{.tolerance_px = 1, .seeds = 2};
  make_plan(scene, folder / "a", options, [](const std::string&) { std::raise(SIGINT); });
  options.resume = true;
  testing::expect_each_change_refused({scene, folder / "roof.obj"},
                                      [&] { make_plan(scene, folder / "a", options); });
}

// With a tolerance near 0, nothing that moves light can be dropped, and the report says why.
TEST(Plan, WhatNoiseDoesNotLetTellStays) {
  const ScratchFolder folder;
  const auto noisy = write_text(folder / "n.toml", [&] {
    std::string text = small;
    return text.replace(text.find("[patterns]"), 0, "sensor = { noise_sigma_dn = 3.0 }\n");
  }());
  const Plan plan = make_plan(noisy, folder / "a", {.tolerance_px = 1e-4, .seeds = 2});
  for (const ChoiceMade& choice : plan.choices) {
    if (choice.name == "irradiance") {
      EXPECT_NE(choice.end, "dropped");
    }
    if (choice.name == "shadow") {
      EXPECT_EQ(choice.end, "dropped");  // nothing stands in the light: the same bits, noise and all
    }
  }
  EXPECT_GT(plan.noise_px, plan.tolerance_px);
  EXPECT_THAT(plan_text(plan), HasSubstr("more than the tolerance"));
}

TEST(Plan, BadInputIsNamed) {
  const ScratchFolder folder;
  const auto scene = write_text(folder / "s.toml", small);
  const auto message = [&](const std::filesystem::path& file, const PlanOptions& options) {
    return input_error([&] { make_plan(file, folder / "a", options); });
  };
  EXPECT_THAT(message(scene, {.tolerance_px = 0}), HasSubstr("the tolerance is 0"));
  EXPECT_THAT(message(scene, {.tolerance_px = -1}), HasSubstr("above 0"));
  EXPECT_THAT(message(scene, {.tolerance_px = NAN}), HasSubstr("nan"));
  EXPECT_THAT(message(scene, {.tolerance_px = INFINITY}), HasSubstr("inf"));
  EXPECT_THAT(message(scene, {.tolerance_px = 1, .seeds = 1}), HasSubstr("at least 2"));
  EXPECT_THAT(message(scene, {.tolerance_px = 1, .resume = true}), HasSubstr("holds no run"));
  EXPECT_THAT(message(folder / "none.toml", {.tolerance_px = 1}), HasSubstr("none.toml"));
  const std::string no_projector = small.substr(0, small.find("[[projector]]"));
  EXPECT_THAT(message(write_text(folder / "p.toml", no_projector), {.tolerance_px = 1}),
              HasSubstr("no [[projector]]"));
  const std::string no_camera =
      small.substr(0, small.find("[[camera]]")) + small.substr(small.find("[patterns]"));
  EXPECT_THAT(message(write_text(folder / "c.toml", no_camera), {.tolerance_px = 1}),
              HasSubstr("no [[camera]]"));
}

// A flat board tells no focal length.
TEST(Plan, AFullSceneThatIsRefusedIsRefused) {
  const ScratchFolder folder;
  std::string flat = small;
  flat.replace(flat.find("\"sphere\""), 8, "\"plane\"");
  const auto scene = write_text(folder / "s.toml", flat);
  try {
    make_plan(scene, folder / "a", {.tolerance_px = 1});
    FAIL() << "expected a refusal";
  } catch (const Refusal& refusal) {
    EXPECT_THAT(refusal.what(), HasSubstr("the full scene itself"));
  }
}

TEST(Plan, TheWrittenSceneFindsItsFilesFromElsewhere) {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder / "from");
  std::filesystem::create_directories(folder / "to/deep");
  write_text(
      folder / "from/a.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  Plan plan;
  plan.scene = parse_scene("[[mesh]]\nfile = \"a.ply\"\n", "s.toml");
  const auto out = folder / "to/deep/planned.toml";
  write_text(out, planned_scene_toml(plan, folder / "from/s.toml", out));
  EXPECT_EQ(load_scene(out).objects.at(0).mesh.positions.size(), 3u);
  EXPECT_EQ(read_scene_spec(out).meshes[0].file, "../../from/a.ply");
}

}  // namespace
}  // namespace laterna
