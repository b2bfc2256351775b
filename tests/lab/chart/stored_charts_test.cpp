// The stored results of the shipped sweeps (data/charts), against those of today.
#include "apps/lab/chart/chart_report.h"
#include "apps/lab/chart/chart_svg.h"
#include "sim/text_file.h"
#include "tests/testing.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace laterna {
namespace {

using testing::ScratchFolder;
using testing::write_text;

class StoredCharts : public ::testing::TestWithParam<const char*> {};

// The seeds are the same, so that what differs is rounding of another instruction set or compiler, and
// what a change of the code moves. A tenth of the spread over the seeds is no other answer to a chart's
// question, nor is a hundredth of the error where seeds hardly differ; bounds have no noise, only rounding.
void expect_near(const ChartPoint& now, const ChartPoint& stored) {
  EXPECT_EQ(now.ok + now.weak, stored.ok + stored.weak) << now.label << ": " << now.reason;
  EXPECT_EQ(now.pictures, stored.pictures) << now.label;
  const double spread = stored.error_px.high - stored.error_px.low;
  ASSERT_EQ(std::isfinite(now.error_px.middle), std::isfinite(stored.error_px.middle)) << now.label;
  if (std::isfinite(stored.error_px.middle)) {
    EXPECT_NEAR(now.error_px.middle, stored.error_px.middle,
                std::max(0.1 * spread, 0.01 * stored.error_px.middle))
        << now.label;
  }
  EXPECT_EQ(std::isfinite(now.bound_px), std::isfinite(stored.bound_px)) << now.label;
  if (std::isfinite(stored.bound_px)) {
    EXPECT_NEAR(now.bound_px, stored.bound_px, 0.01 * stored.bound_px) << now.label;
  }
}

// Every seventh point, the same in every run: seven is prime to the number of methods. On failure both charts
// stay in the folder that the message names.
TEST_P(StoredCharts, HoldToday) {
  const std::filesystem::path folder = laterna::testing::data_folder() / "charts";
  const std::string name = GetParam();
  Chart stored = read_chart_reference(read_text(folder / (name + ".json"), 1 << 24), name + ".json");
  std::vector<ChartPoint> kept;
  for (std::size_t k = 0; k < stored.points.size(); ++k)
    if (k % 7 == 0) kept.push_back(stored.points[k]);
  stored.points = kept;
  ChartOptions options;
  options.repeats = 1;
  for (const ChartPoint& p : kept) options.points.push_back(p.label);
  const ScratchFolder scratch;
  const Chart now = run_chart(folder / (name + ".toml"), scratch / "now", options);
  ASSERT_EQ(now.points.size(), kept.size());
  for (std::size_t k = 0; k < kept.size(); ++k) expect_near(now.points[k], kept[k]);
  write_text(scratch / "stored.svg", chart_svg(stored));
  write_text(scratch / "now.svg", chart_svg(now));
  if (HasFailure()) ADD_FAILURE() << "both charts are in " << scratch.path();
}

INSTANTIATE_TEST_SUITE_P(Charts, StoredCharts,
                         ::testing::Values("pattern_families", "second_sample", "point_solvers", "points",
                                           "board_solvers", "board_poses"),
                         [](const auto& instance) { return std::string(instance.param); });

}  // namespace
}  // namespace laterna
