#include "apps/lab/cloud_table.h"

#include "calib/boards/correspondence_csv.h"
#include "calib/boards/sighting_csv.h"
#include "calib/correspondences.h"
#include "sim/error.h"

namespace laterna {

std::string cloud_table(const PointCloud& cloud, std::size_t most_points, const std::string& name) {
  BoardCapture capture;
  capture.pose_labels = {0};
  if (cloud.has_camera_px) capture.devices.push_back({"camera"});
  if (cloud.has_projector_px) capture.devices.push_back({"projector"});
  if (capture.devices.empty())
    throw InputError(name +
                     ": its points have no pixels to calibrate from, expected the properties projector_u and "
                     "projector_v, or camera_u and camera_v");
  int corner = 0;
  for (const std::size_t i : evenly_spread(cloud.points.size(), most_points)) {
    const CloudPoint& p = cloud.points[i];
    if (cloud.has_camera_px) capture.sightings.push_back({0, 0, corner, p.x_world, p.camera_px});
    if (cloud.has_projector_px)
      capture.sightings.push_back({int(capture.devices.size()) - 1, 0, corner, p.x_world, p.projector_px});
    ++corner;
  }
  return capture.devices.size() == 2 ? correspondence_csv(capture) : sighting_csv(capture);
}

}  // namespace laterna
