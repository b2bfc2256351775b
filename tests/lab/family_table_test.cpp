#include "apps/lab/family_table.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace laterna {
namespace {

using ::testing::HasSubstr;

NamedPatterns family(const std::string& name) {
  const auto families = table_families();
  return *std::find_if(families.begin(), families.end(), [&](const auto& f) { return f.name == name; });
}

// Nothing may be silently wrong, or beyond its prediction with a mere flag.
void expect_honest(const FamilyCell& cell) {
  EXPECT_NE(cell.ending, Ending::silently_wrong) << family_table_text({cell});
  EXPECT_NE(cell.ending, Ending::flagged) << family_table_text({cell});
}

TEST(FamilyTable, WithoutFaultsAllAreRight) {
  for (const NamedPatterns& f : table_families()) {
    const FamilyCell cell = family_cell(f, Fault::none);
    EXPECT_EQ(cell.ending, Ending::right) << family_table_text({cell});
    EXPECT_TRUE(cell.flags.empty()) << family_table_text({cell});
  }
}

TEST(FamilyTable, FaultsAreRightOrSaidToBeDoubtful) {
  for (const char* name : {"gray", "gray_phase N=3", "gray_phase N=4", "multi_frequency", "micro_phase"}) {
    for (const Fault fault :
         {Fault::gamma, Fault::saturation, Fault::lost_fine, Fault::lost_coarse, Fault::moved_and_repeated})
      expect_honest(family_cell(family(name), fault));
  }
  for (const char* name : {"gray", "gray_phase N=4"}) {
    expect_honest(family_cell(family(name), Fault::defocus));
    expect_honest(family_cell(family(name), Fault::interreflection));
  }
}

TEST(FamilyTable, AMoveIsSaidWhereTheFirstPictureIsRepeated) {
  for (const char* name : {"gray", "gray_phase N=4"}) {
    const FamilyCell cell = family_cell(family(name), Fault::moved_and_repeated);
    EXPECT_EQ(cell.status, Status::weak);
    EXPECT_THAT(cell.reason, HasSubstr("moved between the first and the last picture"));
  }
}

}  // namespace
}  // namespace laterna
