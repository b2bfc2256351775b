#include "calib/boards/correspondence_csv.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

BoardCapture parse(const std::string& text) {
  return parse_correspondence_csv(text, "t.csv", {640, 480}, {320, 240});
}

std::string refusal(const std::string& text) {
  return testing::input_error([&] { parse(text); });
}

const std::string header = "pose,corner,board_x,board_y,board_z,cam_x,cam_y,proj_x,proj_y,valid\n";

TEST(CorrespondenceCsv, ReadsBothDevices) {
  const BoardCapture c = parse(header + "3,7,1,2,0,10.5,20.25,30,40,1\n1,0,0,0,0,5,6,7,8,1\n");
  ASSERT_EQ(c.sightings.size(), 4u);
  EXPECT_EQ(c.pose_labels, (std::vector<int>{1, 3}));
  EXPECT_EQ(c.devices[0].name, "camera");
  EXPECT_EQ(c.devices[1].size, glm::ivec2(320, 240));
  const Sighting& s = c.sightings[1];
  EXPECT_EQ(s.device, 1);
  EXPECT_EQ(s.pose, 1);
  EXPECT_EQ(s.corner, 7);
  EXPECT_EQ(s.x_board, glm::dvec3(1, 2, 0));
  EXPECT_EQ(s.pixel, glm::dvec2(30, 40));
  EXPECT_EQ(c.sightings[0].pixel, glm::dvec2(10.5, 20.25));
  EXPECT_EQ(c.extent.center, glm::dvec2(0.5, 1));
}

TEST(CorrespondenceCsv, ColumnsByNameInAnyOrderAndOthersPassedOver) {
  const BoardCapture c = parse(
      "valid, proj_y ,proj_x,note,cam_y,cam_x,board_z,board_y,board_x,corner,pose\r\n"
      "1,40,30,hello,20,10,3,2,1,7,0\r\n\r\n");
  ASSERT_EQ(c.sightings.size(), 2u);
  EXPECT_EQ(c.sightings[0].pixel, glm::dvec2(10, 20));
  EXPECT_EQ(c.sightings[1].pixel, glm::dvec2(30, 40));
  EXPECT_EQ(c.sightings[0].x_board, glm::dvec3(1, 2, 3));
}

TEST(CorrespondenceCsv, UndecodedCornersStillCountForTheCamera) {
  const BoardCapture c =
      parse(header + "0,0,0,0,0,5,6,nan,nan,0\n0,1,1,0,0,5,6,,,0\n0,2,2,0,0,nan,nan,7,8,1\n");
  ASSERT_EQ(c.sightings.size(), 3u);
  EXPECT_EQ(c.sightings[0].device, 0);
  EXPECT_EQ(c.sightings[1].device, 0);
  EXPECT_EQ(c.sightings[2].device, 1);
}

TEST(CorrespondenceCsv, SaysWhereAndWhatIsWrong) {
  const std::string good = "0,0,0,0,0,5,6,7,8,1\n";
  EXPECT_THAT(refusal("pose,corner\n"), AllOf(HasSubstr("t.csv: line 1"), HasSubstr("board_x")));
  EXPECT_THAT(refusal(""), HasSubstr("t.csv: line 1"));
  EXPECT_THAT(refusal("pose," + header + good), HasSubstr("2 columns named \"pose\""));
  EXPECT_THAT(refusal(header + good + "0,1,0,0,0,5,6,7,8\n"),
              AllOf(HasSubstr("t.csv: line 3"), HasSubstr("found 9 cells, expected 10")));
  EXPECT_THAT(refusal(header + "0,1,0,x,0,5,6,7,8,1\n"),
              AllOf(HasSubstr("line 2"), HasSubstr("board_y is \"x\""), HasSubstr("finite number")));
  EXPECT_THAT(refusal(header + "0,1,0,inf,0,5,6,7,8,1\n"), HasSubstr("board_y is \"inf\""));
  EXPECT_THAT(refusal(header + "0,1,0,0,0,5,6,nan,8,1\n"), HasSubstr("proj_x is \"nan\""));
  EXPECT_THAT(refusal(header + "0,1,0,0,0,5,,7,8,1\n"), HasSubstr("cam_y is \"\""));
  EXPECT_THAT(refusal(header + "-1,1,0,0,0,5,6,7,8,1\n"), HasSubstr("pose is \"-1\""));
  EXPECT_THAT(refusal(header + "0.5,1,0,0,0,5,6,7,8,1\n"), HasSubstr("whole number"));
  EXPECT_THAT(refusal(header + "0,1,0,0,0,5,6,7,8,yes\n"), HasSubstr("valid is \"yes\", expected 0 or 1"));
  EXPECT_THAT(refusal(header + good + good), AllOf(HasSubstr("line 3"), HasSubstr("corner 0 twice")));
  EXPECT_THAT(refusal(header + "0,1,0,0,0,5,6,700,8,1\n"),
              AllOf(HasSubstr("projector"), HasSubstr("320x240")));
  EXPECT_THAT(refusal(header + std::string("0,1,0,0,0,5,6,7,8,1\0", 20)), HasSubstr("t.csv"));
}

TEST(CorrespondenceCsv, AMissingFileIsNamed) {
  EXPECT_THAT(testing::input_error([] {
                read_correspondence_csv("/no/such.csv", {1, 1}, {1, 1});
              }),
              HasSubstr("/no/such.csv"));
}

// What is written is read again to the last bit; a corner that the projector does not sight keeps its row.
TEST(CorrespondenceCsv, WrittenIsRead) {
  const BoardCapture c =
      parse(header + "3,7,1,2,0.1,10.512345678901234,20.25,30,40.1,1\n3,8,0.3,0,0,5,6,,,0\n");
  const BoardCapture again = parse(correspondence_csv(c));
  ASSERT_EQ(again.sightings.size(), 3u);
  EXPECT_EQ(again.pose_labels, c.pose_labels);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(again.sightings[k].device, c.sightings[k].device);
    EXPECT_EQ(again.sightings[k].corner, c.sightings[k].corner);
    EXPECT_EQ(again.sightings[k].x_board, c.sightings[k].x_board);
    EXPECT_EQ(again.sightings[k].pixel, c.sightings[k].pixel);
  }
}

TEST(CorrespondenceCsv, OneCameraAndOneProjectorAreWritten) {
  BoardCapture c = parse(header + "3,7,1,2,0,10,20,30,40,1\n");
  c.devices.push_back({"third", {10, 10}});
  EXPECT_THAT(testing::input_error([&] { correspondence_csv(c); }), HasSubstr("3 devices"));
}

}  // namespace
}  // namespace laterna
