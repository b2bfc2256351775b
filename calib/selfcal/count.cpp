#include "calib/selfcal/count.h"

#include "calib/boards/rig.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <map>
#include <random>

namespace laterna {

namespace {

using Matrix = Eigen::MatrixXd;
using Matrix34 = Eigen::Matrix<double, 3, 4>;

// As many points of one set of stations as can add to the rank: 12 points of a pair, fewer of more stations,
// and one for each lens term.
constexpr int points_per_set = 12;

int lens_terms(const Tracks& tracks) {
  int count = 0;
  for (const TrackDevice& d : tracks.devices) count += d.lens_free_count();
  return count;
}

double uniform(std::mt19937_64& random) { return 2 * double(random() >> 11) * 0x1p-53 - 1; }

Eigen::Vector3d random_vector(std::mt19937_64& random) {
  const double x = uniform(random), y = uniform(random);
  return {x, y, uniform(random)};
}

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& w) {
  return Eigen::AngleAxisd(w.norm(), w.normalized()).toRotationMatrix();
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& w) {
  Eigen::Matrix3d m;
  m << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return m;
}

struct RandomRig {
  std::vector<Eigen::Matrix3d> intrinsics;  // one per device
  std::vector<Matrix34> places;             // one per station
  std::vector<std::vector<double>> lenses;  // one per device
};

RandomRig random_rig(const Tracks& tracks, std::mt19937_64& random) {
  RandomRig rig;
  for (std::size_t d = 0; d < tracks.devices.size(); ++d) {
    Eigen::Matrix3d k = Eigen::Matrix3d::Identity();
    k(0, 0) = k(1, 1) = 1.5 + 0.4 * uniform(random);
    k(0, 2) = 0.2 * uniform(random), k(1, 2) = 0.2 * uniform(random);
    rig.intrinsics.push_back(k);
  }
  for (const TrackDevice& d : tracks.devices) {
    rig.lenses.emplace_back();
    for (std::size_t i = 0; i < d.lens.parameters.size(); ++i)
      rig.lenses.back().push_back(0.3 * uniform(random));
  }
  for (int s = 0; s < tracks.station_count(); ++s) {
    Matrix34 place;
    place << rotation_of(0.8 * random_vector(random)), Eigen::Vector3d(0, 0, 4) + 0.7 * random_vector(random);
    rig.places.push_back(place);
  }
  return rig;
}

// Stations of each point, and how many points have the same; the points beyond points_per_set are left out.
std::vector<std::vector<int>> station_sets(const Tracks& tracks) {
  std::vector<std::vector<int>> of_point(tracks.point_count()), sets;
  for (const TrackSighting& s : tracks.sightings) of_point[s.point].push_back(s.station);
  std::map<std::vector<int>, int> count;
  for (const auto& stations : of_point)
    if (stations.size() >= 2 && count[stations]++ < points_per_set + lens_terms(tracks))
      sets.push_back(stations);
  return sets;
}

// The free lens parameters of a device as shifts of the pixel K·y/z: what a lens adds to a pinhole. Taken
// three times as far from the axis as the points lie, where a rational lens's terms differ by more than
// rounding.
Matrix lens_shifts(const TrackDevice& device, const Eigen::Matrix3d& k, const std::vector<double>& lens,
                   const Eigen::Vector3d& pixel) {
  std::vector<double> all{k(0, 0), k(1, 1), k(0, 2), k(1, 2)}, by_all(2 * (4 + lens.size()));
  all.insert(all.end(), lens.begin(), lens.end());
  const Eigen::Vector3d ray = Eigen::Vector3d(3, 3, 1).cwiseProduct(k.inverse() * pixel);
  double at[2];
  Matrix shifts = Matrix::Zero(2, device.lens_free_count());
  if (shifts.cols() == 0 ||
      !LensGradient(device.lens.model).project(all, {ray.x(), ray.y(), ray.z()}, at, nullptr, by_all.data()))
    return shifts;
  for (std::size_t i = 0, column = 0; i < device.lens_free.size(); ++i) {
    if (!device.lens_free[i]) continue;
    for (std::size_t r = 0; r < 2; ++r)
      shifts(Eigen::Index(r), Eigen::Index(column)) = by_all[r * all.size() + 4 + i];
    ++column;
  }
  return shifts;
}

// Derivatives of all pixels by the stations' 3×4 matrices (row-major, 12 each) and the devices' free lens
// parameters (of length 1), the points eliminated: rows times the left null space of the derivatives by the
// point.
Matrix projective_rows(const Tracks& tracks, const std::vector<std::vector<int>>& sets, const RandomRig& rig,
                       std::mt19937_64& random) {
  std::vector<int> lens_begin;
  int columns = 12 * int(rig.places.size());
  for (const TrackDevice& d : tracks.devices) lens_begin.push_back(columns), columns += d.lens_free_count();
  std::vector<Matrix> blocks;
  Eigen::Index total = 0;
  for (const auto& stations : sets) {
    const Eigen::Vector4d x = random_vector(random).normalized().homogeneous();
    const Eigen::Index n = 2 * Eigen::Index(stations.size());
    Matrix by_point(n, 3), by_place = Matrix::Zero(n, columns);
    for (std::size_t i = 0; i < stations.size(); ++i) {
      const Matrix34& place = rig.places[stations[i]];
      const Eigen::Vector3d y = place * x;
      Eigen::Matrix<double, 2, 3> divide;
      divide << 1 / y.z(), 0, -y.x() / (y.z() * y.z()), 0, 1 / y.z(), -y.y() / (y.z() * y.z());
      by_point.middleRows<2>(2 * i) = divide * place.leftCols<3>();
      for (int row = 0; row < 3; ++row)
        by_place.block<2, 4>(2 * i, 12 * stations[i] + 4 * row) = divide.col(row) * x.transpose();
      const int d = tracks.stations[stations[i]].device;
      by_place.block(2 * Eigen::Index(i), lens_begin[d], 2, tracks.devices[d].lens_free_count()) =
          lens_shifts(tracks.devices[d], rig.intrinsics[d], rig.lenses[d], y);
    }
    const Matrix q = Eigen::HouseholderQR<Matrix>(by_point).householderQ() * Matrix::Identity(n, n);
    blocks.push_back(q.rightCols(n - 3).transpose() * by_place);
    total += n - 3;
  }
  Matrix rows(total, columns);
  for (Eigen::Index at = 0; const Matrix& block : blocks) {
    rows.middleRows(at, block.rows()) = block;
    at += block.rows();
  }
  for (Eigen::Index i = 12 * Eigen::Index(rig.places.size()); i < columns; ++i)
    if (const double length = rows.col(i).norm(); length > 0) rows.col(i) /= length;
  return rows;
}

Eigen::Matrix<double, 12, 1> entries(const Matrix34& m) {
  Eigen::Matrix<double, 12, 1> v;
  for (int i = 0; i < 12; ++i) v[i] = m(i / 4, i % 4);
  return v;
}

// The 3×4 matrices K·[R t] by rotation and translation of each station (6 columns each), then by the free
// intrinsics but those of lenses.
Matrix tangent_of_rig(const Tracks& tracks, const RandomRig& rig) {
  const int m = tracks.station_count();
  const auto pinhole_count = [](const TrackDevice& d) { return d.free_count() - d.lens_free_count(); };
  int intrinsics = 0;
  for (const TrackDevice& d : tracks.devices) intrinsics += pinhole_count(d);
  Matrix t = Matrix::Zero(12 * m, 6 * m + intrinsics);
  for (int s = 0; s < m; ++s) {
    int column = 6 * m;
    for (int d = 0; d < tracks.stations[s].device; ++d) column += pinhole_count(tracks.devices[d]);
    const TrackDevice& device = tracks.devices[tracks.stations[s].device];
    const Eigen::Matrix3d& k = rig.intrinsics[tracks.stations[s].device];
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d e = Eigen::Vector3d::Unit(axis);
      t.block<12, 1>(12 * s, 6 * s + axis) = entries(k * cross_matrix(e) * rig.places[s]);
      Matrix34 shift = Matrix34::Zero();
      shift.col(3) = k * e;
      t.block<12, 1>(12 * s, 6 * s + 3 + axis) = entries(shift);
    }
    const auto add = [&](std::initializer_list<std::pair<int, int>> units) {
      Eigen::Matrix3d dk = Eigen::Matrix3d::Zero();
      for (const auto& [row, col] : units) dk(row, col) = 1;
      t.block<12, 1>(12 * s, column++) = entries(dk * rig.places[s]);
    };
    if (device.focal) add({{0, 0}, {1, 1}});
    if (device.aspect) add({{1, 1}});
    if (device.center) add({{0, 2}}), add({{1, 2}});
  }
  return t;
}

int rank_of(const Matrix& m) {
  if (m.size() == 0) return 0;
  Eigen::ColPivHouseholderQR<Matrix> qr(m);
  qr.setThreshold(1e-9);  // a random rig leaves 1e-3 or rounding, 1e-14
  return int(qr.rank());
}

std::string unknowns_in_words(const Tracks& tracks) {
  std::vector<std::string> words;
  for (const TrackDevice& d : tracks.devices) {
    std::vector<std::string> names;
    if (d.focal && !d.aspect) names.push_back("f");
    if (d.aspect) names.insert(names.end(), {"f_x", "f_y"});
    if (d.center) names.insert(names.end(), {"c_x", "c_y"});
    for (std::size_t i = 0; i < d.lens_free.size(); ++i)
      if (d.lens_free[i]) names.push_back(lens_parameter_name(d.lens.model, int(i)));
    words.push_back(names.empty() ? fmt::format("known {}", d.name)
                                  : fmt::format("unknown {} of {}", fmt::join(names, ", "), d.name));
  }
  return fmt::format("{}", fmt::join(words, " with "));
}

}  // namespace

NumberCount count_numbers(const Tracks& tracks) {
  validate(tracks);
  NumberCount n;
  n.stations = tracks.station_count();
  for (const TrackDevice& d : tracks.devices) n.intrinsics += d.free_count();
  std::mt19937_64 random(20240229);  // any rig in general position
  RandomRig rig = random_rig(tracks, random);
  for (int s = 0; s < tracks.station_count(); ++s)
    rig.places[s] = (rig.intrinsics[tracks.stations[s].device] * rig.places[s]).eval();
  const Matrix rows = projective_rows(tracks, station_sets(tracks), rig, random);
  for (int s = 0; s < tracks.station_count(); ++s)
    rig.places[s] = (rig.intrinsics[tracks.stations[s].device].inverse() * rig.places[s]).eval();
  const Matrix tangent = tangent_of_rig(tracks, rig), by_place = rows.leftCols(tangent.rows());
  n.given = rank_of(rows);
  n.places = rank_of(by_place * tangent.leftCols(6 * tracks.station_count()));
  Matrix asked(rows.rows(), tangent.cols() + rows.cols() - by_place.cols());
  asked << by_place * tangent, rows.rightCols(rows.cols() - by_place.cols());
  n.determined = rank_of(asked);
  n.unlinked = 6 * (tracks.station_count() - 1) - n.places;
  return n;
}

std::string shortage_in_words(const Tracks& tracks, const NumberCount& n) {
  if (n.enough()) return {};
  const int m = tracks.station_count();
  const std::size_t common = station_sets(tracks).size();
  if (m < 2) return "there is one station, expected two or more";
  const bool few = m == 2 ? n.given < 7 : !n.joined();
  if (few && m == 2)
    return fmt::format(
        "too few points: {} that two stations share give {} numbers, of the 7 that a pair can give", common,
        n.given);
  if (few)
    return fmt::format(
        "too few points: those that stations share give {} numbers, and leave the places of "
        "some stations open",
        n.given);
  const std::string what = m == 2 ? std::string("one pair gives") : fmt::format("{} stations give", m);
  if (n.given < n.needed())
    return fmt::format("{} {} numbers; {} needs {}", what, n.given, unknowns_in_words(tracks), n.needed());
  return fmt::format("{} {} numbers, but only {} of them tell of {}, which needs {}", what, n.given,
                     n.determined, unknowns_in_words(tracks), n.needed());
}

}  // namespace laterna
