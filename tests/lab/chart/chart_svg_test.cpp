#include "apps/lab/chart/chart_svg.h"

#include "apps/lab/chart/log_axis.h"
#include "apps/lab/chart/svg.h"

#include <gmock/gmock.h>

#include <regex>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(LogAxis, ADecadeIsADecadeEverywhere) {
  const LogAxis axis{0.1, 1000, 100, 500};
  EXPECT_NEAR(axis.at(0.1), 100, 1e-9);
  EXPECT_NEAR(axis.at(1), 200, 1e-9);
  EXPECT_NEAR(axis.at(1000), 500, 1e-9);
}

TEST(LogAxis, SpansWhatCanBeDrawn) {
  const LogAxis axis = axis_around({NAN, 0, -1, INFINITY, 3, 300}, 0, 1);
  EXPECT_LT(axis.low, 3);
  EXPECT_GT(axis.low, 1.5);
  EXPECT_GT(axis.high, 300);
  EXPECT_LT(axis.high, 600);
  const LogAxis one = axis_around({5}, 0, 1);
  EXPECT_LT(one.low, 5);
  EXPECT_GT(one.high, 5);
  EXPECT_GE(one.high / one.low, 2);
  EXPECT_EQ(axis_around({}, 0, 1).high, 10);
}

TEST(LogAxis, TicksAreRoundAndInside) {
  const auto texts = [](const LogAxis& axis) {
    std::string all;
    for (const Tick& tick : ticks_of(axis)) all += tick.text + " ";
    return all;
  };
  EXPECT_EQ(texts({0.05, 200, 0, 1}), "0.1 1 10 100 ");
  EXPECT_EQ(texts({0.9, 30, 0, 1}), "1 2 5 10 20 ");
  EXPECT_EQ(texts({1.8, 5.5, 0, 1}), "2 3 5 ");
  EXPECT_EQ(texts({0.9e-12, 2, 0, 1}), "1e-12 1e-10 1e-08 1e-06 0.0001 0.01 1 ");
}

int count(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  return int(
      std::distance(std::sregex_iterator(text.begin(), text.end(), expression), std::sregex_iterator()));
}

Chart two_series() {
  Chart chart;
  chart.name = "a < b & \"c\"";
  for (int k = 0; k < 6; ++k) {
    ChartPoint p;
    p.series = k < 3 ? "first" : "second";
    p.label = p.series + std::to_string(k), p.kind = "points";
    p.values = {{"steps", k}};
    p.seeds = p.ok = 5, p.x = p.seconds = 0.01 * (k + 1),
    p.error_px = {0.8 / (k + 1), 1.0 / (k + 1), 1.2 / (k + 1)};
    p.bound_px = 0.7 / (k + 1);
    chart.points.push_back(p);
  }
  return chart;
}

TEST(ChartSvg, DrawsAMarkerAndAHintForEachPointAndNamesEachSeriesOnce) {
  const std::string svg = chart_svg(two_series());
  EXPECT_EQ(count(svg, "<circle [^>]*r=\"5\""), 3 + 1);  // of the first series, and the legend's
  EXPECT_EQ(count(svg, "<polygon"), 3 + 1);              // of the second
  EXPECT_EQ(count(svg, "<circle [^>]*r=\"10\""), 6);     // rings: all are on the front
  EXPECT_EQ(count(svg, "bound 0\\.7 px"), 1);
  EXPECT_EQ(count(svg, ">steps 4<"), 1);
  EXPECT_EQ(count(svg, ">second<"), 1);
  EXPECT_EQ(count(svg, "stroke-dasharray"), 2 + 1);  // a bound for each series, and the legend's
  EXPECT_THAT(svg, HasSubstr("a &lt; b &amp; &quot;c&quot;"));
  EXPECT_THAT(svg, HasSubstr(">seconds<"));
}

TEST(ChartSvg, WhatHasNoErrorIsCountedAndNotDrawn) {
  Chart chart = two_series();
  chart.points[0].error_px = {};
  chart.points[1].error_px.middle = 0;
  const std::string svg = chart_svg(chart);
  EXPECT_THAT(svg, HasSubstr("2 points gave no error"));
  EXPECT_EQ(count(svg, "<circle [^>]*r=\"5\""), 1 + 1);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf,")));
  EXPECT_THAT(chart_svg({}), HasSubstr("</svg>"));
}

TEST(Svg, TextIsEscaped) { EXPECT_EQ(xml_text("a<b>&\"\x01\n"), "a&lt;b&gt;&amp;&quot;\n"); }

}  // namespace
}  // namespace laterna
