// The static figures that are drawn by hand: maps, atlas, rig, axes.
#include "apps/lab/report/svg_atlas.h"
#include "apps/lab/report/svg_axes.h"
#include "apps/lab/report/svg_maps.h"
#include "apps/lab/report/svg_rig.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace laterna {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(SvgAxis, TicksAreRoundAndInside) {
  const SvgAxis axis = axis_over({-0.31, 0.42, NAN}, 100, 500);
  std::vector<std::string> words;
  for (const SvgTick& tick : ticks_on(axis)) words.push_back(tick.text);
  EXPECT_THAT(words, ::testing::ElementsAre("-0.2", "0", "0.2", "0.4"));
  EXPECT_DOUBLE_EQ(axis.at(axis.low), 100);
  EXPECT_DOUBLE_EQ(axis.at(axis.high), 500);
}

TEST(DirectionColour, IsAClosedWalk) {
  const double turn = 2 * std::numbers::pi;
  EXPECT_EQ(direction_colour(-0.5), direction_colour(turn - 0.5));
  EXPECT_EQ(direction_colour(0), "#d9a31f");
  EXPECT_NE(direction_colour(0), direction_colour(turn / 2));
}

// A residual along +u is a stroke to the right, one along +v a stroke downwards.
TEST(ResidualVectorsSvg, PointWhereTheyPoint) {
  const auto svg_of = [](double du, double dv) {
    return residual_vectors_svg(
        {{"camera", "c"}, {"projector", "p"}, {"rms_px", 1}, {"sample", {{50, 25, du, dv}}}}, {100, 50});
  };
  const auto stroke = [&](double du, double dv) {
    const std::string svg = svg_of(du, dv);
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    EXPECT_EQ(std::sscanf(svg.c_str() + svg.find("d=\"M"), "d=\"M%lf %lfL%lf %lf", &x0, &y0, &x1, &y1), 4);
    return glm::dvec2(x1 - x0, y1 - y0);
  };
  EXPECT_NEAR(glm::distance(stroke(1, 0), {14, 0}), 0, 0.1);  // coordinates have one digit
  EXPECT_NEAR(glm::distance(stroke(0, 1), {0, 14}), 0, 0.1);
}

TEST(ProjectionMapSvg, LeavesOutWhatHasNoNumber) {
  const auto cell = [](double u, const json& sigma) {
    return json{{"depth_m", 2}, {"u", u}, {"v", 10}, {"du", 1}, {"dv", 0}, {"sigma_px", sigma}};
  };
  const json p{
      {"projector", "p"}, {"depths_m", {2}}, {"grid", {cell(10, 0.5), cell(20, nullptr), cell(30, 0.2)}}};
  const std::string difference = projection_map_svg(p, {64, 48}, GridQuantity::difference);
  const std::string sigma = projection_map_svg(p, {64, 48}, GridQuantity::sigma);
  EXPECT_EQ(count_of(difference, "<rect"), count_of(sigma, "<rect") + 1);
  EXPECT_THAT(sigma, HasSubstr("0.5 px"));
  EXPECT_THAT(sigma, Not(HasSubstr("nan")));
}

json cell(const char* grid, int right, int weak, int silent, bool hidden = false) {
  return {{"grid", grid},        {"cell", std::string(grid) + ": <a>"},
          {"method", "laterna"}, {"hidden", hidden},
          {"right", right},      {"weak", weak},
          {"refused", 0},        {"silent", silent},
          {"crashed", 0}};
}

TEST(AtlasSvg, ACellIsItsWorstSeedOrWhatMostAre) {
  EXPECT_EQ(cell_outcome(cell("g", 19, 0, 1)), "silent");
  EXPECT_EQ(cell_outcome(cell("g", 9, 11, 0)), "weak");
  EXPECT_EQ(cell_outcome(cell("g", 10, 10, 0)), "right");
}

TEST(AtlasSvg, OneSquareForEachConditionAndOneRowForEachGrid) {
  const json cells{cell("few", 1, 0, 0), cell("many", 1, 0, 0), cell("few", 0, 1, 0),
                   cell("scale", 0, 0, 1, true)};
  const std::string svg = atlas_svg(cells, "laterna");
  EXPECT_EQ(count_of(svg, "<rect"), 4u + 5);  // and the key's
  EXPECT_EQ(count_of(svg, ">few</text>"), 1u);
  EXPECT_THAT(svg, HasSubstr("what no data can reveal"));
  EXPECT_THAT(svg, HasSubstr("few: &lt;a&gt;"));
  EXPECT_EQ(methods_of(cells), std::vector<std::string>{"laterna"});
}

TEST(RigSvg, DrawsAFrustumOfEightStrokesForEachDevice) {
  const json device{{"name", "p"},
                    {"size", {100, 50}},
                    {"fx", 100},
                    {"fy", 100},
                    {"cx", 49.5},
                    {"cy", 24.5},
                    {"device_from_world", {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}};
  const json rig{{"projectors", {device}}, {"cameras", json::array()}, {"meshes", json::array()}};
  const std::string svg = rig_svg(rig, {0, 0, 2});
  EXPECT_EQ(count_of(svg, "M"), 1u + 8);  // the point, and the frustum
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace laterna
