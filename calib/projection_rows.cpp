#include "calib/projection_rows.h"

#include "calib/row_kernels.h"
#include "sim/parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace laterna {

namespace {

constexpr std::size_t group = group_points, chunk = 4096;

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

PlainPinhole pinhole_of(const ProjectorState& s) {
  PlainPinhole p{s.parameters[0], s.parameters[1], s.parameters[2], s.parameters[3], {}, {}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) p.r[3 * i + j] = s.device_from_points.rotation[j][i];
    p.t[i] = s.device_from_points.translation[i];
  }
  return p;
}

bool pinhole_terms(const PointTable& points, const PlainPinhole& p, std::size_t begin, std::size_t count,
                   GroupTerms& g) {
  return pinhole_terms(p, &points.x[begin], &points.y[begin], &points.z[begin], &points.u[begin],
                       &points.v[begin], count, g);
}

// Models with kernels of their own, told by their number of parameters, which no other model has.
constexpr int pinhole_parameters = 4, opencv4_parameters = 8;

bool has_kernel(const LensGradient& lens) {
  return lens.parameter_count() == pinhole_parameters || lens.parameter_count() == opencv4_parameters;
}

// What up to 128 points give on the way to their rows, under a pinhole or LENSMODEL_OPENCV4.
struct KernelTerms {
  PlainPinhole pinhole;
  std::optional<OpenCv4> lens;
  GroupTerms group;
  WarpTerms warp;

  explicit KernelTerms(const ProjectorState& s) : pinhole(pinhole_of(s)) {
    const auto& k = s.parameters;
    if (k.size() == opencv4_parameters) lens = OpenCv4{k[4], k[5], k[6], k[7]};
  }
  bool fill(const PointTable& points, std::size_t begin, std::size_t count) {
    if (!pinhole_terms(points, pinhole, begin, count, group)) return false;
    if (lens) opencv4_terms(pinhole, *lens, &points.u[begin], &points.v[begin], count, group, warp);
    return true;
  }
  void columns(std::size_t count, const RowBlock& block) const {
    double* c[30];
    for (int j = 0; j < (lens ? 15 : 11); ++j)
      c[2 * j] = block.column(j, 0), c[2 * j + 1] = block.column(j, 1);
    if (lens)
      opencv4_columns(pinhole, count, group, warp, c);
    else
      pinhole_columns(pinhole, count, group, c);
  }
};

void weigh(const PointTable& points, const RobustLoss& loss, std::size_t begin, std::size_t count,
           GroupTerms& g) {
  for (std::size_t i = 0; i < count; ++i) {
    const double is = points.inverse_sigma[begin + i];
    g.weight[i] = is;
    if (loss.kind != RobustLoss::Kind::none)
      g.weight[i] *= std::sqrt(loss.weight(is * is * (g.du[i] * g.du[i] + g.dv[i] * g.dv[i])));
  }
}

glm::dvec3 point(const PointTable& points, std::size_t i) { return {points.x[i], points.y[i], points.z[i]}; }

bool fill_rows_with_lens(const PointTable& points, const LensGradient& lens, const ProjectorState& state,
                         const RobustLoss& loss, std::size_t begin, std::size_t end, const RowBlock& block) {
  const int p = lens.parameter_count() + 6;
  std::vector<double> rows(2 * p);
  double pixel[2];
  for (std::size_t i = begin; i < end; ++i) {
    if (!project_with_rows(lens, state, point(points, i), pixel, rows.data())) return false;
    const double du = pixel[0] - points.u[i], dv = pixel[1] - points.v[i], is = points.inverse_sigma[i];
    const double w = is * std::sqrt(loss.weight(is * is * (du * du + dv * dv)));
    for (int r = 0; r < 2; ++r) {
      for (int j = 0; j < p; ++j) block.column(j, r)[i - begin] = w * rows[r * p + j];
      block.column(p, r)[i - begin] = w * (r == 0 ? du : dv);
    }
  }
  return true;
}

// s of the points [begin, begin + count), count ≤ group.
bool squared_of_group(const PointTable& points, const LensGradient& lens, const ProjectorState& state,
                      std::size_t begin, std::size_t count, double* s) {
  KernelTerms terms(state);
  GroupTerms& g = terms.group;
  if (has_kernel(lens)) {
    if (!terms.fill(points, begin, count)) return false;
  } else {
    double pixel[2];
    for (std::size_t i = 0; i < count; ++i) {
      if (!project_with_rows(lens, state, point(points, begin + i), pixel, nullptr)) return false;
      g.du[i] = pixel[0] - points.u[begin + i], g.dv[i] = pixel[1] - points.v[begin + i];
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double is = points.inverse_sigma[begin + i];
    s[i] = is * is * (g.du[i] * g.du[i] + g.dv[i] * g.dv[i]);
  }
  return true;
}

}  // namespace

namespace {

// Σ term(x), chunk by chunk, so that it is the same for any number of threads.
template <class Sum, class Term>
Sum sum_of(std::span<const glm::dvec3> points, Sum zero, const Term& term) {
  std::vector<Sum> parts((points.size() + chunk - 1) / chunk, zero);
  parallel_for(parts.size(), [&](std::size_t k) {
    Sum sum = zero;
    for (std::size_t i = k * chunk; i < std::min(points.size(), (k + 1) * chunk); ++i) sum += term(points[i]);
    parts[k] = sum;
  });
  return std::accumulate(parts.begin(), parts.end(), zero);
}

}  // namespace

WorldNormalisation normalisation_of(std::span<const glm::dvec3> points) {
  if (points.empty()) return {};
  const glm::dvec3 origin =
      points.front();  // sums of differences keep their digits far from the world's origin
  const glm::dvec3 sum = sum_of(points, glm::dvec3(0.0), [&](const glm::dvec3& x) { return x - origin; });
  WorldNormalisation n{origin + sum / double(points.size()), 0};
  n.scale_m = sum_of(points, 0.0, [&](const glm::dvec3& x) { return glm::length(x - n.center); });
  n.scale_m /= double(points.size());
  if (!(n.scale_m > 0)) n.scale_m = 1;
  return n;
}

Rigid device_from_normalised(const Rigid& device_from_world, const WorldNormalisation& n) {
  return {device_from_world.rotation, apply(device_from_world, n.center) / n.scale_m};
}

Rigid device_from_world(const Rigid& d, const WorldNormalisation& n) {
  return {d.rotation, n.scale_m * d.translation - d.rotation * n.center};
}

ProjectorState state_of(const Device& device) {
  const auto& k = device.intrinsics;
  ProjectorState state{{k.fx, k.fy, k.cx, k.cy}, device.device_from_world};
  state.parameters.insert(state.parameters.end(), device.lens.parameters.begin(),
                          device.lens.parameters.end());
  return state;
}

namespace {

// Indices sorted by cluster, stable. Ids are counted where they are dense enough, else sorted.
LargeVector<std::size_t> order_of(std::span<const std::uint32_t> cluster, std::size_t n) {
  LargeVector<std::size_t> order(n);
  const auto in_order = [&](std::size_t a, std::size_t b) { return cluster[a] < cluster[b]; };
  const std::size_t ids =
      cluster.empty() ? 0 : 1 + std::size_t(*std::max_element(cluster.begin(), cluster.end()));
  if (cluster.empty() || ids > 4 * n) {
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (!cluster.empty()) std::stable_sort(order.begin(), order.end(), in_order);
    return order;
  }
  std::vector<std::size_t> next(ids + 1, 0);
  for (const std::uint32_t id : cluster) ++next[id + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (std::size_t i = 0; i < n; ++i) order[next[cluster[i]]++] = i;
  return order;
}

}  // namespace

PointTable point_table(const Correspondences& c, const WorldNormalisation& normalisation) {
  const std::size_t n = c.world_points.size();
  const LargeVector<std::size_t> order = order_of(c.cluster, n);
  PointTable t;
  for (auto* column : {&t.x, &t.y, &t.z, &t.u, &t.v, &t.inverse_sigma}) column->resize(n);
  parallel_for((n + chunk - 1) / chunk, [&](std::size_t part) {
    for (std::size_t k = part * chunk; k < std::min(n, (part + 1) * chunk); ++k) {
      const std::size_t i = order[k];
      const glm::dvec3 x = (c.world_points[i] - normalisation.center) / normalisation.scale_m;
      t.x[k] = x.x, t.y[k] = x.y, t.z[k] = x.z;
      t.u[k] = c.projector_pixels[i].x, t.v[k] = c.projector_pixels[i].y;
      t.inverse_sigma[k] = 1 / c.sigma_px[i];
    }
  });
  for (std::size_t k = 0; k < n; ++k)
    if (k == 0 || c.cluster.empty() || c.cluster[order[k]] != c.cluster[order[k - 1]])
      t.cluster_begin.push_back(k);
  t.cluster_begin.push_back(n);
  return t;
}

bool project_with_rows(const LensGradient& lens, const ProjectorState& state, const glm::dvec3& x,
                       double pixel[2], double* rows) {
  const int k = lens.parameter_count(), p = k + 6;
  const glm::dvec3 rx = state.device_from_points.rotation * x;
  double dx[6];
  thread_local std::vector<double> dk;
  dk.resize(2 * std::size_t(k));
  if (!lens.project(state.parameters, rx + state.device_from_points.translation, pixel, rows ? dx : nullptr,
                    rows ? dk.data() : nullptr))
    return false;
  for (int r = 0; rows && r < 2; ++r) {
    const glm::dvec3 g(dx[3 * r], dx[3 * r + 1], dx[3 * r + 2]), turn = glm::cross(rx, g);
    double* row = rows + r * p;
    std::copy_n(dk.data() + r * k, k, row);
    for (int j = 0; j < 3; ++j) row[k + j] = turn[j], row[k + 3 + j] = g[j];
  }
  return true;
}

bool fill_rows(const PointTable& points, const LensGradient& lens, const ProjectorState& state,
               const RobustLoss& loss, std::size_t begin, std::size_t end, const RowBlock& block) {
  if (!has_kernel(lens)) return fill_rows_with_lens(points, lens, state, loss, begin, end, block);
  KernelTerms terms(state);
  for (std::size_t i = begin; i < end; i += group) {
    const std::size_t count = std::min(group, end - i);
    if (!terms.fill(points, i, count)) return false;
    weigh(points, loss, i, count, terms.group);
    terms.columns(count, {block.values + (i - begin), block.column_stride, block.second_row});
  }
  return true;
}

namespace {

// The factor of the rows of a factor and those of a prior.
std::vector<double> with_prior(const std::vector<double>& factor, const IntrinsicsPrior& prior,
                               const ProjectorState& state, int columns) {
  const int k = int(prior.mean.size());
  RowMajor rows = RowMajor::Zero(columns + k, columns);
  rows.topRows(columns) = Eigen::Map<const RowMajor>(factor.data(), columns, columns);
  for (int i = 0; i < k; ++i) {
    rows(columns + i, i) = prior.inverse_sigma[i];
    rows(columns + i, columns - 1) = prior.residual(std::size_t(i), state.parameters[i]);
  }
  const Eigen::MatrixXd full = rows.householderQr().matrixQR();
  const RowMajor r = full.topRows(columns).triangularView<Eigen::Upper>();
  return {r.data(), r.data() + r.size()};
}

}  // namespace

std::optional<std::vector<double>> row_factor(const PointTable& points, const LensGradient& lens,
                                              const ProjectorState& state, const RobustLoss& loss) {
  StackedRows rows;
  rows.items = points.size();
  rows.columns = lens.parameter_count() + 7;
  if (has_kernel(lens)) {
    rows.support.assign(rows.columns, RowSupport::both);
    rows.support[0] = rows.support[2] = RowSupport::first;
    rows.support[1] = rows.support[3] = RowSupport::second;
  }
  rows.fill = [&](std::size_t begin, std::size_t end, const RowBlock& block) {
    return fill_rows(points, lens, state, loss, begin, end, block);
  };
  auto factor = triangular_factor(rows);
  if (!factor || points.prior.empty()) return factor;
  return with_prior(*factor, points.prior, state, rows.columns);
}

std::optional<LargeVector<double>> squared_residuals(const PointTable& points, const LensGradient& lens,
                                                     const ProjectorState& state) {
  LargeVector<double> s(points.size());
  const std::size_t chunks = (points.size() + chunk - 1) / chunk;
  std::vector<char> failed(chunks, 0);
  parallel_for(chunks, [&](std::size_t k) {
    const std::size_t end = std::min(points.size(), (k + 1) * chunk);
    for (std::size_t i = k * chunk; i < end && !failed[k]; i += group)
      failed[k] = !squared_of_group(points, lens, state, i, std::min(group, end - i), &s[i]);
  });
  if (std::count(failed.begin(), failed.end(), 0) != std::ptrdiff_t(chunks)) return std::nullopt;
  return s;
}

std::optional<double> total_loss(const PointTable& points, const LensGradient& lens,
                                 const ProjectorState& state, const RobustLoss& loss) {
  const std::size_t chunks = (points.size() + chunk - 1) / chunk;
  std::vector<double> sums(chunks, 0.0);
  parallel_for(chunks, [&](std::size_t k) {
    double s[group];
    const std::size_t end = std::min(points.size(), (k + 1) * chunk);
    for (std::size_t i = k * chunk; i < end; i += group) {
      const std::size_t count = std::min(group, end - i);
      if (!squared_of_group(points, lens, state, i, count, s)) {
        sums[k] = std::numeric_limits<double>::quiet_NaN();
        return;
      }
      for (std::size_t j = 0; j < count; ++j) sums[k] += loss.rho(s[j]);
    }
  });
  const double sum = std::accumulate(sums.begin(), sums.end(), prior_loss(points.prior, state.parameters));
  if (!std::isfinite(sum)) return std::nullopt;
  return sum;
}

}  // namespace laterna
