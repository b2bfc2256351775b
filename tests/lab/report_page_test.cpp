#include "apps/lab/report/report_page.h"

#include "apps/lab/chart/chart_report.h"
#include "apps/lab/report/report_data.h"
#include "apps/lab/report/static_figures.h"
#include "apps/lab/report/svg_chart.h"
#include "apps/lab/report/thumbnails.h"
#include "sim/text_file.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace laterna {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using testing::input_error;
using ::testing::Not;
using testing::ScratchFolder;
using testing::write_text;

// A chart of two points, the second without an answer, as `laterna chart` leaves it.
std::string small_chart() {
  Chart chart{"small<1>", "seconds", false, {}, false, 2, 2};
  chart.points.resize(2);
  ChartPoint &good = chart.points[0], &none = chart.points[1];
  good.label = "a<b", none.label = "no answer";
  good.series = none.series = "a", good.kind = none.kind = "points", good.method = none.method = "laterna";
  good.values = none.values = json::object();
  good.seeds = good.ok = none.seeds = none.refused = 1;
  good.error_px = {0.4, 0.5, 0.6}, good.bound_px = 0.4, good.seconds = good.x = 1;
  return chart_json(chart, "</script>", 1).dump();
}

TEST(Base64, TestVectorsOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe"), "//4=");
  for (const char* bytes : {"", "f", "fo", "foo", "\xff\xfe"})
    EXPECT_EQ(bytes_of_data_uri("data:image/png;base64," + base64(bytes)), bytes);
  EXPECT_THAT(input_error([] { bytes_of_data_uri("https://x"); }), HasSubstr("no data URI"));
}

TEST(Thumbnails, BoxesGiveTheirMeanAndEdgesWhatIsInside) {
  ImageStack<std::uint16_t> stack(5, 2, 1);
  const std::vector<std::uint16_t> values{0, 1023, 100, 100, 1023, 0, 1023, 100, 100, 1023};
  std::copy(values.begin(), values.end(), stack.values.begin());
  const auto small = thumbnails(stack, 1023, 3);  // boxes of 2×2, the last one 1×2
  ASSERT_EQ(small.size(), 1U);
  EXPECT_EQ(small[0].width, 3);
  EXPECT_EQ(small[0].height, 1);
  EXPECT_THAT(small[0].values, ::testing::ElementsAre(128, 25, 255));  // 255·(1/2, 100/1023, 1), rounded
}

TEST(SvgChart, LeavesOutWhatCannotBeDrawn) {
  SvgChart chart{"t<1>", "x", "y", true, true, {}};
  chart.series.push_back(
      {SvgSeries::Kind::points, "s", "#000", {{1, 2, "here"}, {-1, 2}, {1, NAN}, {10, 3}}});
  const std::string svg = svg_chart(chart);
  EXPECT_THAT(svg, HasSubstr("t&lt;1&gt;"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  std::size_t circles = 0;
  for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1))
    ++circles;
  EXPECT_EQ(circles, 3U);  // two points, and the key
  chart.series[0].points = {{-1, 2}};
  EXPECT_THAT(svg_chart(chart), HasSubstr("no points"));
}

TEST(ReportData, TakesAChartAsItStands) {
  const ScratchFolder scratch;
  write_text(scratch / "chart.json", small_chart());
  const json data = report_data(scratch.path());
  EXPECT_EQ(data["charts"], json::array({json::parse(small_chart())}));
  ASSERT_EQ(data["verdicts"].size(), 1U);
  EXPECT_EQ(data["verdicts"][0]["facts"][0]["value"], 2);
  EXPECT_FALSE(data.contains("atlas"));
  ASSERT_EQ(static_figures(data).size(), 1U);
}

// Folders of the repository: every file of theirs is drawn, and what is drawn is what they say.
TEST(ReportData, TakesStoredReferences) {
  const json plans = report_data(testing::data_folder() / "plan");
  EXPECT_EQ(plans["plan_names"], json({"convex", "near_focus", "v_groove"}));
  EXPECT_EQ(plans["plans"][1],
            json::parse(read_text(testing::data_folder() / "plan/near_focus.json", 1 << 20)));
  EXPECT_EQ(static_figures(plans).size(), 3U);
  const json charts = report_data(testing::data_folder() / "charts");
  EXPECT_EQ(charts["charts"].size(), 6U);
  EXPECT_EQ(static_figures(charts).size(), 6U);
  const json atlas = report_data(testing::data_folder() / "atlas/standard.json");
  const json& cells = atlas["atlas_references"][0]["cells"];
  const auto is_counted = [](const json& cell) { return !cell["hidden"].get<bool>(); };
  EXPECT_EQ(std::count_if(cells.begin(), cells.end(), is_counted),
            atlas["atlas_references"][0]["summary"]["conditions"]);
  EXPECT_EQ(atlas["verdicts"][0]["status"], "ok");
}

TEST(ReportData, AnAtlasWhoseLettersDoNotCountUpIsRefused) {
  const ScratchFolder scratch;
  write_text(scratch / "a.json", R"({"conditions": 1, "seeds": 2, "hidden": {}, "letters": {"g: x=1": "rw"},
    "methods": {"laterna": {"right": 2, "weak": 0, "refused": 0, "silent": 0, "crashed": 0}}})");
  EXPECT_THAT(input_error([&] { report_data(scratch / "a.json"); }),
              HasSubstr("\"right\" says 2, but its letters count 1"));
}

TEST(ReportData, SaysWhatIsWrong) {
  const ScratchFolder scratch;
  EXPECT_THAT(input_error([&] { report_data(scratch / "none"); }), HasSubstr("no such file or folder"));
  EXPECT_THAT(input_error([&] { report_data(scratch.path()); }), HasSubstr("holds nothing to draw"));
  write_text(scratch / "chart.json", R"({"points": []})");
  EXPECT_THAT(input_error([&] { report_data(scratch.path()); }),
              HasSubstr("chart.json: has no key \"pareto\""));
  write_text(scratch / "chart.json", R"({"points": [{}], "pareto": [], "chart": "c", "against": "seconds"})");
  EXPECT_THAT(input_error([&] { report_data(scratch.path()); }), HasSubstr("key 'label' not found"));
  write_text(scratch / "chart.json", "{");
  EXPECT_THAT(input_error([&] { report_data(scratch.path()); }), HasSubstr("chart.json: no JSON"));
  write_text(scratch / "chart.json", small_chart());
  write_text(scratch / "result.json", R"({"projectors": [], "seconds": {}})");
  write_text(scratch / "figures.json", R"({"rig": {}, "points": [], "residuals": [], "projections": [],
    "views": [{"camera": "c", "projector": "p", "projector_size": [1, 1], "decoded": "../x.exr", "frames": []}]})");
  EXPECT_THAT(input_error([&] { report_data(scratch.path()); }), HasSubstr("figures.json"));
}

TEST(ReportPage, DataCannotLeaveTheirScript) {
  const ScratchFolder scratch;
  write_text(scratch / "chart.json", small_chart());
  const json data = report_data(scratch.path());
  const std::string page = report_page(data, write_text(scratch / "report.js", "draw();"));
  EXPECT_THAT(page, HasSubstr("<script>draw();</script>"));
  EXPECT_THAT(page, HasSubstr(R"(\u003c/script>)"));
  const std::size_t from = page.find("id=\"data\">") + 10;
  EXPECT_EQ(json::parse(page.substr(from, page.find("</script>", from) - from)), data);
}

TEST(ReportPage, StaticWithoutABundle) {
  const ScratchFolder scratch;
  write_text(scratch / "chart.json", small_chart());
  const std::string page = static_report_page(report_data(scratch.path()), StaticReason::no_bundle);
  EXPECT_THAT(page, HasSubstr("built without Node"));
  EXPECT_THAT(page, HasSubstr("<svg"));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
}

}  // namespace
}  // namespace laterna
