#include "sim/formats/point_cloud.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using testing::input_error;

TEST(PointCloud, EachPointIsFortyBytesAfterTheHeader) {
  const std::string ply = point_cloud_ply({{{1, 2, 3}, {4, 5}, {6, 7}}, {{-1, 0.1, 0}, {0, 0}, {0, 0}}});
  EXPECT_THAT(ply, ::testing::StartsWith("ply\nformat binary_little_endian 1.0\nelement vertex 2\n"));
  const std::size_t body = ply.find("end_header\n") + std::strlen("end_header\n");
  ASSERT_EQ(ply.size() - body, 2u * (3 * 8 + 4 * 4));
  double x = 0;
  std::memcpy(&x, ply.data() + body + 40 + 8, sizeof x);
  EXPECT_EQ(x, 0.1);
  float camera_v = 0;
  std::memcpy(&camera_v, ply.data() + body + 36, sizeof camera_v);
  EXPECT_EQ(camera_v, 7);
}

TEST(PointCloud, ReadsBackWhatItWrites) {
  const std::vector<CloudPoint> points{{{1, 2, 3}, {4.5, 5}, {6, 7.25}}, {{-1, 0.1, 1e7}, {0, -1}, {0, 0}}};
  const PointCloud cloud = read_point_cloud(point_cloud_ply(points), "c.ply");
  EXPECT_TRUE(cloud.has_projector_px && cloud.has_camera_px);
  ASSERT_EQ(cloud.points.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(cloud.points[i].x_world, points[i].x_world);
    EXPECT_EQ(cloud.points[i].projector_px, points[i].projector_px);
    EXPECT_EQ(cloud.points[i].camera_px, points[i].camera_px);
  }
}

// As scanners write them: text, normals, colours, a list, faces, line ends of Windows; no pixels.
TEST(PointCloud, AForeignTextKeepsItsPointsAlone) {
  const PointCloud cloud = read_point_cloud(
      "ply\r\nformat ascii 1.0\r\ncomment by a scanner\r\nelement camera 1\r\nproperty int k\r\n"
      "element vertex 2\r\nproperty float nx\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\n"
      "property uchar red\r\nproperty list uchar int seen_by\r\nelement face 1\r\n"
      "property list uchar int vertex_indices\r\nend_header\r\n"
      "7\r\n0 1.5 -2 1e3 255 2 4 5\r\n0 0.1 0 -1 0 0\r\n3 0 1 1\r\n",
      "scan.ply");
  EXPECT_FALSE(cloud.has_projector_px || cloud.has_camera_px);
  ASSERT_EQ(cloud.points.size(), 2u);
  EXPECT_EQ(cloud.points[0].x_world, glm::dvec3(1.5, -2, 1000));
  EXPECT_EQ(cloud.points[1].x_world, glm::dvec3(0.1, 0, -1));
}

TEST(PointCloud, BigEndianFloatsWithProjectorPixelsAlone) {
  std::string bytes =
      "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property double z\nproperty ushort projector_u\nproperty short projector_v\nend_header\n";
  const auto append = [&](auto value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    std::reverse(raw, raw + sizeof value);
    bytes.append(raw, sizeof value);
  };
  append(0.5f), append(-2.0f), append(0.1), append(std::uint16_t(700)), append(std::int16_t(-1));
  const PointCloud cloud = read_point_cloud(bytes, "big.ply");
  EXPECT_TRUE(cloud.has_projector_px && !cloud.has_camera_px);
  EXPECT_EQ(cloud.points[0].x_world, glm::dvec3(0.5, -2, 0.1));
  EXPECT_EQ(cloud.points[0].projector_px, glm::dvec2(700, -1));
}

TEST(PointCloud, BadInputIsOneSentence) {
  const auto error = [](const std::string& bytes) {
    return input_error([&] { (void)read_point_cloud(bytes, "c.ply"); });
  };
  const auto ascii = [](const std::string& properties, const std::string& rows, int count = 1) {
    return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) + "\n" + properties +
           "end_header\n" + rows;
  };
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  EXPECT_THAT(error(""), HasSubstr("this is no PLY file"));
  EXPECT_THAT(error(ascii(xyz, "1.5 2.5\n")), HasSubstr("too few values"));
  EXPECT_THAT(error(ascii(xyz, "1 2 3 4\n")), HasSubstr("one value too many"));
  EXPECT_THAT(error(ascii(xyz, "1 2 3\n", 9)), HasSubstr("truncated"));
  EXPECT_THAT(error(ascii(xyz, "1 2 3\n1 2 3\n")), HasSubstr("follows the last record"));
  EXPECT_THAT(error(ascii(xyz, "1 2 nan\n")),
              HasSubstr("c.ply, line 8: `z` is nan, expected a finite number"));
  EXPECT_THAT(error(ascii(xyz, "1 inf 3\n")), HasSubstr("`y` is inf"));
  EXPECT_THAT(error(ascii(xyz, "1 one 3\n")), HasSubstr("`one`, expected a number"));
  EXPECT_THAT(error(ascii("property float x\nproperty float y\n", "1 2\n")), HasSubstr("lacks one of"));
  EXPECT_THAT(error(ascii("property list uchar float x\nproperty float y\nproperty float z\n", "1 2 3 4\n")),
              HasSubstr("lacks one of"));
  EXPECT_THAT(error(ascii(xyz + "property float camera_u\n", "1 2 3 4\n")),
              HasSubstr("one of camera_u and camera_v, expected both or neither"));
  EXPECT_THAT(error(ascii(xyz, "", 0)), HasSubstr("holds no points"));
  EXPECT_THAT(
      error("ply\nformat ascii 1.0\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n"),
      HasSubstr("holds no points"));
  const std::string whole = point_cloud_ply({{{1, 2, 3}, {4, 5}, {6, 7}}});
  EXPECT_THAT(error(whole.substr(0, whole.size() - 1)), HasSubstr("truncated"));
  EXPECT_THAT(error(whole + "x"), HasSubstr("1 bytes follow the last record"));
}

}  // namespace
}  // namespace laterna
