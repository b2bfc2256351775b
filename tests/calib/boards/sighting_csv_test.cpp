#include "calib/boards/sighting_csv.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;

const std::vector<BoardDevice> devices = {
    {"left", {640, 480}, {}, true}, {"right", {640, 480}, {}, true}, {"beamer", {800, 600}}};
const std::string header = "device,pose,corner,board_x,board_y,board_z,x,y,sigma_px\n";

BoardCapture parse(const std::string& text) { return parse_sighting_csv(text, "rig.csv", devices); }

TEST(SightingCsv, ReadsALineForEachSighting) {
  const BoardCapture c = parse(header + "right,7,2,0.1,0.2,0,10.5,20,0.25\nbeamer,3,1,0,0,0.5,30,40.125,\n");
  ASSERT_EQ(c.sightings.size(), 2u);
  EXPECT_EQ(c.pose_labels, (std::vector<int>{3, 7}));
  EXPECT_EQ(c.sightings[0].device, 1);
  EXPECT_EQ(c.sightings[0].pose, 1);
  EXPECT_EQ(c.sightings[0].corner, 2);
  EXPECT_EQ(c.sightings[0].x_board, glm::dvec3(0.1, 0.2, 0));
  EXPECT_EQ(c.sightings[0].pixel, glm::dvec2(10.5, 20));
  EXPECT_EQ(c.sightings[0].sigma_px, 0.25);
  EXPECT_EQ(c.sightings[1].device, 2);
  EXPECT_EQ(c.sightings[1].sigma_px, 1);  // not told
}

TEST(SightingCsv, IsToldFromTheOtherTableByItsColumns) {
  EXPECT_TRUE(is_sighting_csv(header));
  EXPECT_TRUE(is_sighting_csv("x , device\n"));
  EXPECT_FALSE(is_sighting_csv("pose,corner,cam_x\ndevice\n"));
  EXPECT_FALSE(is_sighting_csv(""));
}

TEST(SightingCsv, WrittenIsRead) {
  const BoardCapture c =
      parse(header + "left,3,7,1,2,0.1,10.512345678901234,20.25,0.1\nbeamer,3,7,1,2,0.1,30,1e-17,0.3\n");
  const BoardCapture again = parse(sighting_csv(c));
  ASSERT_EQ(again.sightings.size(), 2u);
  EXPECT_EQ(again.pose_labels, c.pose_labels);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(again.sightings[k].device, c.sightings[k].device);
    EXPECT_EQ(again.sightings[k].x_board, c.sightings[k].x_board);
    EXPECT_EQ(again.sightings[k].pixel, c.sightings[k].pixel);
    EXPECT_EQ(again.sightings[k].sigma_px, c.sightings[k].sigma_px);
  }
}

TEST(SightingCsv, SaysWhereAndWhatIsWrong) {
  const auto error = [](const std::string& text) { return testing::input_error([&] { parse(text); }); };
  EXPECT_THAT(error(header + "middle,0,0,0,0,0,1,1,1\n"),
              HasSubstr("rig.csv: line 2: device is \"middle\", expected one of left, right, beamer"));
  EXPECT_THAT(error(header + "left,0,0,0,0,0,1,1,1\nleft,0,0,0,0,0,1,1,1\n"),
              HasSubstr("line 3: left has corner 0 of pose 0 twice"));
  EXPECT_THAT(error(header + "left,0,0,0,0,0,nan,1,1\n"), HasSubstr("x is \"nan\""));
  EXPECT_THAT(error(header + "left,0,0,0,0,0,1,1,-2\n"), HasSubstr("sigma is -2 px"));
  EXPECT_THAT(error("device,pose,corner\n"), HasSubstr("board_x"));
}

}  // namespace
}  // namespace laterna
