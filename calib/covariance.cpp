#include "calib/covariance.h"

#include "sim/parallel.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::vector<double> values_of(const RowMajor& m) { return {m.data(), m.data() + m.size()}; }

// d_g in whitened parameters (J·R⁻¹ = Q, so H = I): (I - AᵀA)⁻¹·Aᵀr, or for few rows Aᵀ(I - AAᵀ)⁻¹·r. False
// where I - AᵀA is singular.
bool leave_out(const Eigen::MatrixXd& a, const Eigen::VectorXd& r, Eigen::VectorXd& d) {
  const bool few = a.rows() <= a.cols();
  const Eigen::Index size = few ? a.rows() : a.cols();
  Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(size, size);
  if (few)
    rest.noalias() -= a * a.transpose();
  else
    rest.noalias() -= a.transpose() * a;
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(rest);
  if (!(ldlt.vectorD().minCoeff() > 1e-9)) return false;
  if (few)
    d = a.transpose() * ldlt.solve(r);
  else
    d = ldlt.solve(a.transpose() * r);
  return true;
}

// What a robust loss adds to H = I in whitened parameters: Σ 2ρ''·(Jᵀr)(Jᵀr)ᵀ, where the rows hold √ρ'.
void add_curvature(const Eigen::MatrixXd& a, const Eigen::VectorXd& r, const RobustLoss& loss,
                   const double* s, Eigen::MatrixXd& curvature) {
  const Eigen::Index n = a.rows() / 2;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::VectorXd gradient = a.row(i).transpose() * r[i] + a.row(n + i).transpose() * r[n + i];
    const double weight = loss.weight(s[i]);
    curvature.noalias() += 2 * loss.weight_slope(s[i]) / (weight * weight) * gradient * gradient.transpose();
  }
}

// What a prior's own errors do to whitened parameters: Bᵀ·B of its rows B = [diag(1/sigma) 0]·R⁻¹.
Eigen::MatrixXd prior_part(const IntrinsicsPrior& prior, const Eigen::MatrixXd& r) {
  const Eigen::Index k = Eigen::Index(prior.mean.size());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(k, r.cols());
  for (Eigen::Index i = 0; i < k; ++i) rows(i, i) = prior.inverse_sigma[std::size_t(i)];
  const Eigen::MatrixXd b = r.triangularView<Eigen::Upper>().transpose().solve(rows.transpose());
  return b * b.transpose();
}

}  // namespace

std::optional<std::vector<double>> clustered_covariance(const PointTable& points, const LensGradient& lens,
                                                        const ProjectorState& state, const RobustLoss& loss,
                                                        const std::vector<double>& factor) {
  const int p = lens.parameter_count() + 6;
  const RowMajor full = Eigen::Map<const RowMajor>(factor.data(), p + 1, p + 1);
  const Eigen::MatrixXd r = full.topLeftCorner(p, p);
  const std::size_t clusters = points.cluster_count();
  // Batches of clusters with some 2000 points each, summed in order.
  std::vector<std::size_t> batch_begin{0};
  for (std::size_t g = 1; g <= clusters; ++g) {
    if (g == clusters || points.cluster_begin[g] - points.cluster_begin[batch_begin.back()] >= 2048)
      batch_begin.push_back(g);
  }
  const std::size_t batches = batch_begin.size() - 1;
  std::vector<Eigen::MatrixXd> sums(batches, Eigen::MatrixXd::Zero(p, p));
  std::vector<Eigen::MatrixXd> curvatures(batches, Eigen::MatrixXd::Zero(p, p));
  std::vector<char> failed(batches, 0);
  const bool robust = loss.kind != RobustLoss::Kind::none;
  const auto s = squared_residuals(points, lens, state);
  if (!s) return std::nullopt;
  parallel_for(batches, [&](std::size_t b) {
    Eigen::MatrixXd rows, a;
    Eigen::VectorXd d;
    for (std::size_t g = batch_begin[b]; g < batch_begin[b + 1]; ++g) {
      const std::size_t begin = points.cluster_begin[g], end = points.cluster_begin[g + 1], n = end - begin;
      rows.setZero(Eigen::Index(2 * n), p + 1);
      failed[b] |= !fill_rows(points, lens, state, loss, begin, end, {rows.data(), 2 * n, n});
      a = r.triangularView<Eigen::Upper>().transpose().solve(rows.leftCols(p).transpose()).transpose();
      failed[b] |= !leave_out(a, rows.col(p), d);
      if (failed[b]) return;
      sums[b].noalias() += d * d.transpose();
      if (robust) add_curvature(a, rows.col(p), loss, &(*s)[begin], curvatures[b]);
    }
  });
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(p, p), hessian = Eigen::MatrixXd::Identity(p, p);
  for (std::size_t b = 0; b < batches; ++b) {
    if (failed[b]) return std::nullopt;
    sum += sums[b];
    hessian += curvatures[b];
  }
  sum *= double(clusters - 1) / double(clusters);
  if (!points.prior.empty()) sum += prior_part(points.prior, r);
  if (robust) {
    const Eigen::LDLT<Eigen::MatrixXd> ldlt(hessian);
    if (!(ldlt.vectorD().minCoeff() > 0.01)) return std::nullopt;
    sum = ldlt.solve(ldlt.solve(sum).transpose()).eval();
  }
  const Eigen::MatrixXd half = r.triangularView<Eigen::Upper>().solve(sum);
  const RowMajor c = r.triangularView<Eigen::Upper>().solve(half.transpose());
  if (!c.allFinite()) return std::nullopt;
  return values_of((c + c.transpose()) / 2);
}

std::vector<double> world_covariance(const std::vector<double>& covariance, const Rigid& device_from_world,
                                     const WorldNormalisation& n) {
  const int p = int(std::lround(std::sqrt(double(covariance.size()))));
  const glm::dvec3 rc = device_from_world.rotation * n.center;
  RowMajor a = RowMajor::Identity(p, p);
  a.bottomRightCorner(3, 3) *= n.scale_m;
  a.block(p - 3, p - 6, 3, 3) << 0, -rc.z, rc.y, rc.z, 0, -rc.x, -rc.y, rc.x, 0;
  const RowMajor c = a * Eigen::Map<const RowMajor>(covariance.data(), p, p) * a.transpose();
  return values_of((c + c.transpose()) / 2);
}

Spectrum scaled_spectrum(const std::vector<double>& factor, int p) {
  const RowMajor full = Eigen::Map<const RowMajor>(factor.data(), p + 1, p + 1);
  Eigen::MatrixXd r = full.topLeftCorner(p, p);
  for (int j = 0; j < p; ++j) {
    const double length = r.col(j).norm();
    if (length > 0) r.col(j) /= length;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(r, Eigen::ComputeFullV);
  Spectrum spectrum;
  spectrum.singular_values.assign(svd.singularValues().data(), svd.singularValues().data() + p);
  const Eigen::VectorXd weakest = svd.matrixV().col(p - 1);
  spectrum.weakest.assign(weakest.data(), weakest.data() + p);
  return spectrum;
}

std::vector<std::string> parameter_names(int lens_parameters) {
  std::vector<std::string> names = {"fx", "fy", "cx", "cy"};
  for (int i = 0; i < lens_parameters; ++i) names.push_back("lens" + std::to_string(i));
  for (const char* kind : {"rotation_", "translation_"})
    for (const char* axis : {"x", "y", "z"}) names.push_back(std::string(kind) + axis);
  return names;
}

std::string direction_in_words(const std::vector<double>& direction, const std::vector<std::string>& names) {
  std::vector<std::size_t> order(direction.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(direction[a]) > std::abs(direction[b]);
  });
  const double largest = std::abs(direction[order[0]]);
  std::vector<std::string> chosen;
  for (const std::size_t i : order) {
    if (std::abs(direction[i]) > 0.4 * largest && chosen.size() < 4) chosen.push_back(names[i]);
  }
  if (chosen.size() == 1) return chosen[0] + " is hardly determined";
  std::string words = chosen[0];
  for (std::size_t i = 1; i < chosen.size(); ++i)
    words += (i + 1 == chosen.size() ? " and " : ", ") + chosen[i];
  return words + " trade off";
}

}  // namespace laterna
