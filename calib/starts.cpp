#include "calib/starts.h"

#include <opencv2/calib3d.hpp>

#include <algorithm>

namespace laterna {

namespace {

Rigid rigid_of(const cv::Mat& rotation_vector, const cv::Mat& translation) {
  const auto vector = [](const cv::Mat& m) {
    return glm::dvec3(m.at<double>(0), m.at<double>(1), m.at<double>(2));
  };
  return rigid_from_rotation_vector(vector(rotation_vector), vector(translation));
}

}  // namespace

std::vector<ProjectorState> nominal_starts(const PointTable& points, glm::ivec2 size, int lens_parameters) {
  std::vector<cv::Point3d> x;
  std::vector<cv::Point2d> p;
  for (const std::size_t i : evenly_spread(points.size(), 500)) {
    x.emplace_back(points.x[i], points.y[i], points.z[i]);
    p.emplace_back(points.u[i], points.v[i]);
  }
  std::vector<ProjectorState> starts;
  const double cx = (size.x - 1) / 2.0, cy = (size.y - 1) / 2.0;
  for (const double throw_ratio : {0.5, 1.0, 2.0, 5.0, 15.0}) {
    const double f = throw_ratio * size.x;
    const cv::Matx33d camera(f, 0, cx, 0, f, cy, 0, 0, 1);
    std::vector<cv::Mat> rotations, translations;
    try {
      cv::solvePnPGeneric(x, p, camera, cv::noArray(), rotations, translations, false, cv::SOLVEPNP_SQPNP);
    } catch (const cv::Exception&) {
      continue;  // no pose for this focal length
    }
    for (std::size_t k = 0; k < rotations.size(); ++k) {
      ProjectorState start{{f, f, cx, cy}, rigid_of(rotations[k], translations[k])};
      start.parameters.resize(4 + lens_parameters, 0.0);
      const bool in_front = std::all_of(x.begin(), x.end(), [&](const cv::Point3d& q) {
        return apply(start.device_from_points, {q.x, q.y, q.z}).z > 0;
      });
      if (in_front) starts.push_back(std::move(start));
    }
  }
  return starts;
}

}  // namespace laterna
