#include "sim/instruction_sets.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

TEST(InstructionSets, ACapIsKeptAndLifted) {
  const std::string best = instruction_set();
  const auto names = instruction_set_names();
  EXPECT_THAT(names, ::testing::Contains(best));
  cap_instruction_set(names.front());
  EXPECT_EQ(instruction_set(), names.front());
  cap_instruction_set(best);
  EXPECT_EQ(instruction_set(), best);
  cap_instruction_set("");
  EXPECT_EQ(instruction_set(), best);
  EXPECT_EQ(embree_configuration(), "");
}

TEST(InstructionSets, AnUnknownNameIsRefused) {
  EXPECT_THAT(testing::input_error([] { cap_instruction_set("mmx"); }),
              ::testing::AllOf(::testing::StartsWith("instruction set: \"mmx\" was found, expected one of "),
                               ::testing::HasSubstr(instruction_set_names().back())));
}

}  // namespace
}  // namespace laterna
