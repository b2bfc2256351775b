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

bool all_in_front(const Rigid& device_from_points, const std::vector<cv::Point3d>& points) {
  return std::all_of(points.begin(), points.end(), [&](const cv::Point3d& q) {
    return apply(device_from_points, {q.x, q.y, q.z}).z > 0;
  });
}

// Points and where their rays meet the plane z = 1 of the device.
struct Rays {
  std::vector<cv::Point3d> x;
  std::vector<cv::Point2d> at;
};

Rays rays_of(const PointTable& points, const LensProjection& lens) {
  Rays rays;
  for (const std::size_t i : evenly_spread(points.size(), 500)) {
    const auto ray = lens.unproject({points.u[i], points.v[i]});
    if (!ray) continue;
    rays.x.emplace_back(points.x[i], points.y[i], points.z[i]);
    rays.at.emplace_back(ray->x, ray->y);
  }
  return rays;
}

double largest_sigma_px(const PointTable& points) {
  return 1 / *std::min_element(points.inverse_sigma.begin(), points.inverse_sigma.end());
}

Rays inliers_of(const Rays& rays, double threshold) {
  std::vector<int> kept;
  try {
    cv::Mat rotation, translation;
    cv::solvePnPRansac(rays.x, rays.at, cv::Matx33d::eye(), cv::noArray(), rotation, translation, false, 2000,
                       float(threshold), 0.9999, kept, cv::SOLVEPNP_AP3P);
  } catch (const cv::Exception&) {
    return {};  // no pose
  }
  Rays inliers;
  for (const int i : kept) inliers.x.push_back(rays.x[i]), inliers.at.push_back(rays.at[i]);
  return inliers;
}

// Those with every point in front; none where OpenCV finds none.
std::vector<Rigid> poses_by(cv::SolvePnPMethod method, const Rays& rays) {
  std::vector<cv::Mat> rotations, translations;
  try {
    cv::solvePnPGeneric(rays.x, rays.at, cv::Matx33d::eye(), cv::noArray(), rotations, translations, false,
                        method);
  } catch (const cv::Exception&) {
    return {};
  }
  std::vector<Rigid> poses;
  for (std::size_t k = 0; k < rotations.size(); ++k) {
    const Rigid pose = rigid_of(rotations[k], translations[k]);
    if (all_in_front(pose, rays.x)) poses.push_back(pose);
  }
  return poses;
}

}  // namespace

std::vector<ProjectorState> placement_starts(const PointTable& points, const ProjectorState& known,
                                             const LensProjection& lens, bool coplanar, bool robust) {
  Rays rays = rays_of(points, lens);
  if (robust) rays = inliers_of(rays, 5 * largest_sigma_px(points) / known.parameters[0]);
  std::vector<ProjectorState> starts;
  for (const cv::SolvePnPMethod method : {cv::SOLVEPNP_SQPNP, cv::SOLVEPNP_IPPE}) {
    if (method == cv::SOLVEPNP_IPPE && !coplanar) continue;
    for (const Rigid& pose : poses_by(method, rays)) starts.push_back({known.parameters, pose});
  }
  return starts;
}

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
      if (all_in_front(start.device_from_points, x)) starts.push_back(std::move(start));
    }
  }
  return starts;
}

}  // namespace laterna
