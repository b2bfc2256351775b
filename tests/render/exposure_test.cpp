#include "render/exposure.h"

#include "tests/render/rig.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <numeric>

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

TEST(AutomaticSaturation, ThePercentileStandsAtFourFifths) {
  Row row;
  const double one_lx = 0.5 / std::numbers::pi;
  EXPECT_DOUBLE_EQ(automatic_saturation_cd_per_m2(row.surface, {&row.light, 1}, 0), 999 * one_lx / 0.8);
  EXPECT_DOUBLE_EQ(automatic_saturation_cd_per_m2(row.surface, {&row.light, 1}, 7), 1006 * one_lx / 0.8);
  row.light.why.values[999] = std::uint8_t(Unlit::shadow);  // 999 lit: the ⌈998.001⌉-th
  EXPECT_DOUBLE_EQ(automatic_saturation_cd_per_m2(row.surface, {&row.light, 1}, 0), 999 * one_lx / 0.8);
  const Row other;  // two projectors: 1999 values, the 1998th is 999
  const LightMap both[] = {row.light, other.light};
  EXPECT_DOUBLE_EQ(automatic_saturation_cd_per_m2(row.surface, both, 0), 999 * one_lx / 0.8);
}

TEST(AutomaticSaturation, WithoutLight) {
  Row row;
  std::fill(row.light.why.values.begin(), row.light.why.values.end(), std::uint8_t(Unlit::outside));
  EXPECT_DOUBLE_EQ(automatic_saturation_cd_per_m2(row.surface, {&row.light, 1}, 8),
                   4 / std::numbers::pi / 0.8);
  EXPECT_EQ(automatic_saturation_cd_per_m2(row.surface, {&row.light, 1}, 0), 1);
  EXPECT_EQ(automatic_saturation_cd_per_m2(row.surface, {}, 0), 1);
}

TEST(MakeExposure, TheSensorsOwnSaturationWinsAndBadOnesAreRefused) {
  EXPECT_EQ(make_exposure({12, 0.5, 30.0}, 5, {}).saturation_cd_per_m2, 30);
  EXPECT_EQ(make_exposure({12, 0.5, {}}, 5, {}).saturation_cd_per_m2, 5);
  EXPECT_EQ(make_exposure({12, 0.5, {}}, 5, {}).full_scale(), 4095);
  EXPECT_EQ(testing::input_error([] {
              make_exposure({7, 0, {}}, 5, {});
            }),
            "sensor: bit_depth is 7, expected 8 to 16");
  EXPECT_THAT(testing::input_error([] {
                make_exposure({8, -1, {}}, 5, {});
              }),
              ::testing::HasSubstr("noise_sigma_dn"));
  EXPECT_THAT(testing::input_error([] {
                make_exposure({8, 0, 0.0}, 5, {});
              }),
              ::testing::HasSubstr("saturation"));
}

}  // namespace
}  // namespace laterna
