#include "calib/fringe_fit.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace laterna {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;
constexpr double mean_dn = 25000, modulation_dn = 20000, black_dn = 5000;

// `repeats` noisy pictures of one phase, then white and black; variance = read² + gain·(I - black).
ImageStack<std::uint16_t> fringe_pictures(int steps, int repeats, double turns, const SampleNoise& noise,
                                          std::mt19937_64& random) {
  ImageStack<std::uint16_t> stack(repeats, 1, steps + 2);
  std::normal_distribution<double> normal(0, 1);
  for (int k = 0; k < stack.count; ++k) {
    const double fringe = mean_dn + modulation_dn * std::cos(two_pi * (turns + double(k) / steps));
    const double light = k < steps ? fringe : mean_dn + (k == steps ? modulation_dn : -modulation_dn);
    const double variance = std::pow(noise.constant_dn, 2) + noise.variance_per_dn * (light - black_dn);
    for (std::uint16_t& value : stack.picture(k))
      value =
          std::uint16_t(std::lround(std::clamp(light + std::sqrt(variance) * normal(random), 0.0, 65000.0)));
  }
  for (std::uint16_t& black : stack.picture(steps + 1)) black = std::uint16_t(black_dn);
  return stack;
}

FringeFit fit(const ImageStack<std::uint16_t>& stack, int steps, const SampleNoise& noise,
              double full_scale_dn = 65535) {
  return fit_fringe(stack, {PatternGroup::Kind::fringe, 0, 0, steps, 0, 32}, noise, {full_scale_dn, 100, 5},
                    0, std::size_t(stack.width));
}

struct Sampled {
  double sigma_turns, predicted_turns;
};
Sampled sample(const FringeFit& f, double turns) {
  double sum = 0, squared = 0, predicted = 0;
  const double n = double(f.turns.size());
  for (std::size_t i = 0; i < f.turns.size(); ++i) {
    const double error = f.turns[i] - turns - std::round(f.turns[i] - turns);
    sum += error, squared += error * error, predicted += f.variance[i];
  }
  return {std::sqrt(squared / n - sum * sum / n / n), std::sqrt(predicted / n)};
}

TEST(FringeFit, ConstantNoiseGivesTheClosedForm) {
  auto random = testing::generator();
  for (const int steps : {3, 4, 8}) {
    const SampleNoise noise{600, 0};
    const Sampled s = sample(fit(fringe_pictures(steps, 8000, 0.3, noise, random), steps, noise), 0.3);
    const double closed = std::sqrt(2.0 / steps) * 600 / modulation_dn / two_pi;  // 2·σ²/(N·B²)
    EXPECT_NEAR(s.predicted_turns / closed, 1,
                0.02);                             // B is measured with noise, and 3 in 1000 seem to misfit
    EXPECT_NEAR(s.sigma_turns / closed, 1, 0.04);  // 8000 samples: 0.8 %
  }
}

TEST(FringeFit, ShotNoiseFollowsThePhase) {
  auto random = testing::generator();
  double least = 1e9, most = 0;
  for (const int steps : {3, 4, 8}) {
    for (const double turns : {0.02, 0.125, 0.25, 0.4375, 0.5, 0.8125}) {
      const SampleNoise noise{50, 20};
      const Sampled s = sample(fit(fringe_pictures(steps, 8000, turns, noise, random), steps, noise), turns);
      double variance = 0;  // 4/(N²B²)·Σ σ_j²·sin²(φ + δ_j), of the true light
      for (int j = 0; j < steps; ++j) {
        const double angle = two_pi * (turns + double(j) / steps);
        const double light = mean_dn - black_dn + modulation_dn * std::cos(angle);
        variance += (50 * 50 + 20 * light) * std::pow(std::sin(angle), 2);
      }
      const double closed = std::sqrt(4 * variance) / (steps * modulation_dn) / two_pi;
      EXPECT_NEAR(s.sigma_turns / closed, 1, 0.04) << steps << " " << turns;      // sampling
      EXPECT_NEAR(s.predicted_turns / closed, 1, 0.04) << steps << " " << turns;  // from noisy samples
      if (steps == 3) least = std::min(least, closed), most = std::max(most, closed);
    }
  }
  EXPECT_GT(most / least, 1.1);  // for N = 3 it does depend on the phase
}

TEST(FringeFit, LeavesOutWhatIsSaturated) {
  auto random = testing::generator();
  const SampleNoise noise{300, 0};
  for (const double turns : {0.05, 0.3, 0.77}) {
    ImageStack<std::uint16_t> stack = fringe_pictures(8, 8000, turns, noise, random);
    for (std::uint16_t& value : stack.values) value = std::min<std::uint16_t>(value, 38000);
    const FringeFit f = fit(stack, 8, noise, 38000);
    const Sampled s = sample(f, turns);
    EXPECT_NEAR(s.sigma_turns / s.predicted_turns, 1, 0.1) << turns;  // noise at the limit cuts off one side
    EXPECT_GT(s.predicted_turns, 1.02 * std::sqrt(2.0 / 8) * 300 / modulation_dn / two_pi);
  }
  ImageStack<std::uint16_t> stack = fringe_pictures(3, 10, 0.0, noise, random);
  for (std::uint16_t& value : stack.values) value = std::min<std::uint16_t>(value, 38000);
  for (const Reject why : fit(stack, 3, noise, 38000).why) EXPECT_EQ(why, Reject::saturated);
}

TEST(FringeFit, MisfitGrowsTheVariance) {
  auto random = testing::generator();
  const SampleNoise noise{100, 0};
  for (const int steps : {3, 4, 8}) {
    ImageStack<std::uint16_t> stack = fringe_pictures(steps, 100, 0.1, noise, random);
    const Sampled sound = sample(fit(stack, steps, noise), 0.1);
    std::copy_n(stack.picture(0).begin(), 100, stack.picture(1).begin());  // a dropped picture
    const FringeFit dropped = fit(stack, steps, noise);
    double error = 0;
    for (const float turns : dropped.turns) error += (turns - 0.1 - std::round(turns - 0.1)) / 100;
    const Sampled broken = sample(dropped, 0.1);
    EXPECT_GT(broken.predicted_turns, 10 * sound.predicted_turns) << steps;
    EXPECT_LT(std::abs(error), 3 * broken.predicted_turns) << steps;  // sigma covers it
  }
}

TEST(FringeFit, DimFringesAreRejected) {
  ImageStack<std::uint16_t> stack(5, 1, 6);
  std::fill(stack.values.begin(), stack.values.end(), std::uint16_t{1000});
  for (const Reject why : fit(stack, 4, {10, 0}).why) EXPECT_EQ(why, Reject::dim);
}

}  // namespace
}  // namespace laterna
