#include "calib/selfcal/track_rig.h"

#include "calib/selfcal/adjust_tracks.h"
#include "tests/calib/selfcal/synthetic_tracks.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <Eigen/Dense>

using namespace laterna;
using namespace laterna::testing;

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

TEST(TrackRig, RowsAreTheDerivatives) {
  auto random = generator();
  TrackTruth t = three_places(random, 5);
  t.tracks.devices[1].focal = t.tracks.devices[1].aspect = t.tracks.devices[1].center = true;
  const TrackColumns columns = columns_of(t.tracks);
  const glm::dvec3 x = t.rig.points[2];
  RowMajor rows = RowMajor::Zero(2, columns.count);
  predict(t.tracks, columns, t.rig, 2, x, rows.data());
  for (int i = 0; i < columns.count; ++i) {
    const double h = i < 4 ? 1e-2 : 1e-5;
    std::vector<double> step(columns.count, 0.0);
    step[i] = h;
    const auto plus = predict(t.tracks, columns, moved(t.tracks, t.rig, step), 2, x);
    step[i] = -h;
    const auto minus = predict(t.tracks, columns, moved(t.tracks, t.rig, step), 2, x);
    for (int k = 0; k < 2; ++k)  // central differences: h² of a third derivative, some 1e3·1e-10
      EXPECT_NEAR(rows(k, i), ((*plus)[k] - (*minus)[k]) / (2 * h), 1e-5) << columns.count << " " << i;
  }
}

TEST(TrackRig, EliminatedFactorIsTheSchurComplement) {
  auto random = generator();
  TrackTruth t = three_places(random, 40);
  forget(t.tracks, 1, true);
  t.rig.devices[1].fx += 3;  // residuals
  const TrackColumns columns = columns_of(t.tracks);
  const int n = columns.count, points = t.tracks.point_count();
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(2 * Eigen::Index(t.tracks.sightings.size()), n + 3 * points);
  for (std::size_t i = 0; i < t.tracks.sightings.size(); ++i) {
    const TrackSighting& s = t.tracks.sightings[i];
    RowMajor global = RowMajor::Zero(2, n), point(2, 3);
    predict(t.tracks, columns, t.rig, s.station, t.rig.points[s.point], global.data(), point.data());
    j.block(2 * Eigen::Index(i), 0, 2, n) = global / s.sigma_px;
    j.block(2 * Eigen::Index(i), n + 3 * s.point, 2, 3) = point / s.sigma_px;
  }
  const Eigen::MatrixXd h = j.transpose() * j;
  const Eigen::MatrixXd b = h.topRightCorner(n, 3 * points), p = h.bottomRightCorner(3 * points, 3 * points);
  const Eigen::MatrixXd schur = h.topLeftCorner(n, n) - b * p.ldlt().solve(b.transpose());
  const std::vector<double> factor = eliminated_factor(t.tracks, t.rig);
  const RowMajor r = Eigen::Map<const RowMajor>(factor.data(), n + 1, n + 1).topLeftCorner(n, n);
  // Normal equations keep half of the digits.
  EXPECT_LT((r.transpose() * r - schur).norm(), 1e-8 * schur.norm());
}

TEST(TrackRig, BaselineRowIsTheDerivative) {
  auto random = generator();
  const TrackTruth t = three_places(random, 5);
  const auto distance = [](const TrackRig& rig) {
    return glm::length(center_in_world(rig.station_from_first[3]) -
                       center_in_world(rig.station_from_first[1]));
  };
  const std::vector<double> row = baseline_row(t.tracks, t.rig, {1, 3});
  for (std::size_t i = 0; i < row.size(); ++i) {
    std::vector<double> step(row.size(), 0.0);
    step[i] = 1e-6;
    const double plus = distance(moved(t.tracks, t.rig, step));
    step[i] = -1e-6;
    EXPECT_NEAR(row[i], (plus - distance(moved(t.tracks, t.rig, step))) / 2e-6, 1e-8);  // rounding over 2e-6
  }
}

TEST(AdjustTracks, ReturnsToTheTruth) {
  auto random = generator();
  TrackTruth t = three_places(random, 50);
  forget(t.tracks, 1, true);
  const double unit = glm::length(t.rig.station_from_first[1].translation);
  for (Rigid& place : t.rig.station_from_first) place.translation /= unit;
  for (glm::dvec3& x : t.rig.points) x /= unit;
  std::normal_distribution<double> normal;
  std::vector<double> step(columns_of(t.tracks).count);
  for (std::size_t i = 0; i < step.size(); ++i) step[i] = (i == 0 ? 80 : i < 3 ? 30 : 0.01) * normal(random);
  TrackRig start = moved(t.tracks, t.rig, step);
  for (glm::dvec3& x : start.points) x *= 1 + 0.01 * normal(random);
  const auto a = adjust_tracks(t.tracks, start, {{0, 1}});
  ASSERT_TRUE(a && a->converged);
  EXPECT_LT(a->loss, 1e-12);  // rounding of pixels, squared, over 0.01 px²
  EXPECT_NEAR(a->rig.devices[1].cy, t.rig.devices[1].cy, 1e-5);
  EXPECT_NEAR(glm::length(a->rig.station_from_first[1].translation), 1, 1e-9);
}

TEST(AdjustTracks, APointBehindIsNoStart) {
  auto random = generator();
  TrackTruth t = one_pair(random, 10);
  t.rig.points[4].z = -1;
  EXPECT_FALSE(adjust_tracks(t.tracks, t.rig, {{0, 1}}));
}

}  // namespace
