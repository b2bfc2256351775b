#include "calib/selfcal/track_covariance.h"

#include "calib/covariance.h"

#include <Eigen/Dense>
#include <cmath>

namespace laterna {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Matrix = Eigen::MatrixXd;

std::vector<double> values_of(const RowMajor& m) { return {m.data(), m.data() + m.size()}; }

// Directions of the scaled columns that keep every unit baseline; orthonormal columns.
Matrix free_directions(const Tracks& tracks, const TrackRig& rig, const std::vector<UnitBaseline>& units,
                       const Eigen::VectorXd& scale) {
  Matrix g(scale.size(), Eigen::Index(units.size()));
  for (std::size_t i = 0; i < units.size(); ++i) {
    const std::vector<double> row = baseline_row(tracks, rig, units[i]);
    g.col(Eigen::Index(i)) = Eigen::Map<const Eigen::VectorXd>(row.data(), scale.size()).cwiseProduct(scale);
  }
  const Matrix q =
      Eigen::HouseholderQR<Matrix>(g).householderQ() * Matrix::Identity(scale.size(), scale.size());
  return q.rightCols(scale.size() - g.cols());
}

}  // namespace

TrackCovariance track_covariance(const Tracks& tracks, const TrackRig& rig,
                                 const std::vector<UnitBaseline>& units, double variance) {
  const int n = columns_of(tracks).count;
  const std::vector<double> factor = eliminated_factor(tracks, rig);
  const Eigen::Map<const RowMajor> all(factor.data(), n + 1, n + 1);
  const Matrix r = all.topLeftCorner(n, n);
  const std::vector<double> natural = natural_units(tracks, rig);
  const Eigen::VectorXd unit = Eigen::Map<const Eigen::VectorXd>(natural.data(), n);
  const Matrix z = free_directions(tracks, rig, units, unit);
  const Eigen::JacobiSVD<Matrix> svd(r * unit.asDiagonal() * z, Eigen::ComputeThinU | Eigen::ComputeFullV);
  const Eigen::VectorXd s = svd.singularValues();
  const Eigen::VectorXd weakest = z * svd.matrixV().rightCols(1);
  TrackCovariance c;
  c.smallest_gap = s[0] > 0 ? s[s.size() - 1] / s[0] : 0;
  c.weakest_direction = direction_in_words({weakest.data(), weakest.data() + n}, column_names(tracks));
  c.weakest_sigma = INFINITY;
  if (!(c.smallest_gap > 1e-10) || !s.allFinite()) return c;
  c.weakest_sigma = std::sqrt(variance) / s[s.size() - 1];
  const Matrix half = unit.asDiagonal() * z * svd.matrixV() * s.cwiseInverse().asDiagonal();
  c.global = values_of(variance * half * half.transpose());
  const Eigen::VectorXd step = -half * (svd.matrixU().transpose() * all.col(n).head(n));
  c.step.assign(step.data(), step.data() + n);
  return c;
}

double predicted_px(const Tracks& tracks, const TrackRig& rig, const std::vector<double>& covariance,
                    int station) {
  const TrackColumns columns = columns_of(tracks);
  const Eigen::Map<const RowMajor> c(covariance.data(), columns.count, columns.count);
  RowMajor rows(2, columns.count);
  double sum = 0, points = 0;
  for (const glm::dvec3& x : rig.points) {
    rows.setZero();
    if (std::isnan(x.x) || !predict(tracks, columns, rig, station, x, rows.data())) continue;
    sum += (rows * c * rows.transpose()).trace(), ++points;
  }
  return std::sqrt(sum / points);
}

bool scale_to(const KnownLength& length, const Tracks& tracks, double variance, TrackRig& rig,
              std::vector<double>& covariance) {
  const auto a = point_step(tracks, rig, length.point_a), b = point_step(tracks, rig, length.point_b);
  if (!a || !b) return false;
  const glm::dvec3 between = rig.points[length.point_a] - rig.points[length.point_b];
  const double distance = glm::length(between), scale = length.metres / distance;
  if (!(distance > 0)) return false;
  const glm::dvec3 u = between / distance;
  const TrackColumns columns = columns_of(tracks);
  const int n = columns.count;
  // δ log|AB| = along·δg + ε
  Eigen::RowVectorXd along = Eigen::RowVectorXd::Zero(n);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < n; ++j) along[j] += u[i] * (a->follow[i * n + j] - b->follow[i * n + j]) / distance;
  const double own = variance * glm::dot(u, (a->own + b->own) * u) / (distance * distance);
  Eigen::VectorXd translations = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd factor = Eigen::VectorXd::Ones(n);
  for (std::size_t s = 1; s < rig.station_from_first.size(); ++s) {
    rig.station_from_first[s].translation *= scale;
    for (int i = 0; i < 3; ++i) {
      translations[columns.station[s] + 3 + i] = rig.station_from_first[s].translation[i];
      factor[columns.station[s] + 3 + i] = scale;
    }
  }
  for (glm::dvec3& x : rig.points) x *= scale;
  const Matrix m = Matrix(factor.asDiagonal()) - translations * along;
  const Eigen::Map<const RowMajor> c(covariance.data(), n, n);
  covariance = values_of(m * c * m.transpose() + own * translations * translations.transpose());
  return true;
}

}  // namespace laterna
