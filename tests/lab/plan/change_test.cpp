#include "apps/lab/plan/answer.h"

#include "calib/verify.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;

// A projector at the origin, its picture moved.
Answer answer(double cx, double cy = 99.5) {
  Device device;
  device.intrinsics = {{320, 200}, 400, 400, cx, cy};
  return {Status::ok, "", device};
}

std::vector<RoundTrip> trips(const std::vector<double>& cx) {
  std::vector<RoundTrip> all;
  for (const double c : cx) all.push_back({{answer(c)}, 1});
  return all;
}

const std::vector<std::vector<glm::dvec3>> volume{image_grid(answer(159.5).estimate, {1, 2, 3})};

// Moving the principal point moves every pixel of the volume as far.
TEST(Change, OfAShiftIsTheShift) {
  const Change c = change_between(volume, trips({10, 12, 11}), trips({13, 15, 14}));
  EXPECT_NEAR(c.change_px, 3, 1e-9);  // roundings of a few hundred pixels
  EXPECT_NEAR(c.mean_px, 3, 1e-9);
  EXPECT_NEAR(c.rms_px, 3, 1e-9);
  EXPECT_NEAR(c.doubt_px, 0, 1e-9);
  EXPECT_NEAR(c.spread_full_px, 1, 1e-9);  // the standard deviation of 10, 11, 12
}

TEST(Change, OfEqualAnswersIsZero) {
  const Change c = change_between(volume, trips({10, 12}), trips({10, 12}));
  EXPECT_EQ(c.change_px, 0);
  EXPECT_EQ(c.doubt_px, 0);
}

// Seeds 10, 12, 11 against 11, 10, 12: the same distribution, drawn anew. Differences 1, -2, 1 scatter by √3.
TEST(Change, NoiseDrawnAnewIsNoChangeButADoubt) {
  const Change c = change_between(volume, trips({10, 12, 11}), trips({11, 10, 12}));
  EXPECT_NEAR(c.change_px, 0, 1e-9);
  EXPECT_NEAR(c.doubt_px, 2, 1e-9);           // 2·√3/√3
  EXPECT_NEAR(c.rms_px, std::sqrt(2), 1e-9);  // √((1 + 4 + 1)/3)
  EXPECT_EQ(verdict_on(c, 2.1), Verdict::small);
  EXPECT_EQ(verdict_on(c, 1), Verdict::unsure);
}

TEST(Change, NoiseThatGrowsCounts) {
  const Change c = change_between(volume, trips({9, 10, 11}), trips({7, 10, 13}));
  EXPECT_NEAR(c.mean_px, 0, 1e-9);
  EXPECT_NEAR(c.change_px, 2, 1e-9);  // a spread of 3 in place of 1
}

TEST(Change, VerdictsLeaveRoomForDoubt) {
  Change c;
  c.change_px = 1, c.doubt_px = 0.2;
  EXPECT_EQ(verdict_on(c, 1.3), Verdict::small);
  EXPECT_EQ(verdict_on(c, 1.1), Verdict::unsure);
  EXPECT_EQ(verdict_on(c, 0.7), Verdict::large);
}

TEST(Change, TheProjectorThatChangesMostCounts) {
  std::vector<RoundTrip> full = trips({10, 10}), other = trips({11, 11});
  for (RoundTrip& t : full) t.answers.push_back(answer(50));
  for (RoundTrip& t : other) t.answers.push_back(answer(57));
  EXPECT_NEAR(change_between({volume[0], volume[0]}, full, other).change_px, 7, 1e-9);
  EXPECT_NEAR(change_between({volume[0], volume[0]}, other, full).change_px, 7, 1e-9);
}

TEST(Change, AWorseVerdictIsInfinitelyFar) {
  std::vector<RoundTrip> full = trips({10, 10}), other = trips({10, 10});
  other[1].answers[0].status = Status::weak, other[1].answers[0].reason = "too few";
  const Change c = change_between(volume, full, other);
  EXPECT_EQ(c.change_px, INFINITY);
  EXPECT_THAT(c.reason, HasSubstr("weak: too few"));
  EXPECT_EQ(verdict_on(c, 1e9), Verdict::large);
  full[1].answers[0].status = Status::weak;
  EXPECT_EQ(change_between(volume, full, other).change_px, 0);  // as weak as the full model's
  other[0].answers[0].status = Status::refused;
  EXPECT_EQ(change_between(volume, full, other).change_px, INFINITY);
}

TEST(Change, AnEstimateThatCannotMapTheVolumeIsInfinitelyFar) {
  std::vector<RoundTrip> other = trips({10, 10});
  other[0].answers[0].estimate.device_from_world.translation = {0, 0, -2};  // half of it lies behind
  const Change c = change_between(volume, trips({10, 10}), other);
  EXPECT_EQ(c.change_px, INFINITY);
  EXPECT_THAT(c.reason, HasSubstr("cannot map"));
}

TEST(RoundTrip, IsTheSameThroughJson) {
  RoundTrip trip{{answer(0.1 + 0.2), {Status::refused, "no overlap", {}}}, 0.25};
  trip.answers[0].estimate.lens = {"LENSMODEL_OPENCV4", {1.0 / 3, 2.0 / 7, 0, 1e-17}};
  trip.answers[0].estimate.device_from_world = rigid_from_rotation_vector({0.1, 0.2, 0.3}, {1.0 / 3, 2, 3});
  const RoundTrip back = round_trip_from(nlohmann::json::parse(round_trip_json(trip).dump()));
  ASSERT_EQ(back.answers.size(), 2u);
  EXPECT_EQ(back.seconds, 0.25);
  EXPECT_EQ(back.answers[1].reason, "no overlap");
  const Device &a = trip.answers[0].estimate, &b = back.answers[0].estimate;
  EXPECT_EQ(a.intrinsics.cx, b.intrinsics.cx);
  EXPECT_EQ(a.lens, b.lens);
  EXPECT_EQ(a.device_from_world.rotation, b.device_from_world.rotation);
  EXPECT_EQ(a.device_from_world.translation, b.device_from_world.translation);
}

}  // namespace
}  // namespace laterna
