#include "calib/bent_response.h"

#include <gtest/gtest.h>

namespace laterna {
namespace {

TEST(BentResponse, AStraightOneShiftsNothing) {
  for (const int steps : {3, 4, 8}) EXPECT_LT(bent_response_shift_px(0, steps, 64), 1e-6);  // γ by bisection
}

// γ = 2 is (1 + cos θ)²/4 = 3/8 + cos θ/2 + cos 2θ/8: the mean is off by 1/8, and with three steps the second
// harmonic is taken for a first one of a quarter of its size, running backwards: tan δ = sin 3θ/4 / (1 + cos
// 3θ/4), whose rms is sqrt(Σ_n (1/4)^2n/n²/2) = 0.17819 rad (log of 1 + z/4, harmonic by harmonic).
TEST(BentResponse, ASquareByHand) {
  EXPECT_NEAR(bent_response_shift_px(0.125, 3, 6.283185307179586), 0.17819, 1e-4);
  EXPECT_LT(bent_response_shift_px(0.125, 4, 64), 1e-6);  // no third harmonic
  EXPECT_NEAR(bent_response_shift_px(-0.125, 3, 64), bent_response_shift_px(0.125, 3, 64), 1e-12);
}

// g(2.2) = 1/2 - Γ(2.7)/(√π·Γ(3.2)); the shifts are the measured ones of the header.
TEST(BentResponse, GammaOfDisplays) {
  constexpr double rest = 0.1404;
  EXPECT_NEAR(bent_response_shift_px(rest, 3, 64), 2.1, 0.1);
  EXPECT_NEAR(bent_response_shift_px(rest, 4, 64), 0.08, 0.02);
  EXPECT_LT(bent_response_shift_px(rest, 8, 64), 0.002);
}

// The same by the exponent itself; encoded pictures, whose exponent is below 1, shift places as well.
TEST(ResponseShift, IsThatOfItsExponent) {
  EXPECT_NEAR(response_shift_px(2.2, 3, 64), 2.1, 0.1);
  EXPECT_NEAR(response_shift_px(2, 3, 6.283185307179586), 0.17819, 1e-4);  // the square by hand
  EXPECT_LT(response_shift_px(1, 3, 64), 1e-9);
  EXPECT_GT(response_shift_px(1 / 2.2, 3, 64), 0.5);
}

}  // namespace
}  // namespace laterna
