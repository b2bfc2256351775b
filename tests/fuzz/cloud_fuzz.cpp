// A cloud that is accepted is finite, and is written and read back the same where single precision holds it.
#include "sim/formats/point_cloud.h"
#include "tests/fuzz/fuzz.h"

#include <cmath>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  using namespace laterna;
  return fuzz::attempt([&] {
    const PointCloud cloud = read_point_cloud(fuzz::text_of(bytes, count), "fuzz.ply");
    fuzz::expect(!cloud.points.empty(), "an accepted cloud has points");
    for (const CloudPoint& p : cloud.points) {
      const double sum = std::abs(p.projector_px.x) + std::abs(p.projector_px.y) + std::abs(p.camera_px.x) +
                         std::abs(p.camera_px.y);
      if (!(sum < 1e38)) return;  // beyond a float
    }
    const PointCloud again = read_point_cloud(point_cloud_ply(cloud.points), "again.ply");
    fuzz::expect(again.points.size() == cloud.points.size(), "read(write(cloud)) has as many points");
    for (std::size_t i = 0; i < cloud.points.size(); ++i)
      fuzz::expect(again.points[i].x_world == cloud.points[i].x_world, "and the same places");
  });
}
