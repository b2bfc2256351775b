#include "calib/peers/point_methods.h"

#include "calib/dlt.h"
#include "sim/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/calib3d.hpp>

#include <cmath>

namespace laterna {

namespace {

PointAnswer by_laterna(const Correspondences& c, glm::ivec2 size, const SolveOptions& options) {
  SolveResult r = solve(c, size, options);
  return {r.status, r.reason, std::move(r.estimate), r.predicted_volume_rms_px};
}

PointAnswer by_dlt(const Correspondences& c, glm::ivec2 size) {
  const DltResult r = dlt(c, size);
  if (r.status != DltStatus::ok) return {Status::refused, r.reason, {}, 0};
  Device device;
  device.intrinsics = r.intrinsics;
  device.device_from_world = r.device_from_world;
  return {Status::ok, "", device, 0};
}

int flags_of(const std::string& lens_model) {
  int flags = cv::CALIB_USE_INTRINSIC_GUESS;
  if (lens_model == "LENSMODEL_OPENCV5") return flags;
  if (lens_model == "LENSMODEL_OPENCV4") return flags | cv::CALIB_FIX_K3;
  if (lens_model == "LENSMODEL_PINHOLE")
    return flags | cv::CALIB_FIX_K1 | cv::CALIB_FIX_K2 | cv::CALIB_FIX_K3 | cv::CALIB_ZERO_TANGENT_DIST;
  throw InputError(fmt::format("opencv: the lens {} is none of PINHOLE, OPENCV4 and OPENCV5", lens_model));
}

PointAnswer by_opencv(const Correspondences& c, glm::ivec2 size, const SolveOptions& options) {
  std::vector<std::vector<cv::Point3f>> world(1);
  std::vector<std::vector<cv::Point2f>> pixels(1);
  for (const glm::dvec3& x : c.world_points) world[0].emplace_back(float(x.x), float(x.y), float(x.z));
  for (const glm::dvec2& p : c.projector_pixels) pixels[0].emplace_back(float(p.x), float(p.y));
  cv::Mat k = (cv::Mat_<double>(3, 3) << 1.5 * size.x, 0, (size.x - 1) / 2.0, 0, 1.5 * size.x,
               (size.y - 1) / 2.0, 0, 0, 1);
  cv::Mat distortion = cv::Mat::zeros(5, 1, CV_64F);
  std::vector<cv::Mat> rotations, translations;
  try {
    cv::calibrateCamera(world, pixels, {size.x, size.y}, k, distortion, rotations, translations,
                        flags_of(options.lens_model),
                        {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 1000, 1e-12});
  } catch (const cv::Exception& error) {
    return {Status::refused, "OpenCV: " + error.err, {}, 0};
  }
  const auto vector = [](const cv::Mat& m) {
    return glm::dvec3(m.at<double>(0), m.at<double>(1), m.at<double>(2));
  };
  Device device;
  device.intrinsics = {size, k.at<double>(0, 0), k.at<double>(1, 1), k.at<double>(0, 2), k.at<double>(1, 2)};
  device.device_from_world = rigid_from_rotation_vector(vector(rotations[0]), vector(translations[0]));
  const int terms = options.lens_model == "LENSMODEL_PINHOLE"   ? 0
                    : options.lens_model == "LENSMODEL_OPENCV4" ? 4
                                                                : 5;
  device.lens.model = options.lens_model;
  device.lens.parameters.assign(distortion.ptr<double>(), distortion.ptr<double>() + terms);
  const bool finite = std::isfinite(device.intrinsics.fx) && std::isfinite(device.intrinsics.fy) &&
                      std::isfinite(device.device_from_world.translation.z) && device.intrinsics.fx > 0 &&
                      device.intrinsics.fy > 0;
  if (!finite) return {Status::refused, "OpenCV: the answer is not finite or mirrored", {}, 0};
  return {Status::ok, "", device, 0};
}

}  // namespace

std::vector<std::string> point_method_names() { return {"laterna", "dlt", "opencv"}; }

PointAnswer solve_points(const std::string& method, const Correspondences& c, glm::ivec2 size,
                         const SolveOptions& options) {
  validate(c);
  if (method == "laterna") return by_laterna(c, size, options);
  if (method == "dlt") return by_dlt(c, size);
  if (method == "opencv") return by_opencv(c, size, options);
  throw InputError(
      fmt::format("no method \"{}\", expected one of {}", method, fmt::join(point_method_names(), ", ")));
}

}  // namespace laterna
