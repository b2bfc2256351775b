#include "calib/selfcal/pair.h"

#include "sim/error.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <map>
#include <opencv2/calib3d.hpp>
#include <optional>

namespace laterna {

namespace {

using Matrix3 = Eigen::Matrix3d;

glm::dmat3 to_glm(const Matrix3& m) { return glm::make_mat3(m.data()); }
Matrix3 to_eigen(const glm::dmat3& m) { return Eigen::Map<const Matrix3>(glm::value_ptr(m)); }

std::optional<Matrix3> from_cv(const cv::Mat& m) {
  if (m.rows < 3 || m.cols != 3) return std::nullopt;
  Matrix3 out;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out(i, j) = m.at<double>(i, j);
  return out;
}

std::vector<cv::Point2d> cv_points(const std::vector<glm::dvec2>& pixels) {
  std::vector<cv::Point2d> points;
  for (const glm::dvec2& p : pixels) points.emplace_back(p.x, p.y);
  return points;
}

template <class T>
T sampson(const Eigen::Matrix<T, 3, 3>& f, const StationPair& p, std::size_t i) {
  const Eigen::Matrix<T, 3, 1> a(T(p.pixel_a[i].x), T(p.pixel_a[i].y), T(1)),
      b(T(p.pixel_b[i].x), T(p.pixel_b[i].y), T(1));
  const Eigen::Matrix<T, 3, 1> fa = f * a, fb = f.transpose() * b;
  const double va = p.sigma_a[i] * p.sigma_a[i], vb = p.sigma_b[i] * p.sigma_b[i];
  return b.dot(fa) / sqrt(vb * (fa[0] * fa[0] + fa[1] * fa[1]) + va * (fb[0] * fb[0] + fb[1] * fb[1]));
}

// F = Tbᵀ·U·diag(1, s, 0)·Vᵀ·Ta with U = U0·exp(u), V = V0·exp(v): seven numbers (Bartoli and Sturm 2004).
struct Orthonormal {
  const StationPair& pair;
  Matrix3 ta, tb, u0, v0;

  template <class T>
  Eigen::Matrix<T, 3, 3> matrix(const T* p) const {
    Eigen::Matrix<T, 3, 3> u, v;
    ceres::AngleAxisToRotationMatrix(p, u.data());
    ceres::AngleAxisToRotationMatrix(p + 3, v.data());
    Eigen::Matrix<T, 3, 3> d = Eigen::Matrix<T, 3, 3>::Zero();
    d(0, 0) = T(1), d(1, 1) = p[6];
    return (tb.transpose() * u0).template cast<T>() * u * d * v.transpose() *
           (v0.transpose() * ta).template cast<T>();
  }
};
struct SampsonResidual {
  const Orthonormal& form;
  std::size_t i;
  template <class T>
  bool operator()(const T* p, T* residual) const {
    residual[0] = sampson<T>(form.matrix(p), form.pair, i);
    return true;
  }
};

Matrix3 refine(const StationPair& pair, const Matrix3& start) {
  const Matrix3 ta = to_eigen(normalised_from_pixel(pair.pixel_a)),
                tb = to_eigen(normalised_from_pixel(pair.pixel_b));
  const Eigen::JacobiSVD<Matrix3> svd(tb.inverse().transpose() * start * ta.inverse(),
                                      Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Orthonormal form{pair, ta, tb, svd.matrixU(), svd.matrixV()};
  std::array<double, 7> p{0, 0, 0, 0, 0, 0, svd.singularValues()[1] / svd.singularValues()[0]};
  ceres::Problem problem;
  for (std::size_t i = 0; i < pair.size(); ++i)
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<SampsonResidual, 1, 7>(new SampsonResidual{form, i}), nullptr,
        p.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  const Matrix3 f = form.matrix<double>(p.data());
  return f / f.norm();
}

double rms(const std::vector<double>& values, double less) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / std::max(1.0, double(values.size()) - less));
}

// 1.4826 median |r|: the sigma of a normal law, whatever a minority does.
double robust_scale(std::vector<double> values) {
  for (double& v : values) v = std::abs(v);
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return 1.4826 * *middle;
}

std::optional<Matrix3> first_matrix(const StationPair& pair) {
  std::vector<double> sigmas;
  for (std::size_t i = 0; i < pair.size(); ++i)
    sigmas.push_back(std::hypot(pair.sigma_a[i], pair.sigma_b[i]));
  std::nth_element(sigmas.begin(), sigmas.begin() + std::ptrdiff_t(sigmas.size() / 2), sigmas.end());
  const double threshold = std::clamp(3 * sigmas[sigmas.size() / 2], 0.3, 5.0);
  const auto a = cv_points(pair.pixel_a), b = cv_points(pair.pixel_b);
  for (const int method : {int(cv::USAC_ACCURATE), int(cv::FM_LMEDS), int(cv::FM_8POINT)}) {
    try {
      auto f = from_cv(cv::findFundamentalMat(a, b, method, threshold, 0.9999, 5000));
      if (f && f->allFinite() && f->norm() > 0) return f;
    } catch (const cv::Exception&) {
    }
  }
  return std::nullopt;
}

double gric(const std::vector<double>& squared, int dimension, int parameters, double variance) {
  const double n = double(squared.size()), r = 4;
  double sum = dimension * n * std::log(r) + parameters * std::log(r * n);
  for (const double s : squared) sum += std::min(s / variance, 2 * (r - dimension));
  return sum;
}

// Squared transfer error of each point, in units of its covariance.
std::vector<double> transfer_errors(const StationPair& pair, const Matrix3& h) {
  std::vector<double> squared;
  for (std::size_t i = 0; i < pair.size(); ++i) {
    const Eigen::Vector3d y = h * Eigen::Vector3d(pair.pixel_a[i].x, pair.pixel_a[i].y, 1);
    const Eigen::Vector2d q = y.hnormalized(), e = Eigen::Vector2d(pair.pixel_b[i].x, pair.pixel_b[i].y) - q;
    const Eigen::Matrix2d j = (h.topLeftCorner<2, 2>() - q * h.block<1, 2>(2, 0)) / y.z();
    const Eigen::Matrix2d c = std::pow(pair.sigma_a[i], 2) * j * j.transpose() +
                              std::pow(pair.sigma_b[i], 2) * Eigen::Matrix2d::Identity();
    squared.push_back(e.dot(c.inverse() * e));
  }
  return squared;
}

}  // namespace

glm::dmat3 normalised_from_pixel(const std::vector<glm::dvec2>& pixels) {
  glm::dvec2 center(0.0);
  for (const glm::dvec2& p : pixels) center += p / double(pixels.size());
  double distance = 0;
  for (const glm::dvec2& p : pixels) distance += glm::length(p - center) / double(pixels.size());
  const double s = std::sqrt(2.0) / std::max(distance, 1e-12);
  return {s, 0, 0, 0, s, 0, -s * center.x, -s * center.y, 1};
}

std::vector<StationPair> station_pairs(const Tracks& tracks) {
  std::map<std::pair<int, int>, StationPair> pairs;
  const auto& all = tracks.sightings;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size() && all[j].point == all[i].point; ++j) {
      StationPair& p = pairs[{all[i].station, all[j].station}];
      p.a = all[i].station, p.b = all[j].station;
      p.points.push_back(all[i].point);
      p.pixel_a.push_back(all[i].pixel), p.pixel_b.push_back(all[j].pixel);
      p.sigma_a.push_back(all[i].sigma_px), p.sigma_b.push_back(all[j].sigma_px);
    }
  }
  std::vector<StationPair> result;
  for (auto& [stations, pair] : pairs)
    if (pair.size() >= 8) result.push_back(std::move(pair));
  return result;
}

StationPair kept(const StationPair& pair, const std::vector<char>& keep) {
  StationPair k{pair.a, pair.b, {}, {}, {}, {}, {}};
  for (std::size_t i = 0; i < pair.size(); ++i) {
    if (!keep[i]) continue;
    k.points.push_back(pair.points[i]);
    k.pixel_a.push_back(pair.pixel_a[i]), k.pixel_b.push_back(pair.pixel_b[i]);
    k.sigma_a.push_back(pair.sigma_a[i]), k.sigma_b.push_back(pair.sigma_b[i]);
  }
  return k;
}

std::vector<double> epipolar_residuals(const StationPair& pair, const glm::dmat3& fundamental) {
  const Matrix3 f = to_eigen(fundamental);
  std::vector<double> r;
  for (std::size_t i = 0; i < pair.size(); ++i) r.push_back(sampson<double>(f, pair, i));
  return r;
}

double fit_homography(const StationPair& pair, glm::dmat3& homography) {
  const auto h = from_cv(cv::findHomography(cv_points(pair.pixel_a), cv_points(pair.pixel_b), 0));
  if (!h || !h->allFinite()) return INFINITY;
  homography = to_glm(*h);
  double sum = 0;
  for (const double s : transfer_errors(pair, *h)) sum += s;
  return std::sqrt(sum / std::max(1.0, 2 * double(pair.size()) - 8));
}

PairGeometry pair_geometry(const StationPair& pair) {
  const auto start = first_matrix(pair);
  if (!start) throw Refusal("no fundamental matrix fits the points that two stations share");
  PairGeometry g;
  Matrix3 f = *start;
  for (int round = 0; round < 4; ++round) {
    const auto r = epipolar_residuals(pair, to_glm(f));
    const double limit = 4 * std::clamp(robust_scale(r), 1.0, 10.0);
    g.inlier.clear();
    for (const double v : r) g.inlier.push_back(std::abs(v) <= limit);
    g.inliers = std::size_t(std::count(g.inlier.begin(), g.inlier.end(), 1));
    if (g.inliers < 8)
      throw Refusal("fewer than 8 of the points that two stations share agree on where they stand");
    f = refine(kept(pair, g.inlier), f);
  }
  const StationPair good = kept(pair, g.inlier);
  g.fundamental = to_glm(f);
  const auto r = epipolar_residuals(good, g.fundamental);
  g.epipolar_scale = rms(r, 7);
  g.homography_scale = fit_homography(good, g.homography);
  if (!std::isfinite(g.homography_scale)) return g;
  std::vector<double> epipolar;
  for (const double v : r) epipolar.push_back(v * v);
  const double variance = std::max(1.0, g.epipolar_scale * g.epipolar_scale);
  g.homography_explains =
      gric(transfer_errors(good, to_eigen(g.homography)), 2, 8, variance) < gric(epipolar, 3, 7, variance);
  return g;
}

std::array<double, 2> squared_focal_lengths(const glm::dmat3& fundamental, const glm::dvec2& center_a,
                                            const glm::dvec2& center_b) {
  const auto of_a = [](const Matrix3& f, const Eigen::Vector3d& pa, const Eigen::Vector3d& pb) {
    const Eigen::JacobiSVD<Matrix3> svd(f, Eigen::ComputeFullU);
    const Eigen::Vector3d e = svd.matrixU().col(2);  // eᵀF = 0
    const Eigen::DiagonalMatrix<double, 3> flat(1, 1, 0);
    const Eigen::RowVector3d row = pb.cross(e).transpose() * flat;  // p_bᵀ[e]× = (p_b × e)ᵀ
    return -row.dot(f * pa) * pb.dot(f * pa) / row.dot(f * flat * f.transpose() * pb);
  };
  const Matrix3 f = to_eigen(fundamental);
  const Eigen::Vector3d pa(center_a.x, center_a.y, 1), pb(center_b.x, center_b.y, 1);
  return {of_a(f, pa, pb), of_a(f.transpose(), pb, pa)};
}

double axes_miss_px(const glm::dmat3& fundamental, const glm::dvec2& center_a, const glm::dvec2& center_b) {
  const glm::dvec3 a(center_a, 1), b(center_b, 1);
  const glm::dvec3 in_b = fundamental * a, in_a = glm::transpose(fundamental) * b;
  const double product = std::abs(glm::dot(b, in_b));
  return product / std::max({glm::length(glm::dvec2(in_a)), glm::length(glm::dvec2(in_b)), 1e-300});
}

}  // namespace laterna
