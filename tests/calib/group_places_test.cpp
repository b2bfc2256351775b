#include "calib/group_places.h"

#include "calib/decode.h"
#include "tests/calib/pictures.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr glm::ivec2 camera{320, 200}, projector{256, 160};

PatternSequence sequence_of(PatternKind kind) {
  PatternSequence sequence{{}, projector};
  sequence.parameters.kind = kind;
  return sequence;
}

glm::dvec2 place(glm::dvec2 p) { return {0.75 * p.x + 0.04 * p.y + 4, 0.7 * p.y - 0.03 * p.x + 12}; }

// Pictures from `moved_from` on are of places `moved_px` further to the right.
ImageStack<std::uint8_t> pictures_of(const PatternSequence& sequence, int moved_from, double moved_px) {
  std::mt19937_64 random = testing::generator();
  ImageStack<std::uint8_t> stack = seen(sequence, camera, 3, place, 1, random);
  const ImageStack<std::uint8_t> moved = seen(
      sequence, camera, 3, [&](glm::dvec2 p) { return place(p) + glm::dvec2(moved_px, 0); }, 1, random);
  for (int k = moved_from; k < stack.count; ++k)
    std::copy(moved.picture(k).begin(), moved.picture(k).end(), stack.picture(k).begin());
  return stack;
}

std::vector<GroupPlace> places_of(const PatternSequence& sequence, int moved_from, double moved_px) {
  const ImageStack<std::uint8_t> stack = pictures_of(sequence, moved_from, moved_px);
  return group_places(stack, sequence, decode(stack, sequence, {}));
}

class GroupPlaces : public ::testing::TestWithParam<PatternKind> {};

// 0.05 px: half of what would be said; grids of three samples a pixel leave up to 0.02.
TEST_P(GroupPlaces, AgreeWhereNothingMoved) {
  const auto places = places_of(sequence_of(GetParam()), 1 << 20, 0);
  EXPECT_GE(places.size(), 4u);  // two of each axis at least
  for (const GroupPlace& p : places) EXPECT_NEAR(p.mean_px, 0, 0.05) << p.group.first;
  EXPECT_FALSE(farthest_apart(places));
}

// From the second group of columns on, pictures are of places 0.8 px away: that is what the first and the
// others differ by.
TEST_P(GroupPlaces, DifferByAMove) {
  const PatternSequence sequence = sequence_of(GetParam());
  const int moved_from = pattern_groups(sequence)[1].first;
  const auto apart = farthest_apart(places_of(sequence, moved_from, 0.8));
  ASSERT_TRUE(apart);
  EXPECT_EQ(apart->first.group.axis, 0);
  EXPECT_EQ(apart->first.group.first, 0);
  EXPECT_NEAR(std::abs(apart->first.mean_px - apart->second.mean_px), 0.8,
              0.15);  // an eighth of a stripe's edges
}

INSTANTIATE_TEST_SUITE_P(Families, GroupPlaces,
                         ::testing::Values(PatternKind::gray_phase, PatternKind::phase,
                                           PatternKind::multi_frequency));

TEST(GroupPlacesOf, FamiliesWithoutFringesOfTheirOwnAreNone) {
  for (const PatternKind kind : {PatternKind::gray, PatternKind::xor_gray, PatternKind::micro_phase})
    EXPECT_THAT(places_of(sequence_of(kind), 1 << 20, 0), IsEmpty());
}

TEST(FarthestApart, ComparesWithinAnAxisAndAboveChance) {
  const auto at = [](int axis, double mean, double sigma) {
    GroupPlace p;
    p.group.axis = axis, p.mean_px = mean, p.sigma_px = sigma;
    return p;
  };
  EXPECT_FALSE(farthest_apart({}));
  EXPECT_FALSE(farthest_apart({at(0, 0, 0.001), at(1, 5, 0.001)}));
  EXPECT_FALSE(farthest_apart({at(0, 0, 0.1), at(0, 0.7, 0.1)}));
  EXPECT_FALSE(farthest_apart({at(0, 0, 0.001), at(0, 0.09, 0.001)}));
  const auto apart = farthest_apart({at(0, 0, 0.001), at(0, 0.2, 0.001), at(0, -0.3, 0.001)});
  ASSERT_TRUE(apart);
  EXPECT_THAT((std::vector{apart->first.mean_px, apart->second.mean_px}), ElementsAre(0.2, -0.3));
}

}  // namespace
}  // namespace laterna
