#include "calib/fringe_kernel.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace laterna {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

double wrapped(double turns) { return turns - std::round(turns); }

TEST(FringeKernel, TurnsAreThoseOfAtan2) {
  std::vector<float> c, s;
  for (int k = 0; k < 200003; ++k) {  // no multiple of a vector's lanes
    const double phase = two_pi * k / 200003, size = std::pow(10.0, k % 7 - 3);
    c.push_back(float(size * std::cos(phase))), s.push_back(float(size * std::sin(phase)));
  }
  std::vector<float> turns(c.size());
  turns_of(c.data(), s.data(), c.size(), turns.data());
  double worst = 0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    EXPECT_TRUE(turns[i] >= 0 && turns[i] < 1);
    worst = std::max(worst,
                     two_pi * std::abs(wrapped(turns[i] - std::atan2(double(s[i]), double(c[i])) / two_pi)));
  }
  EXPECT_LE(worst, 5e-6);  // the bound; the fit is good to 2.5e-7, single precision to 4e-7
  EXPECT_LE(worst, 1e-6);
}

TEST(FringeKernel, TurnsOnTheAxesAreExact) {
  const float c[] = {1, 0, -1, 0, 0}, s[] = {0, 1, 0, -1, 0};
  float turns[5];
  turns_of(c, s, 5, turns);
  EXPECT_THAT(turns, ::testing::ElementsAre(0.0f, 0.25f, 0.5f, 0.75f, 0.0f));
}

TEST(FringeKernel, FitsASinusoidExactly) {
  for (const int steps : {3, 4, 7}) {
    std::vector<std::uint16_t> samples[8];
    std::vector<const std::uint16_t*> pictures;
    std::vector<float> cosines, sines;
    for (int j = 0; j < steps; ++j) {
      const double shift = two_pi * j / steps;
      for (int i = 0; i < 37; ++i)
        samples[j].push_back(std::uint16_t(std::lround(30000 + 20000 * std::cos(two_pi * i / 37 + shift))));
      pictures.push_back(samples[j].data());
      cosines.push_back(float(2.0 / steps * std::cos(shift))),
          sines.push_back(float(-2.0 / steps * std::sin(shift)));
    }
    std::vector<float> mean(37), c(37), s(37), turns(37);
    fit_fringe(pictures.data(), steps, cosines.data(), sines.data(), 37,
               {mean.data(), c.data(), s.data(), turns.data()});
    for (int i = 0; i < 37; ++i) {
      EXPECT_NEAR(mean[i], 30000, 1);  // rounding of samples: 0.5 DN
      EXPECT_NEAR(std::hypot(c[i], s[i]), 20000, 1);
      EXPECT_NEAR(wrapped(turns[i] - i / 37.0), 0, 1e-5);  // 1 DN of 20000, over 2π
    }
  }
}

TEST(FringeKernel, ChoosesThePeriodByHand) {
  // Periods of 10 and 12 px: at 33 px the phases are 0.3 and 0.75 turns.
  const float first[] = {0.3f}, second[] = {0.75f}, weight[] = {1};
  float best, cost, runner_up;
  const PhaseWitness witness{second, weight, 12};
  choose_period({first, 10, -1, 6, -0.5f, 59.5f}, &witness, 1, 1, {&best, &cost, &runner_up});
  EXPECT_EQ(best, 3);
  EXPECT_NEAR(cost, 0, 1e-9);
  EXPECT_NEAR(runner_up, 4, 1e-4);  // one period on, the second phase is off by 2 px
}

}  // namespace
}  // namespace laterna
