#include "tests/lab/score/confusion.h"
#include "tests/testing.h"

#include <gtest/gtest.h>

#include <iostream>

namespace laterna {
namespace {

TEST(ScoreFull, PlantedMistakes) {
  const int rigs = std::getenv("RIGS") ? std::atoi(std::getenv("RIGS")) : 200;
  const auto verdicts = testing::planted_verdicts(rigs, testing::seed());
  testing::print_confusion(verdicts, std::cout);
}

}  // namespace
}  // namespace laterna
