#include "render/exposure.h"

#include "sim/parallel.h"
#include "tests/render/rig.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

namespace laterna {
namespace {

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

constexpr int block = noise_pixels;

Sensor emva(int bit_depth, double gain, double dark_noise_e) {
  Sensor s;
  s.kind = SensorKind::emva1288, s.bit_depth = bit_depth, s.system_gain_dn_per_e = gain;
  s.dark_noise_e = dark_noise_e, s.dark_current_e_per_s = 0, s.dsnu_e = 0, s.prnu = 0;
  s.black_offset_dn = 16, s.full_well_e = 1e5, s.exposure_time_s = 0.1;
  return s;
}

// Pictures of a field of one level, pixels beside each other, picture after picture.
std::vector<double> flat_field(const Sensor& sensor, double level, int blocks, int pictures,
                               const NoiseKey& key = {testing::seed(), 0, 0}) {
  const Exposure exposure = make_exposure(sensor, 1, key);
  std::vector<float> levels(std::size_t(pictures) * block, float(level));
  std::vector<std::uint16_t> dn(levels.size());
  std::vector<double> field(dn.size() * blocks);
  for (int b = 0; b < blocks; ++b) {
    expose(exposure, std::uint32_t(b * block), pictures, levels.data(), dn.data());
    for (int k = 0; k < pictures; ++k)
      std::copy_n(dn.data() + k * block, block, field.data() + (std::size_t(k) * blocks + b) * block);
  }
  return field;
}

struct Moments {
  double mean = 0, variance = 0;
};

Moments moments(const std::vector<double>& values) {
  Moments m;
  for (const double x : values) m.mean += x / double(values.size());
  for (const double x : values) m.variance += (x - m.mean) * (x - m.mean) / double(values.size());
  return m;
}

// As EMVA 1288 measures it: the temporal variance is half that of the difference of two pictures.
Moments temporal_moments(const std::vector<double>& field, int pictures) {
  const std::size_t pixels = field.size() / pictures;
  Moments m;
  m.mean = moments(field).mean;
  for (int k = 0; k < pictures; k += 2) {
    std::vector<double> difference(pixels);
    for (std::size_t p = 0; p < pixels; ++p)
      difference[p] = field[k * pixels + p] - field[(k + 1) * pixels + p];
    m.variance += moments(difference).variance / pictures;
  }
  return m;
}

struct Transfer {
  double gain = 0, dark_noise_e = 0;
};

// The photon-transfer curve: σ_y² - σ_y,dark² = K·(μ_y - μ_y,dark), fitted through the origin with weights
// 1/σ⁴; 1/12 DN² of each variance is rounding.
Transfer photon_transfer(const Sensor& sensor, double greatest_level_e) {
  constexpr int pictures = 8, blocks = 600;
  const Moments dark = temporal_moments(flat_field(sensor, 0, blocks, pictures), pictures);
  double above = 0, below = 0;
  for (int i = 1; i <= 10; ++i) {
    const NoiseKey key{testing::seed() + i, 0, 0};
    const Moments lit =
        temporal_moments(flat_field(sensor, greatest_level_e * i / 10, blocks, pictures, key), pictures);
    const double signal = lit.mean - dark.mean, weight = 1 / (lit.variance * lit.variance);
    above += weight * signal * (lit.variance - dark.variance);
    below += weight * signal * signal;
  }
  return {above / below, std::sqrt(dark.variance - 1 / 12.0) / (above / below)};
}

// The statistical errors are below 0.2 % (10 × 154,000 differences).
TEST(Emva1288, ThePhotonTransferCurveReturnsGainAndDarkNoise) {
  Sensor s = emva(12, 0.5, 6);
  s.dsnu_e = 3, s.prnu = 0.01;
  Transfer t = photon_transfer(s, 7000);
  EXPECT_NEAR(t.gain, 0.5, 0.005);
  EXPECT_NEAR(t.dark_noise_e, 6, 0.06);
  s = emva(8, 0.1, 5);  // dark noise 0.5 DN; DSNU of 0.5 DN spreads the pixels over the steps
  s.dsnu_e = 5;
  t = photon_transfer(s, 2000);
  EXPECT_NEAR(t.gain, 0.1, 0.001);
  EXPECT_NEAR(t.dark_noise_e, 5, 0.05);
  s = emva(16, 2, 1);            // dim: nearly all is counted
  s.dark_current_e_per_s = 100;  // σ_d² = σ_d0² + 10 e of dark current
  t = photon_transfer(s, 40);
  EXPECT_NEAR(t.gain, 2, 0.02);
  EXPECT_NEAR(t.dark_noise_e, std::sqrt(11), 0.01 * std::sqrt(11));
}

TEST(Emva1288, MeanAndVarianceOnBothSidesOfThirtyElectrons) {
  for (const double level : {0.5, 10.0, 29.9, 30.1, 200.0}) {
    Sensor s = emva(16, 20, 2);
    s.black_offset_dn = 1000;  // room for the dark noise
    const Moments m = moments(flat_field(s, level, 500, 4));
    const double n = 500 * 4 * block, variance = level + 4;
    // Five standard errors; rounding to 1/20 electron does not count.
    EXPECT_NEAR((m.mean - 1000) / 20, level, 5 * std::sqrt(variance / n)) << level;
    EXPECT_NEAR(m.variance / 400, variance, 5 * variance * std::sqrt(3 / n)) << level;
  }
}

TEST(Emva1288, DarkCountsAreWholeElectrons) {
  for (const double dn : flat_field(emva(16, 100, 0), 3.3, 20, 4)) ASSERT_EQ(std::fmod(dn - 16, 100), 0);
}

TEST(Emva1288, DarkSignalNonUniformityBelongsToTheCamera) {
  Sensor s = emva(16, 10, 0);
  s.black_offset_dn = 5000, s.dsnu_e = 20;
  const auto map = [&](const NoiseKey& key) { return flat_field(s, 0, 400, 1, key); };
  const std::vector<double> one = map({1, 0, 0});
  const double n = double(one.size());
  EXPECT_NEAR(moments(one).mean, 5000, 5 * 200 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(moments(one).variance), 200, 5 * 200 / std::sqrt(2 * n));
  const std::vector<double> pictures = flat_field(s, 0, 400, 6, {2, 0, 5});
  for (std::size_t i = 0; i < pictures.size(); ++i) ASSERT_EQ(pictures[i], one[i % one.size()]);
  const std::vector<double> other = map({1, 1, 0});
  double product = 0;
  for (std::size_t i = 0; i < one.size(); ++i) product += (one[i] - 5000) * (other[i] - 5000) / 4e4;
  EXPECT_NEAR(product / n, 0, 5 / std::sqrt(n));
  s.nonuniformity_seed = 2;
  EXPECT_NE(map({1, 0, 0}), one);
}

TEST(Emva1288, PhotoResponseNonUniformityBelongsToTheCamera) {
  Sensor s = emva(16, 1, 0);
  s.prnu = 0.02;
  constexpr int pictures = 16, blocks = 100;
  const auto map = [&](const NoiseKey& key) {
    const std::vector<double> field = flat_field(s, 40000, blocks, pictures, key);
    std::vector<double> mean(std::size_t(blocks) * block, 0.0);
    for (std::size_t i = 0; i < field.size(); ++i)
      mean[i % mean.size()] += (field[i] - 16) / 40000 / pictures;
    return mean;
  };
  const std::vector<double> one = map({1, 0, 0}), again = map({2, 0, 0}), other = map({1, 1, 0});
  const double n = double(one.size()), left = 1 / (40000.0 * pictures);  // shot noise of the mean
  EXPECT_NEAR(moments(one).variance, 4e-4 + left, 5 * 4e-4 * std::sqrt(2 / n));
  double same = 0, crossed = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    same += (one[i] - 1) * (again[i] - 1) / n;
    crossed += (one[i] - 1) * (other[i] - 1) / n;
  }
  EXPECT_NEAR(same, 4e-4, 5 * 4e-4 * std::sqrt(2 / n));
  EXPECT_NEAR(crossed, 0, 5 * 4e-4 / std::sqrt(n));
}

TEST(Emva1288, TheFullWellEndsTheChargeButNotTheDarkNoise) {
  Sensor s = emva(16, 2, 0);
  s.full_well_e = 10000;
  for (const double dn : flat_field(s, 30000, 4, 5)) ASSERT_EQ(dn, 20016);
  // At a mean of the full well half of a normal distribution is cut: its mean falls by σ/√(2π).
  Moments m = moments(flat_field(s, 10000, 300, 4));
  EXPECT_NEAR(m.mean, 20016 - 200 / std::sqrt(2 * std::numbers::pi), 5 * 117 / std::sqrt(300 * 4 * block));
  s.dark_noise_e = 8;
  m = moments(flat_field(s, 30000, 300, 4));
  EXPECT_NEAR(m.mean, 20016, 5 * 16 / std::sqrt(300 * 4 * block));
  EXPECT_NEAR(m.variance, 256 + 1 / 12.0, 5 * 256 * std::sqrt(2.0 / (300 * 4 * block)));
  s.full_well_e = 20;  // less than counts reach
  s.dark_noise_e = 0;
  for (const double dn : flat_field(s, 29, 20, 4)) ASSERT_LE(dn, 56);
}

TEST(Emva1288, OffsetSaturationAndResponse) {
  Sensor s = emva(10, 1, 0);
  s.black_offset_dn = 37;
  for (const double dn : flat_field(s, 0, 2, 3)) ASSERT_EQ(dn, 37);
  for (const double dn : flat_field(s, 50000, 2, 3)) ASSERT_EQ(dn, 1023);
  s.black_offset_dn = 1023 / 4.0, s.response_exponent = 0.5;
  for (const double dn : flat_field(s, 0, 2, 3)) ASSERT_EQ(dn, 512);  // 511.5, halves up
  s.dark_noise_e = 1e4;                                               // far below and above the scale
  for (const double dn : flat_field(s, 0, 2, 3)) ASSERT_TRUE(dn >= 0 && dn <= 1023);
}

TEST(Emva1288, AutomaticExposureFillsTheScale) {
  Sensor s;
  s.kind = SensorKind::emva1288, s.bit_depth = 12, s.prnu = 0;
  const Exposure exposure = make_exposure(s, 250, {testing::seed(), 0, 0});
  ASSERT_TRUE(exposure.electrons.has_value());
  EXPECT_EQ(exposure.electrons->exposure_time_s, exposure_time_s(s, 250));
  const std::vector<float> levels(4 * block, float(0.8 * 250 * exposure.level_per_cd_per_m2()));
  double sum = 0;
  for (std::uint32_t b = 0; b < 200; ++b) {
    std::vector<std::uint16_t> dn(levels.size());
    expose(exposure, b * block, 4, levels.data(), dn.data());
    sum = std::accumulate(dn.begin(), dn.end(), sum);
  }
  EXPECT_NEAR(sum / (200 * 4 * block), 4 + 0.8 * (4095 - 4), 1);  // shot noise 36 DN/√51200: five times 0.16
  s.exposure_time_s = 0.01;
  EXPECT_EQ(make_exposure(s, 250, {}).electrons->exposure_time_s, 0.01);
  EXPECT_NEAR(exposure_time_s(s, make_exposure(s, 250, {}).saturation_cd_per_m2), 0.01, 1e-14);
}

TEST(Expose, IdealIsRoundedAndClampedAsBefore) {
  std::vector<float> levels(3 * block);
  for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = float(i) * 1.7f - 20.25f;
  std::vector<std::uint8_t> dn(levels.size());
  expose({8, 100, 0, {}}, 5, 3, levels.data(), dn.data());
  for (std::size_t i = 0; i < levels.size(); ++i)
    ASSERT_EQ(dn[i], int(std::clamp(levels[i], 0.f, 255.f) + 0.5f));
  EXPECT_DOUBLE_EQ((Exposure{8, 100, 0, {}}.level_per_cd_per_m2()), 2.55);
}

TEST(Expose, APixelDoesNotKnowItsBlock) {
  auto random = testing::generator();
  Sensor s = emva(16, 1, 2);
  s.dsnu_e = 1, s.prnu = 0.01, s.full_well_e = 30000, s.dark_current_e_per_s = 20;
  constexpr int pixels = 4 * block, pictures = 6;
  std::vector<float> field(std::size_t(pixels) * pictures);
  for (float& level : field) level = float(std::exp(std::uniform_real_distribution<>(-3, 11)(random)));
  const auto play = [&](const Sensor& sensor, int step) {
    const Exposure exposure = make_exposure(sensor, 1, {3, 0, 0});
    std::vector<std::uint16_t> out(field.size());
    for (int first = 0; first < pixels; first += step) {
      const int count = std::min(step, pixels - first);
      std::vector<float> levels(pictures * block, 123456.f);
      std::vector<std::uint16_t> dn(levels.size());
      for (int k = 0; k < pictures; ++k)
        std::copy_n(field.data() + k * pixels + first, count, levels.data() + k * block);
      expose(exposure, std::uint32_t(first), pictures, levels.data(), dn.data());
      for (int k = 0; k < pictures; ++k)
        std::copy_n(dn.data() + k * block, count, out.data() + k * pixels + first);
    }
    return out;
  };
  for (const int step : {1, 7, 33}) EXPECT_EQ(play(s, step), play(s, block));
  Sensor ideal;
  ideal.bit_depth = 16, ideal.noise_sigma_dn = 3;
  EXPECT_EQ(play(ideal, 13), play(ideal, block));
}

TEST(Expose, TheSameBitsForAnyThreads) {
  Scene scene = testing::scene_of({testing::object_of(plane(9, 9))},
                                  testing::device_at({0, 0, 2}, {0, 0, 0}, {333, 40}, 75),
                                  testing::device_at({0, 0, 2}, {0, 0, 0}, {8, 8}, 20));
  Sensor& sensor = scene.cameras[0].sensor;
  sensor.kind = SensorKind::emva1288;
  const testing::Traced traced(scene);
  PatternStack patterns = testing::constant_pattern({8, 8}, 7, 255);
  for (std::size_t i = 0; i < patterns.values.size(); ++i) patterns.values[i] = std::uint8_t(i * 37);
  const double saturation = testing::automatic_saturation(traced);
  const auto play = [&](int threads) {
    set_thread_count(threads);
    return std::get<ImageStack<std::uint8_t>>(capture_stack(traced.surface, traced.light, scene.projectors[0],
                                                            patterns, 0,
                                                            make_exposure(sensor, saturation, {5, 0, 0})))
        .values;
  };
  const auto one = play(1);
  EXPECT_EQ(play(2), one);
  EXPECT_EQ(play(7), one);
  set_thread_count(0);
}

}  // namespace
}  // namespace laterna
