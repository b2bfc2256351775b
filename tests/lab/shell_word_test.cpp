#include "apps/lab/shell_word.h"

#include <gtest/gtest.h>

namespace laterna {
namespace {

TEST(ShellWord, IsQuotedWhateverIsInIt) { EXPECT_EQ(shell_word("a 'b' $c"), R"('a '\''b'\'' $c')"); }

TEST(FolderName, KeepsLettersDigitsAndDots) {
  EXPECT_EQ(folder_name("few points: points=8 noise_px=0.2", "x"), "few-points-points-8-noise-px-0.2");
  EXPECT_EQ(folder_name("../..", "x"), "x");
}

}  // namespace
}  // namespace laterna
