#include "calib/boards/projector_pixel.h"

#include "calib/median.h"

#include <Eigen/Dense>
#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace laterna {

namespace {

/// Decoded pixels of a disc, the camera's relative to its centre over the radius.
struct Disc {
  std::vector<cv::Point2d> at, projector_px;
  std::vector<double> weight;  // 1/σ
  std::size_t size() const { return at.size(); }
};

Disc disc_around(const DecodedMap& map, const glm::dvec2& centre, double radius) {
  Disc disc;
  const glm::ivec2 low = glm::max(glm::ivec2(glm::ceil(centre - radius)), glm::ivec2(0));
  const glm::ivec2 high =
      glm::min(glm::ivec2(glm::floor(centre + radius)), glm::ivec2(map.width, map.height) - 1);
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x; x <= high.x; ++x) {
      const glm::dvec2 at = (glm::dvec2(x, y) - centre) / radius;
      if (!map.valid(x, y) || glm::dot(at, at) > 1) continue;
      disc.at.emplace_back(at.x, at.y);
      disc.projector_px.emplace_back(map.u_px(x, y), map.v_px(x, y));
      disc.weight.push_back(1 / std::max(double(map.sigma_px(x, y)), 1e-6));
    }
  }
  return disc;
}

std::vector<double> residuals_of(const cv::Matx33d& h, const Disc& disc) {
  std::vector<double> residuals;
  for (std::size_t k = 0; k < disc.size(); ++k) {
    const cv::Vec3d p = h * cv::Vec3d(disc.at[k].x, disc.at[k].y, 1);
    residuals.push_back(cv::norm(cv::Point2d(p[0] / p[2], p[1] / p[2]) - disc.projector_px[k]));
  }
  return residuals;
}

/// What agrees with one homography; empty where none was found.
Disc agreeing(const Disc& disc) {
  const cv::Mat h = cv::findHomography(disc.at, disc.projector_px, cv::LMEDS);
  if (h.empty()) return {};
  const std::vector<double> residuals = residuals_of(cv::Matx33d(h), disc);
  const double most = std::max(1.0, 3 * median(residuals));
  Disc kept;
  for (std::size_t k = 0; k < disc.size(); ++k) {
    if (!(residuals[k] <= most)) continue;
    kept.at.push_back(disc.at[k]);
    kept.projector_px.push_back(disc.projector_px[k]);
    kept.weight.push_back(disc.weight[k]);
  }
  return kept;
}

bool is_around(const Disc& disc) {
  cv::Point2d sum(0, 0);
  for (const cv::Point2d& at : disc.at) sum += at;
  return cv::norm(sum) <= double(disc.size()) / 3;
}

ProjectorPixel read_quadratic(const Disc& disc) {
  const auto n = Eigen::Index(disc.size());
  Eigen::MatrixXd design(n, 6), right(n, 2);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto [x, y] = disc.at[std::size_t(k)];
    const double w = disc.weight[std::size_t(k)];
    design.row(k) << 1, x, y, x * x, x * y, y * y;
    right.row(k) << disc.projector_px[std::size_t(k)].x, disc.projector_px[std::size_t(k)].y;
    design.row(k) *= w, right.row(k) *= w;
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(design);
  const Eigen::MatrixXd coefficients = qr.solve(right), left = right - design * coefficients;
  const double chi2 = left.squaredNorm();
  double squares = 0;
  for (Eigen::Index k = 0; k < n; ++k)
    squares += left.row(k).squaredNorm() / std::pow(disc.weight[std::size_t(k)], 2);
  const Eigen::MatrixXd inverse = (design.transpose() * design).ldlt().solve(Eigen::MatrixXd::Identity(6, 6));
  return {.pixel = {coefficients(0, 0), coefficients(0, 1)},
          .slope = {{coefficients(1, 0), coefficients(1, 1)}, {coefficients(2, 0), coefficients(2, 1)}},
          .sigma_px = std::sqrt(inverse(0, 0) * chi2 / double(2 * n - 12)),
          .residual_px = std::sqrt(squares / double(n))};
}

// The homography of least squares; its sigma is that of a constant and a slope, σ²/n at the mean.
ProjectorPixel read_homography(const Disc& disc) {
  const cv::Mat h = cv::findHomography(disc.at, disc.projector_px, 0);
  if (h.empty()) return {.pixel = glm::dvec2(NAN)};
  const cv::Matx33d m(h);
  double squares = 0;
  for (const double r : residuals_of(m, disc)) squares += r * r;
  const double n = double(disc.size());
  const glm::dvec2 pixel(m(0, 2) / m(2, 2), m(1, 2) / m(2, 2));
  const auto slope = [&](int j) { return (glm::dvec2(m(0, j), m(1, j)) - pixel * m(2, j)) / m(2, 2); };
  return {.pixel = pixel,
          .slope = {slope(0), slope(1)},
          .sigma_px = std::sqrt(squares / (2 * n - 8) / n),
          .residual_px = std::sqrt(squares / n)};
}

}  // namespace

std::optional<ProjectorPixel> projector_pixel_at(const DecodedMap& map, const glm::dvec2& camera_px,
                                                 const LocalFitOptions& options) {
  const Disc all = disc_around(map, camera_px, options.radius_px);
  const int least = std::max(options.least_pixels, 8);
  if (int(all.size()) < least) return {};
  const Disc disc = agreeing(all);
  if (int(disc.size()) < least || !is_around(disc)) return {};
  ProjectorPixel read = options.map == LocalMap::quadratic ? read_quadratic(disc) : read_homography(disc);
  read.slope /= options.radius_px;  // the disc's coordinates are over its radius
  read.used = int(disc.size()), read.valid = int(all.size());
  const bool finite =
      std::isfinite(read.pixel.x) && std::isfinite(read.pixel.y) && std::isfinite(read.sigma_px);
  return finite ? std::optional(read) : std::nullopt;
}

}  // namespace laterna
