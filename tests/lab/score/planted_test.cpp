// A few random rigs of what tests/full/score_full_test.cpp does with many.
#include "tests/lab/score/confusion.h"
#include "tests/testing.h"

#include <gtest/gtest.h>

#include <iostream>

namespace laterna {
namespace {

TEST(Planted, MistakesInTwoRandomRigsAreNamed) {
  const auto verdicts = testing::planted_verdicts(2, testing::seed());
  for (const auto& [planted, rate] : testing::named_rates(verdicts)) {
    // Of the few that are fitted one or two may be too near the noise; half still tells a broken search.
    const bool is_fitted = planted == "keystone" || planted == "unconverged" || planted == "two mistakes";
    EXPECT_GE(rate, is_fitted ? 0.5 : 0.9) << planted;
  }
  EXPECT_EQ(testing::falsely_named(verdicts), 0);
  if (HasFailure()) testing::print_confusion(verdicts, std::cout);
}

}  // namespace
}  // namespace laterna
