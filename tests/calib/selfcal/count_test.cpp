#include "calib/selfcal/count.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

using namespace laterna;
using ::testing::HasSubstr;

namespace {

TrackDevice known(const char* name) {
  return {name, {{1280, 1024}, 1800, 1800, 640, 512}, false, false, false};
}
TrackDevice unknown(const char* name, bool center, bool aspect = false) {
  return {name, {{1024, 768}, 0, 0, 512, 384}, true, aspect, center};
}

// A camera, and a projector in so many places. `points` lists which stations share how many.
Tracks stations(std::vector<TrackDevice> devices, int places,
                std::vector<std::pair<std::vector<int>, int>> points) {
  Tracks t;
  t.devices = std::move(devices);
  t.stations.push_back({0, "a"});
  for (int k = 0; k < places; ++k) t.stations.push_back({1, fmt::format("{}", k)});
  for (const auto& [set, count] : points) {
    for (int i = 0; i < count; ++i) {
      for (const int s : set) t.sightings.push_back({t.point_count(), s, {0, 0}, 1});
      t.point_names.push_back(fmt::format("{}", t.point_count()));
    }
  }
  return t;
}

// What the books say (Hartley and Zisserman, Multiple View Geometry, 17.1 and 18.1): m views of enough points
// have 11m - 15 degrees of freedom up to a projective frame, a calibrated rig 6m - 7.
TEST(NumberCount, LongTracks) {
  for (int m = 2; m <= 5; ++m) {
    std::vector<int> all;
    for (int s = 0; s < m; ++s) all.push_back(s);
    const NumberCount n =
        count_numbers(stations({known("camera"), unknown("projector", true)}, m - 1, {{all, 30}}));
    EXPECT_EQ(n.given, 11 * m - 15);
    EXPECT_EQ(n.places, 6 * m - 7);
    EXPECT_EQ(n.unlinked, 1);
    EXPECT_EQ(n.intrinsics, 3);
    EXPECT_EQ(n.enough(), m > 2) << m;
  }
}

TEST(NumberCount, PairsAloneGiveSevenEach) {
  const NumberCount n = count_numbers(
      stations({known("camera"), unknown("projector", true)}, 3, {{{0, 1}, 20}, {{0, 2}, 20}, {{0, 3}, 20}}));
  EXPECT_EQ(n.given, 21);
  EXPECT_EQ(n.places, 15);   // five each
  EXPECT_EQ(n.unlinked, 3);  // no baseline's length is linked to another's
  EXPECT_TRUE(n.enough());   // 3 + 15 = 18
}

TEST(NumberCount, ATriangleOfPairsHasOneScale) {
  Tracks t =
      stations({known("camera"), unknown("projector", false)}, 2, {{{0, 1}, 20}, {{0, 2}, 20}, {{1, 2}, 20}});
  const NumberCount n = count_numbers(t);
  EXPECT_EQ(n.places, 11);
  EXPECT_EQ(n.given, 18);  // 3·7 = 21, of which three are the compatibility of the three matrices: 11·3 - 15
}

TEST(NumberCount, OnePairCannotTellACenter) {
  const Tracks t = stations({known("camera"), unknown("projector", true)}, 1, {{{0, 1}, 500}});
  EXPECT_EQ(shortage_in_words(t, count_numbers(t)),
            "one pair gives 7 numbers; known camera with unknown f, c_x, c_y of projector needs 8");
}

TEST(NumberCount, OnePairTellsBothFocalLengths) {
  const Tracks t = stations({unknown("camera", false), unknown("projector", false)}, 1, {{{0, 1}, 7}});
  EXPECT_TRUE(count_numbers(t).enough());
  EXPECT_EQ(shortage_in_words(t, count_numbers(t)), "");
}

TEST(NumberCount, MovingTheSceneAddsNothing) {
  // The same two stations, twice as many points, however often the scene moved.
  const Tracks t = stations({known("camera"), unknown("projector", true)}, 1, {{{0, 1}, 500}, {{0, 1}, 500}});
  EXPECT_EQ(count_numbers(t).given, 7);
}

TEST(NumberCount, TooFewPoints) {
  const Tracks t = stations({known("camera"), unknown("projector", false)}, 1, {{{0, 1}, 5}});
  EXPECT_EQ(count_numbers(t).given, 5);  // one number each
  EXPECT_THAT(shortage_in_words(t, count_numbers(t)), HasSubstr("too few points: 5 that two stations share"));
}

TEST(NumberCount, StationsWithoutCommonPointsAreOpen) {
  const Tracks t = stations({known("camera"), unknown("projector", false)}, 2, {{{0, 1}, 50}});
  EXPECT_THAT(shortage_in_words(t, count_numbers(t)), HasSubstr("too few points"));
}

}  // namespace
