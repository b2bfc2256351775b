#include "sim/formats/point_cloud.h"

#include <gmock/gmock.h>

#include <cstring>

namespace laterna {
namespace {

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

}  // namespace
}  // namespace laterna
