#include "calib/selfcal/tracks.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

using namespace laterna;
using namespace laterna::testing;
using ::testing::HasSubstr;

namespace {

TEST(Tracks, LabelsBecomeIndices) {
  const Tracks t = parse_tracks(
      "point,device,station,x,y,sigma_px\n"
      "b,camera,tripod,1,2,0.5\n"
      "b,projector,left,3,4,0.25\n"
      "a,projector,right,5.5,-6,0.1\n"
      "a,camera,tripod,7,8,0.5\n",
      "t.csv");
  ASSERT_EQ(t.devices.size(), 2u);
  ASSERT_EQ(t.station_count(), 3);
  EXPECT_EQ(t.station_name(2), "projector at right");
  EXPECT_EQ(t.point_names, (std::vector<std::string>{"b", "a"}));
  ASSERT_EQ(t.sightings.size(), 4u);
  EXPECT_EQ(t.sightings[2].station, 0);  // sorted by point, then station
  EXPECT_EQ(t.sightings[3].pixel, glm::dvec2(5.5, -6));
  EXPECT_TRUE(t.has_sigma);
  EXPECT_EQ(tracks_text(parse_tracks(tracks_text(t), "again")), tracks_text(t));
}

TEST(Tracks, StationsAreNamedForEachDevice) {
  const Tracks t = parse_tracks("point,device,station,x,y\n1,a,0,1,1\n1,b,0,2,2\n", "t.csv");
  EXPECT_EQ(t.station_count(), 2);
  EXPECT_FALSE(t.has_sigma);
}

TEST(Tracks, BadLinesAreNamed) {
  const std::string head = "point,device,station,x,y,sigma_px\n1,a,0,1,1,1\n";
  const auto message = [&](const std::string& line) {
    return input_error([&] { parse_tracks(head + line, "t.csv"); });
  };
  EXPECT_THAT(message("1,b,0,one,1,1\n"), HasSubstr("t.csv: line 3: x is \"one\", expected a finite number"));
  EXPECT_THAT(message("1,b,0,1,inf,1\n"), HasSubstr("y is \"inf\""));
  EXPECT_THAT(message("1,b,0,1,1,0\n"), HasSubstr("sigma_px is \"0\", expected a positive number"));
  EXPECT_THAT(message("1,b,0,1,1,\n"), HasSubstr("expected sigmas in all lines or in none"));
  EXPECT_THAT(message("1,a,0,2,2,1\n"), HasSubstr("a at 0 has point \"1\" twice"));
  EXPECT_THAT(message(",b,0,2,2,1\n"), HasSubstr("point is \"\", expected a name"));
  EXPECT_THAT(message("1,b,0,2,2\n"), HasSubstr("found 5 cells, expected 6"));
  EXPECT_THAT(input_error([] { parse_tracks("point,device,x,y\n", "t.csv"); }),
              HasSubstr("0 columns named \"station\""));
  EXPECT_THAT(input_error([] { parse_tracks("point,device,station,x,y\n", "t.csv"); }),
              HasSubstr("expected lines of sightings"));
}

TEST(Tracks, DevicesInWords) {
  const TrackDevice known = device_in_words("camera", {1280, 1024}, "1500,1501,640,512", "");
  EXPECT_EQ(known.free_count(), 0);
  EXPECT_EQ(known.intrinsics.fy, 1501);
  const TrackDevice d = device_in_words("projector", {1024, 768}, "", "focal+center");
  EXPECT_EQ(d.free_count(), 3);
  EXPECT_EQ(d.intrinsics.cx, 511.5);
  EXPECT_EQ(device_in_words("p", {1024, 768}, "", "focal", "512,760").intrinsics.cy, 760);
  const auto message = [](const char* known_words, const char* assumed, const char* center) {
    return input_error([&] { device_in_words("p", {1024, 768}, known_words, assumed, center); });
  };
  EXPECT_THAT(message("", "", ""), HasSubstr("found none of --known and --assume"));
  EXPECT_THAT(message("1,2,3,4", "focal", ""), HasSubstr("found both"));
  EXPECT_THAT(message("1,2,3", "", ""), HasSubstr("expected fx,fy,cx,cy"));
  EXPECT_THAT(message("-1,2,3,4", "", ""), HasSubstr("p"));
  EXPECT_THAT(message("", "center", ""), HasSubstr("assumed is \"center\""));
  EXPECT_THAT(message("", "focal+k1", ""), HasSubstr("assumed is \"focal+k1\""));
  EXPECT_THAT(message("", "focal", "1"), HasSubstr("expected cx,cy"));
}

}  // namespace
