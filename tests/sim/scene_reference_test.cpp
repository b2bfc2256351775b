#include "sim/scene_reference.h"

#include "sim/text_file.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

TEST(SceneReference, TheCommittedPageIsTheGeneratedOne) {
  const std::string committed = read_text(laterna::testing::data_folder() / "scene-reference.md", 1 << 20);
  EXPECT_TRUE(committed == scene_reference_markdown())
      << "regenerate it: laterna info --scene-reference > data/scene-reference.md";
}

TEST(SceneReference, NamesUnitsRangesAndDefaults) {
  const std::string page = scene_reference_markdown();
  EXPECT_THAT(page, ::testing::HasSubstr("| `albedo` |  | a number (0 to 1) | `0.8` |"));
  EXPECT_THAT(page, ::testing::HasSubstr("| `near` | m | a number (above 0 and at most 1e+09) |  |"));
  EXPECT_THAT(page,
              ::testing::HasSubstr("| `lookup` |  | one of \"nearest\", \"bilinear\" | `\"nearest\"` |"));
}

}  // namespace
}  // namespace laterna
