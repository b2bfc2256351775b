// Entries spread over the panel: light kept, borders, the screen door, and large discs in cells.
#include "render/panel_blur.h"

#include "tests/testing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace laterna {
namespace {

LightRows rows_of(const std::vector<LightEntry>& entries) {
  LightRows rows;
  rows.region = {0, 0, 1, 1};
  rows.begin = {0, std::uint32_t(entries.size())};
  rows.entries = entries;
  rows.ambient_cd_per_m2 = {0};
  return rows;
}

std::vector<LightEntry> spread(const std::vector<LightEntry>& entries, const PanelBlur& blur) {
  LightRows rows = rows_of(entries);
  spread_over_panel(rows, blur);
  EXPECT_EQ(rows.begin, (std::vector<std::uint32_t>{0, std::uint32_t(rows.entries.size())}));
  return rows.entries;
}

double total(const std::vector<LightEntry>& entries) {
  double sum = 0;
  for (const LightEntry& e : entries) sum += e.weight;
  return sum;
}

// Second moment along both axes about a point, over the light.
glm::dvec2 moment2(const std::vector<LightEntry>& entries, const glm::dvec2& center) {
  glm::dvec2 sum(0);
  for (const LightEntry& e : entries) {
    const glm::dvec2 d = glm::dvec2(e.u_px, e.v_px) - center;
    sum += e.weight * d * d;
  }
  return sum / total(entries);
}

const PanelBlur plain{{200, 100}};

TEST(PanelBlur, AFootprintKeepsItsLightPlaceAndWidth) {
  for (const float footprint : {0.5f, 3.5f, 25.0f}) {
    const std::vector<LightEntry> taps = spread({{80.3, 41.8, 2, footprint, 3}}, plain);
    EXPECT_NEAR(total(taps), 2, 1e-12);  // some 600 roundings of 1e-15
    EXPECT_TRUE(std::all_of(taps.begin(), taps.end(), [](const LightEntry& e) {
      return e.source == 3 && e.footprint_px == 0 && e.u_px == std::floor(e.u_px);
    }));
    if (footprint < 1) continue;  // all within a few pixels
    // A disc has d²/16 along each axis; pixels as boxes whose light counts at their centres add 1/12, up to
    // what the disc's outline cuts: a tenth of that at 3.5 px.
    const double expected = footprint * footprint / 16 + 1.0 / 12;
    EXPECT_NEAR(moment2(taps, {80.3, 41.8}).x, expected, 0.02);
    EXPECT_NEAR(moment2(taps, {80.3, 41.8}).y, expected, 0.02);
    // One entry for each pixel under the disc: its area and half of its outline's pixels, at most.
    EXPECT_LT(taps.size(), std::numbers::pi / 4 * (footprint + 1.5) * (footprint + 1.5));
  }
}

TEST(PanelBlur, APointStaysInItsPixel) {
  const std::vector<LightEntry> taps = spread({{80.3, 41.8, 2}}, plain);
  ASSERT_EQ(taps.size(), 1u);
  EXPECT_EQ(glm::dvec2(taps[0].u_px, taps[0].v_px), glm::dvec2(80, 42));
  EXPECT_EQ(taps[0].weight, 2);
}

TEST(PanelBlur, TheBorderIsSoft) {
  // Share of a disc on one side of a line t radii from its centre.
  const auto inside = [](double t) {
    return 0.5 + (std::asin(t) + t * std::sqrt(1 - t * t)) / std::numbers::pi;
  };
  for (const double beyond : {-4.0, -1.5, 0.0, 2.5, 4.9}) {
    const std::vector<LightEntry> taps = spread({{199.5 + beyond, 50, 1, 10}}, plain);
    EXPECT_NEAR(total(taps), inside(-beyond / 5), 1e-12) << beyond;  // roundings
    PanelBlur clamped = plain;
    clamped.clamp = true;
    EXPECT_NEAR(total(spread({{199.5 + beyond, 50, 1, 10}}, clamped)), 1, 1e-12);
  }
  EXPECT_TRUE(spread({{206, 50, 1, 10}}, plain).empty());
  EXPECT_TRUE(spread({{1e300, -1e300, 1, 10}}, plain).empty());
}

TEST(PanelBlur, ThePanelsScreenDoor) {
  PanelBlur door = plain;
  door.pixel_side = 0.6;
  EXPECT_NEAR(total(spread({{80.29, 42.2, 2}}, door)), 2 / 0.36, 1e-12);
  EXPECT_TRUE(spread({{80.31, 42.2, 2}}, door).empty());  // between pixels
  EXPECT_TRUE(spread({{80.2, 42.4, 2}}, door).empty());
  // Within the gap a small disc gets nothing, within a pixel the whole.
  EXPECT_TRUE(spread({{80.5, 42, 2, 0.3f}}, door).empty());
  EXPECT_NEAR(total(spread({{80, 42, 2, 0.3f}}, door)), 2 / 0.36, 1e-12);
  // A wide one levels the door out: what is left is the outline's share, a few of 1/(π·20²/4) px.
  EXPECT_NEAR(total(spread({{80.2, 42.7, 2, 20}}, door)), 2, 0.02);
  // The mean over the panel is kept: points in a grid that divides pixel and gap evenly.
  double sum = 0;
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 10; ++x)
      sum += total(spread({{80 + x / 10.0 - 0.45, 42 + y / 10.0 - 0.45, 1}}, door));
  EXPECT_NEAR(sum / 100, 1, 1e-12);  // roundings
}

TEST(PanelBlur, EntriesThatMeetBecomeOne) {
  const LightEntry a{80.3, 41.8, 2, 6}, b{81.9, 40.2, 1, 6}, far{10, 10, 1, 6};
  for (const auto& pair : {std::vector<LightEntry>{a, b}, std::vector<LightEntry>{a, far}}) {
    std::vector<LightEntry> both = spread(pair, plain), alone = spread({pair[0]}, plain);
    const std::vector<LightEntry> second = spread({pair[1]}, plain);
    alone.insert(alone.end(), second.begin(), second.end());
    EXPECT_LE(both.size(), alone.size());
    for (const LightEntry& tap : both) {
      double expected = 0;
      int same = 0;
      for (const LightEntry& e : alone)
        if (e.u_px == tap.u_px && e.v_px == tap.v_px) expected += e.weight;
      for (const LightEntry& e : both) same += e.u_px == tap.u_px && e.v_px == tap.v_px;
      EXPECT_NEAR(tap.weight, expected, 1e-15);  // one rounding of a sum of two
      EXPECT_EQ(same, 1);
    }
  }
}

TEST(PanelBlur, EntriesThatNearlyCoincideAreFoldedIntoOneDisc) {
  std::vector<LightEntry> rays;
  // The widest that is folded: rms √(2·0.39²·15/12) = 0.617 px of 20/32 = 0.625.
  for (int i = 0; i < 16; ++i) rays.push_back({80.3 + i % 4 * 0.39, 41.8 + i / 4 * 0.39, 1, 20});
  PanelBlur airy = plain;
  airy.discs = {{0.5, 0.7}, {1.0, 0.3}};
  const std::vector<LightEntry> taps = spread(rays, airy);
  EXPECT_NEAR(total(taps), 16, 1e-12);  // roundings
  // Along each axis the rays' own spread, 0.39²·(4² - 1)/12, and the disc's, with the point spread's.
  const double expected = 0.1901 + (400 + 0.7 * 0.25 + 0.3) / 16 + 1.0 / 12;
  EXPECT_NEAR(moment2(taps, {80.885, 42.385}).x, expected, 0.02);
  std::vector<double> difference(200 * 100, 0);
  const auto add = [&](const std::vector<LightEntry>& entries, double sign) {
    for (const LightEntry& e : entries) difference[int(e.v_px) * 200 + int(e.u_px)] += sign * e.weight / 16;
  };
  add(taps, 1);
  for (const LightEntry& ray : rays) add(spread({ray}, plain), -1);
  double sum = 0;
  for (const double d : difference) sum += std::abs(d);
  EXPECT_LT(sum / 2, 0.025);  // what left its pixel: as the header says
  EXPECT_GT(sum, 0.002);      // they were folded
}

TEST(PanelBlur, WideDiscsInCellsFavourNoStripes) {
  const PanelBlur wide{{1000, 1000}};
  const double diameter = 200;  // 7×7 pixels a cell
  const std::vector<LightEntry> taps = spread({{501.3, 498.8, 1, float(diameter)}}, wide);
  EXPECT_NEAR(total(taps), 1, 1e-12);
  EXPECT_LE(taps.size(), std::size_t((most_cells_across + 1) * (most_cells_across + 1)));
  // Cells of 7 px: where light counts is off by up to 3 px, evenly: 49/12.
  EXPECT_NEAR(moment2(taps, {501.3, 498.8}).x, diameter * diameter / 16, 30);
  for (const int period : {2, 4, 7, 14, 28}) {
    double columns = 0, rows = 0;
    for (const LightEntry& e : taps) {
      columns += int(e.u_px) % period < period / 2 ? e.weight : 0;
      rows += int(e.v_px) % period < period / 2 ? e.weight : 0;
    }
    // Half of the pixels are lit (3 of 7 for a period of 7). Of some 730 cells the outline's hundred are
    // uneven, and the disc itself is no whole number of periods.
    EXPECT_NEAR(columns, double(period / 2) / period, 0.03) << period;
    EXPECT_NEAR(rows, double(period / 2) / period, 0.03) << period;
  }
}

}  // namespace
}  // namespace laterna
