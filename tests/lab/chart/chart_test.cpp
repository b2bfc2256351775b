#include "apps/lab/chart/chart.h"
#include "apps/lab/peak_memory.h"

#include "apps/lab/chart/chart_report.h"
#include "sim/text_file.h"
#include "tests/lab/changed_files.h"

#include <gmock/gmock.h>

#include <unistd.h>

#include <csignal>
#include <sstream>
#include <thread>

namespace laterna {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::input_error;
using testing::ScratchFolder;
using testing::write_text;

TEST(Quartiles, ByHand) {
  const Quartiles five = quartiles({5, 1, 4, 2, 3});
  EXPECT_EQ(five.low, 2);
  EXPECT_EQ(five.middle, 3);
  EXPECT_EQ(five.high, 4);
  const Quartiles two = quartiles({1, 2});
  EXPECT_EQ(two.low, 1.25);
  EXPECT_EQ(two.middle, 1.5);
  EXPECT_EQ(two.high, 1.75);
  EXPECT_EQ(quartiles({7}).high, 7);
  EXPECT_TRUE(std::isnan(quartiles({}).middle));
  EXPECT_EQ(quartiles({1, 2, INFINITY}).middle, 2);  // one bad seed is no NaN
}

ChartPoint point(double x, double error) {
  ChartPoint p;
  p.seeds = p.ok = 1, p.x = x, p.error_px = {error, error, error};
  return p;
}

TEST(ParetoFront, ByHand) {
  std::vector<ChartPoint> points{point(3, 1), point(1, 4), point(2, 4),
                                 point(2, 2), point(4, 1), point(9, 0.5)};
  EXPECT_THAT(pareto_front(points), ElementsAre(1, 3, 0, 5));
  points[3].ok = 0, points[3].refused = 1;  // no longer in the way of (2, 4), which (1, 4) still beats
  EXPECT_THAT(pareto_front(points), ElementsAre(1, 0, 5));
  points[1].error_px.middle = NAN;
  EXPECT_THAT(pareto_front(points), ElementsAre(2, 0, 5));
  EXPECT_THAT(pareto_front({point(1, 1), point(1, 1)}), ElementsAre(0, 1));  // neither beats its equal
  EXPECT_TRUE(pareto_front({}).empty());
}

const std::string sweep = R"(
[[grid]]
name = "solvers"
kind = "points"
methods = ["laterna", "dlt"]
seeds = 3
repeats = 2
points = [30, 100]
[[grid]]
name = "planar"
kind = "points"
relief = 0
seeds = 2
)";

TEST(Chart, MeasuresEveryPointOfEveryGridByEveryMethod) {
  const ScratchFolder folder;
  const Chart chart = run_chart(write_text(folder / "s.toml", sweep), folder / "a", {});
  ASSERT_EQ(chart.points.size(), 5u);
  EXPECT_EQ(chart.name, "s");
  EXPECT_EQ(chart.points[1].label, "solvers: points=30 method=dlt");
  EXPECT_EQ(chart.points[1].series, "solvers, dlt");
  EXPECT_EQ(chart.points[4].label, "planar");
  for (std::size_t k = 0; k < 4; ++k) {
    const ChartPoint& p = chart.points[k];
    EXPECT_EQ(p.ok + p.weak, 3) << p.label << p.reason;
    // Errors of 3 seeds around their bound: the median within a factor of 4 for 11 parameters, by far.
    EXPECT_GT(p.error_px.middle, p.bound_px / 4) << p.label;
    EXPECT_LT(p.error_px.middle, p.bound_px * 4) << p.label;
    EXPECT_LE(p.error_px.low, p.error_px.middle);
    EXPECT_LE(p.error_px.middle, p.error_px.high);
    EXPECT_GT(p.seconds, 0);
    EXPECT_EQ(std::isfinite(p.peak_mib), restart_peak_memory());
    EXPECT_EQ(p.x, p.seconds);
    EXPECT_LE(p.seconds_low, p.seconds);
    EXPECT_LE(p.seconds, p.seconds_high);
  }
  EXPECT_EQ(chart.points[0].bound_px, chart.points[1].bound_px);  // the same problems by every method
  EXPECT_GT(chart.points[0].bound_px, chart.points[2].bound_px);  // 30 points tell less than 100
  EXPECT_EQ(chart.points[4].refused, 2);                          // an exact plane
  EXPECT_TRUE(std::isnan(chart.points[4].error_px.middle));
  EXPECT_FALSE(chart.points[4].reason.empty());
}

// All that does not depend on the clock, as text.
std::string results(const Chart& chart) {
  nlohmann::json json = chart_reference(chart);
  json.erase("pareto");
  for (auto& p : json["points"]) p.erase("seconds_ratio");
  return json.dump();
}

// Lines of the journal that a killed process leaves.
TEST(Chart, AResumedRunEndsAsAnUninterruptedOne) {
  const ScratchFolder folder;
  const auto file = write_text(folder / "s.toml", sweep);
  const Chart whole = run_chart(file, folder / "whole", {});
  std::istringstream journal(read_text(folder / "whole" / "journal.jsonl", 1 << 20));
  std::string first_lines;
  for (int k = 0; k < 5; ++k) {  // the head, then two points
    std::string line;
    std::getline(journal, line);
    first_lines += line + "\n";
  }
  std::filesystem::create_directories(folder / "cut");
  write_text(folder / "cut" / "journal.jsonl", first_lines);
  const Chart resumed = run_chart(file, folder / "cut", {.resume = true});
  EXPECT_FALSE(resumed.interrupted);
  EXPECT_EQ(resumed.points[0].seconds, whole.points[0].seconds);  // measured once
  EXPECT_EQ(results(resumed), results(whole));
}

TEST(Chart, AnInterruptLeavesWhatIsDone) {
  const ScratchFolder folder;
  std::string many = "[[grid]]\nname = \"g\"\nkind = \"points\"\npoints = [";
  for (int k = 0; k < 500; ++k) many += std::to_string(300 + k) + ",";
  const auto journal = folder / "a" / "journal.jsonl";
  std::thread person([&] {  // presses ctrl-C when the first point has begun
    while (!std::filesystem::exists(journal) ||
           read_text(journal, 1 << 20).find("begin") == std::string::npos)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    kill(getpid(), SIGINT);
  });
  const Chart chart = run_chart(write_text(folder / "s.toml", many + "]\n"), folder / "a", {});
  person.join();
  EXPECT_TRUE(chart.interrupted);
  EXPECT_GE(chart.done, 1u);
  EXPECT_LT(chart.done, 500u);
  EXPECT_EQ(chart.points.size(), chart.done);
}

TEST(Chart, AnInterruptAfterTheLastPointIsHeard) {
  const ScratchFolder folder;
  const auto file = write_text(folder / "s.toml", sweep);
  const Chart stopped = run_chart(file, folder / "a", {}, [](const std::string& line) {
    if (line.starts_with("5 of 5 points")) std::raise(SIGINT);
  });
  EXPECT_TRUE(stopped.interrupted);
  EXPECT_EQ(stopped.done, 5u);
  const Chart resumed = run_chart(file, folder / "a", {.resume = true});
  EXPECT_FALSE(resumed.interrupted);
  EXPECT_EQ(results(resumed), results(run_chart(file, folder / "whole", {})));
}

TEST(Chart, AChangedFileIsNotGoneOnWith) {
  const ScratchFolder folder;
  const auto file =
      write_text(folder / "a.toml",
                 "[[grid]]\nname = \"a\"\nkind = \"pictures\"\nseeds = 1\nrepeats = 1\nscene = \"s.toml\"\n");
  testing::write_roof_scene(folder.path());
  run_chart(file, folder / "out", {});
  testing::expect_each_change_refused({file, folder / "s.toml", folder / "roof.obj"},
                                      [&] { run_chart(file, folder / "out", {.resume = true}); });
}

TEST(Chart, APointAloneIsThePointAmongOthers) {
  const ScratchFolder folder;
  const auto file = write_text(folder / "s.toml", sweep);
  const Chart whole = run_chart(file, folder / "whole", {});
  const Chart alone =
      run_chart(file, folder / "alone", {.points = {"solvers: points=100 method=dlt"}, .repeats = 1});
  ASSERT_EQ(alone.points.size(), 1u);
  EXPECT_EQ(alone.points[0].error_px.middle, whole.points[3].error_px.middle);
  EXPECT_EQ(alone.points[0].bound_px, whole.points[3].bound_px);
  const Chart other =
      run_chart(file, folder / "other", {.seed = 2, .points = {"planar", whole.points[3].label}});
  EXPECT_NE(other.points[0].error_px.middle, whole.points[3].error_px.middle);
}

TEST(Chart, AgainstAKeyOfTheGrid) {
  const ScratchFolder folder;
  const Chart chart = run_chart(write_text(folder / "s.toml", R"(
[[grid]]
name = "g"
kind = "points"
against = "points"
points = [20, 200]
)"),
                                folder / "a", {.repeats = 1});
  EXPECT_EQ(chart.against, "points");
  EXPECT_EQ(chart.points[0].x, 20);
  EXPECT_EQ(chart.points[1].x, 200);
  EXPECT_THAT(pareto_front(chart.points), ElementsAre(0, 1));  // tenfold points: a third of the error
}

// Pictures count, and an exposure of an eighth of a second each: Gray's picture count is its own formula.
TEST(Chart, PicturesHaveSecondsOfCapture) {
  const ScratchFolder folder;
  const Chart chart = run_chart(write_text(folder / "s.toml", R"(
[[grid]]
name = "g"
kind = "pictures"
against = "capture_seconds"
seconds_per_picture = 0.125
seeds = 1
repeats = 1
scene = ")" + (laterna::testing::data_folder() / "scenes/relief.toml").string() +
                                                                  R"("
"projector.size" = [[256, 128]]
"camera.size" = [[160, 100]]
)"),
                                folder / "a", {});
  ASSERT_EQ(chart.points.size(), 1u);
  const ChartPoint& p = chart.points[0];
  ASSERT_EQ(p.ok + p.weak, 1) << p.reason;
  EXPECT_EQ(p.pictures, 2 * 8 + 2 * 7 + 2);  // 256 columns, 128 rows, a pair per bit; white, black
  EXPECT_EQ(p.capture_seconds, 32 * 0.125);
  EXPECT_EQ(p.x, p.capture_seconds);
  EXPECT_EQ(p.bound, "predicted_volume_rms_independent_px");
  EXPECT_GT(p.bound_px, 0);
  // 256 pixels over 1.75 m of the 2.1 m throw are 6.8 mm each: the error in mm is near 6.8 times that in px
  // (volume and surface differ, the relief is 0.7 m deep: a factor of 3 either way).
  EXPECT_GT(p.error_mm, 6.8 / 3 * p.error_px.middle);
  EXPECT_LT(p.error_mm, 6.8 * 3 * p.error_px.middle);
  EXPECT_THAT(p.stages, ::testing::Contains(::testing::Pair("decode", ::testing::Gt(0))));
}

TEST(Chart, BadInput) {
  const ScratchFolder folder;
  const auto refused = [&](const std::string& text, ChartOptions options = {}) {
    return input_error([&] { run_chart(write_text(folder / "s.toml", text), folder / "a", options); });
  };
  const std::string grid = "[[grid]]\nname = \"g\"\nkind = \"points\"\n";
  EXPECT_THAT(refused(grid, {.points = {"h"}}), HasSubstr("no point \"h\", did you mean \"g\"?"));
  EXPECT_THAT(refused(grid + "against = \"shape\"\n"), HasSubstr("against is \"shape\""));
  EXPECT_THAT(refused(grid + "against = \"capture_seconds\"\n"), HasSubstr("which pictures alone have"));
  EXPECT_THAT(refused(grid + "against = 3\n"), HasSubstr("expected a string"));
  EXPECT_THAT(refused(grid + "seeds = 0\n"), HasSubstr("expected a whole number from 1"));
  EXPECT_THAT(refused(grid + "seconds_per_picture = -1\n"), HasSubstr("expected a number above 0"));
  EXPECT_THAT(refused(grid + "methods = \"mrcal\"\n"), HasSubstr("no method \"mrcal\" for points"));
  EXPECT_THAT(refused(grid + "[[grid]]\nname = \"h\"\nkind = \"points\"\npoints = 9\nagainst = \"points\"\n"),
              HasSubstr("expected one x"));
  EXPECT_THAT(refused("[[grid]]\nname = \"g\"\nkind = \"pictures\"\nscene = \"none.toml\"\n"),
              HasSubstr("none.toml"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a"));
}

}  // namespace
}  // namespace laterna
