// Every mistake in many random rigs: who is named, and how often.
#include "tests/lab/score/picture_confusion.h"
#include "tests/testing.h"

#include <gtest/gtest.h>

#include <iostream>

namespace laterna {
namespace {

TEST(ScoreFull, EachPlantedMistakeIsNamedFirst) {
  const auto verdicts = testing::planted_verdicts(15, testing::seed());
  testing::print_confusion(verdicts, std::cout);
  for (const auto& [planted, rate] : testing::named_rates(verdicts)) {
    // A projector's own mistakes that nothing is fitted for: no chance is left to them but another that is
    // the same by chance, once in thirty at most. What is fitted needs an error well above the noise.
    const bool is_fitted = planted == "keystone" || planted == "unconverged" || planted == "two mistakes";
    EXPECT_GE(rate, is_fitted ? 0.8 : 0.95) << planted;
  }
  EXPECT_EQ(testing::falsely_named(verdicts), 0);
}

TEST(ScoreFull, EachMistakeOfPicturesIsNamedFirst) {
  const auto verdicts = testing::picture_verdicts(12, testing::seed());
  testing::print_confusion(verdicts, std::cout);
  // Pictures that show something else leave little doubt: one in twenty by chance. Of the smallest overscan
  // of a small picture, the rounding to its pixels hides the one or the other.
  for (const auto& [planted, rate] : testing::named_rates(verdicts))
    EXPECT_GE(rate, planted == "overscan" ? 0.8 : 0.95) << planted;
  EXPECT_EQ(testing::falsely_named(verdicts), 0);
}

}  // namespace
}  // namespace laterna
