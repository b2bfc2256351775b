#include "render/automatic_exposure.h"

#include "tests/render/rig.h"
#include "tests/testing.h"

#include <numbers>
#include <numeric>
#include <vector>

namespace laterna {
namespace {

// A row of 1000 pixels with albedo 0.5 and 1..1000 lx.
struct Row {
  SurfaceMap surface{1000, 1, {1000, 1}, {1000, 1}, {1000, 1}, {1000, 1}, {1000, 1}, {1000, 1}};
  LightMap light{1000, 1, {1000, 1}, {1000, 1}, {1000, 1}, {1000, 1}};
  Row() {
    std::fill(surface.object.values.begin(), surface.object.values.end(), 0u);
    std::fill(surface.albedo.values.begin(), surface.albedo.values.end(), 0.5f);
    std::fill(light.why.values.begin(), light.why.values.end(), std::uint8_t(Unlit::lit));
    std::iota(light.white_lx.values.begin(), light.white_lx.values.end(), 1.0);
  }
};

double saturation(const std::vector<const Row*>& lit, double ambient_lx) {
  std::vector<ImageRows> images;
  for (const Row* row : lit)
    images.push_back({{1000, 1}, [row, ambient_lx](LightRows& rows) {
                        direct_rows(row->surface, row->light, {}, ambient_lx, rows);
                      }});
  return automatic_saturation_cd_per_m2(images);
}

TEST(AutomaticSaturation, ThePercentileStandsAtFourFifths) {
  Row row;
  const double one_lx = 0.5 / std::numbers::pi;
  EXPECT_DOUBLE_EQ(saturation({&row}, 0), 999 * one_lx / 0.8);
  EXPECT_DOUBLE_EQ(saturation({&row}, 7), 1006 * one_lx / 0.8);
  row.light.why.values[999] = std::uint8_t(Unlit::shadow);  // 999 lit: the ⌈998.001⌉-th
  EXPECT_DOUBLE_EQ(saturation({&row}, 0), 999 * one_lx / 0.8);
  const Row other;  // two projectors: 1999 values, the 1998th is 999
  EXPECT_DOUBLE_EQ(saturation({&row, &other}, 0), 999 * one_lx / 0.8);
}

TEST(AutomaticSaturation, WithoutLight) {
  Row row;
  std::fill(row.light.why.values.begin(), row.light.why.values.end(), std::uint8_t(Unlit::outside));
  EXPECT_DOUBLE_EQ(saturation({&row}, 8), 4 / std::numbers::pi / 0.8);
  EXPECT_EQ(saturation({&row}, 0), 1);
  EXPECT_EQ(saturation({}, 0), 1);
}

}  // namespace
}  // namespace laterna
