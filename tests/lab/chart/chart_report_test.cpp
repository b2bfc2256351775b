#include "apps/lab/chart/chart_report.h"

#include "tests/testing.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using testing::input_error;

Chart small() {
  Chart chart;
  chart.name = "c", chart.against = "points";
  for (int k = 0; k < 2; ++k) {
    ChartPoint p;
    p.label = k ? "it's \"b\"" : "a", p.series = "s", p.kind = "points", p.method = "laterna";
    p.values = {{"points", 10 + k}};
    p.x = 10 + k, p.seeds = p.ok = 5, p.error_px = {1, 2.0 - k, 3}, p.bound_px = 1.5, p.seconds = 0.5 + k;
    p.bound = "cramer_rao";
    chart.points.push_back(p);
  }
  return chart;
}

TEST(ChartReport, KeepsTheContract) {
  const nlohmann::json json = chart_summary(small(), "s.toml", 1);
  const nlohmann::json& p = json.at("points").at(1);
  EXPECT_EQ(p.at("error_px"), 1);
  EXPECT_EQ(p.at("bound_px"), 1.5);
  EXPECT_EQ(p.at("seconds"), 1.5);
  EXPECT_EQ(p.at("spread_px"), 2);
  EXPECT_EQ(p.at("command"), "laterna chart 's.toml' --point 'it'\\''s \"b\"' -o it-s-b-");
  EXPECT_THAT(chart_summary(small(), "s.toml", 7)["points"][0]["command"].get<std::string>(),
              HasSubstr(" --seed 7 "));
  EXPECT_EQ(json.at("pareto"), nlohmann::json({"a", "it's \"b\""}));
  EXPECT_EQ(chart_json(small(), "s.toml", 1)["points"][0]["error_high_px"], 3);
  EXPECT_TRUE(chart_json(small(), "s.toml", 1)["points"][0]["error_mm"].is_null());
}

TEST(ChartReport, CsvHasALineForEachPoint) {
  const std::string csv = chart_csv(small());
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  EXPECT_THAT(csv, HasSubstr("\"it's \"\"b\"\"\",\"s\",laterna,5,5,0,0,0,1,1,3,,1.5,1.5,,,,0,\n"));
}

TEST(ChartReport, AReferenceIsReadBack) {
  const Chart back = read_chart_reference(chart_reference(small()).dump(), "r.json");
  ASSERT_EQ(back.points.size(), 2u);
  EXPECT_TRUE(back.ratios);
  EXPECT_EQ(back.points[0].seconds, 1);
  EXPECT_EQ(back.points[1].seconds, 3);  // 1.5 s over 0.5 s
  EXPECT_EQ(chart_reference(back), chart_reference(small()));
  EXPECT_THAT(input_error([] { read_chart_reference("{}", "r.json"); }), HasSubstr("r.json: no reference"));
  EXPECT_THAT(input_error([] { read_chart_reference("[", "r.json"); }), HasSubstr("r.json: no reference"));
}

}  // namespace
}  // namespace laterna
