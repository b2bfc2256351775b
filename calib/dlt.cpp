#include "calib/dlt.h"

#include "calib/projection_rows.h"
#include "sim/error.h"
#include "sim/parallel.h"
#include "sim/texture_matrix.h"

#include <Random123/philox.h>
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace laterna {

namespace {

using PixelMatrix = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

struct PixelNormalisation {
  glm::dvec2 center{0.0};
  double scale = 1;
};

// Points and pixels near 1, weights of mean 1.
struct Normalised {
  WorldNormalisation world;
  PixelNormalisation pixel;
  std::vector<glm::dvec3> x;
  std::vector<glm::dvec2> p;
  std::vector<double> inverse_sigma;  // of normalised pixels
};

Normalised normalise(const Correspondences& c) {
  Normalised n;
  const double count = double(c.world_points.size());
  n.world = normalisation_of(c.world_points);
  for (const auto& p : c.projector_pixels) n.pixel.center += p / count;
  n.pixel.scale = 0;
  for (const auto& p : c.projector_pixels) n.pixel.scale += glm::length(p - n.pixel.center) / count;
  if (!(n.pixel.scale > 0)) n.pixel.scale = 1;
  for (std::size_t i = 0; i < c.world_points.size(); ++i) {
    n.x.push_back((c.world_points[i] - n.world.center) / n.world.scale_m);
    n.p.push_back((c.projector_pixels[i] - n.pixel.center) / n.pixel.scale);
    n.inverse_sigma.push_back(n.pixel.scale / c.sigma_px[i]);
  }
  return n;
}

// w·[x 1 | 0 | -u·(x 1)] and w·[0 | x 1 | -v·(x 1)].
void write_rows(const glm::dvec3& x, const glm::dvec2& p, double w, double* (&c)[2][12], std::size_t at) {
  const double h[4] = {w * x.x, w * x.y, w * x.z, w};
  for (int j = 0; j < 4; ++j) {
    c[0][j][at] = h[j], c[1][4 + j][at] = h[j];
    c[0][8 + j][at] = -p.x * h[j], c[1][8 + j][at] = -p.y * h[j];
  }
}

Eigen::Matrix<double, 12, 12> system_factor(const Normalised& n, const std::vector<std::size_t>& chosen) {
  double mean_weight = 0;
  for (const std::size_t i : chosen) mean_weight += n.inverse_sigma[i] / double(chosen.size());
  StackedRows rows;
  rows.items = chosen.size();
  rows.columns = 12;
  rows.support.assign(12, RowSupport::both);
  std::fill_n(rows.support.begin(), 4, RowSupport::first);
  std::fill_n(rows.support.begin() + 4, 4, RowSupport::second);
  rows.fill = [&](std::size_t begin, std::size_t end, const RowBlock& block) {
    double* c[2][12];
    for (int j = 0; j < 12; ++j) c[0][j] = block.column(j, 0), c[1][j] = block.column(j, 1);
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t i = chosen[k];
      write_rows(n.x[i], n.p[i], n.inverse_sigma[i] / mean_weight, c, k - begin);
    }
    return true;
  };
  const auto r = triangular_factor(rows).value_or(std::vector<double>(144));  // never fails
  return Eigen::Map<const Eigen::Matrix<double, 12, 12, Eigen::RowMajor>>(r.data());
}

// The null vector of six points' rows; no checks, a bad sample scores badly.
PixelMatrix minimal_solution(const Normalised& n, const std::array<std::size_t, 6>& sample) {
  Eigen::Matrix<double, 12, 12> a = Eigen::Matrix<double, 12, 12>::Zero();
  double* c[2][12];
  for (int j = 0; j < 12; ++j) c[0][j] = a.data() + 12 * j, c[1][j] = a.data() + 12 * j + 6;
  for (std::size_t k = 0; k < 6; ++k) write_rows(n.x[sample[k]], n.p[sample[k]], 1.0, c, k);
  // The last column of Q of Aᵀ = Q·R is orthogonal to all rows but the last pivoted, which is the least.
  const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, 12, 12>> qr(a.transpose());
  const Eigen::Matrix<double, 12, 1> null = qr.householderQ() * Eigen::Matrix<double, 12, 1>::Unit(11);
  return Eigen::Map<const PixelMatrix>(null.data());
}

// Squared residual in sigmas.
double squared_residual(const Normalised& n, const PixelMatrix& m, std::size_t i) {
  const Eigen::Vector3d h = m * Eigen::Vector4d(n.x[i].x, n.x[i].y, n.x[i].z, 1.0);
  const double du = h[0] / h[2] - n.p[i].x, dv = h[1] / h[2] - n.p[i].y;
  const double s = (du * du + dv * dv) * n.inverse_sigma[i] * n.inverse_sigma[i];
  return std::isfinite(s) ? s : std::numeric_limits<double>::max();
}

// The texture matrix (points in normalised world coordinates, r row left empty) of a normalised pixel matrix.
glm::dmat4 texture_matrix(const PixelMatrix& m, const PixelNormalisation& pixel, glm::ivec2 size) {
  Eigen::Matrix3d denormalise;
  denormalise << pixel.scale, 0, pixel.center.x, 0, pixel.scale, pixel.center.y, 0, 0, 1;
  const PixelMatrix a = denormalise * m;
  glm::dmat4 t(0.0);
  for (int j = 0; j < 4; ++j) {
    t[j][0] = (a(0, j) + 0.5 * a(2, j)) / size.x;
    t[j][1] = a(2, j) - (a(1, j) + 0.5 * a(2, j)) / size.y;
    t[j][3] = a(2, j);
  }
  return t;
}

void check_sides(DltResult& result, const Normalised& n, const Rigid& device_from_normalised_world) {
  std::size_t behind = 0;
  for (const auto& x : n.x) behind += !(apply(device_from_normalised_world, x).z > 0);
  if (behind == 0) {
    result.status = DltStatus::ok;
  } else if (behind == n.x.size()) {
    result.status = DltStatus::mirrored;
    result.reason =
        "the mapping is mirrored: it fits only with every point behind the projector (is u or v flipped, or "
        "the world left-handed?)";
  } else {
    result.status = DltStatus::both_sides;
    result.reason =
        fmt::format("{} of {} points lie behind the projector that fits them best", behind, n.x.size());
  }
}

DltResult solve_chosen(const Normalised& n, const std::vector<std::size_t>& chosen, glm::ivec2 size) {
  DltResult result;
  const Eigen::JacobiSVD<Eigen::Matrix<double, 12, 12>> svd(system_factor(n, chosen), Eigen::ComputeFullV);
  const auto& s = svd.singularValues();
  result.smallest_gap = s[0] > 0 ? s[10] / s[0] : 0;
  result.uniqueness = s[10] > 0 ? s[11] / s[10] : 1;
  if (!(result.smallest_gap > 1e-11) || result.uniqueness > 0.5) {
    result.reason = fmt::format(
        "the linear system has no clear single solution (singular values {:.2g}, {:.2g} and {:.2g})", s[0],
        s[10], s[11]);
    return result;
  }
  const Eigen::Matrix<double, 12, 1> null = svd.matrixV().col(11);
  const PixelMatrix m = Eigen::Map<const PixelMatrix>(null.data());
  double sum = 0;
  for (const std::size_t i : chosen)
    sum += squared_residual(n, m, i) * std::pow(n.pixel.scale / n.inverse_sigma[i], 2);
  result.rms_px = std::sqrt(sum / double(chosen.size()));
  try {
    const TextureMatrixParts parts = decompose(texture_matrix(m, n.pixel, size), size);
    result.intrinsics = parts.intrinsics;
    result.skew_px = parts.skew_px;
    result.device_from_world = device_from_world(parts.device_from_world, n.world);
    check_sides(result, n, parts.device_from_world);
  } catch (const InputError& error) {
    result.reason = error.what();
  }
  return result;
}

std::array<std::size_t, 6> sample_of(std::uint64_t seed, std::uint32_t trial, std::size_t count) {
  std::array<std::size_t, 6> sample{};
  const r123::Philox4x32 philox;
  std::size_t found = 0;
  for (std::uint32_t block = 0; found < 6; ++block) {
    const r123::Philox4x32::ctr_type counter{{trial, block, 0, 0}};
    const r123::Philox4x32::key_type key{{std::uint32_t(seed), std::uint32_t(seed >> 32)}};
    const auto random = philox(counter, key);
    for (int k = 0; k < 4 && found < 6; ++k) {
      const std::size_t i = std::size_t((std::uint64_t(random[k]) * count) >> 32);
      if (std::find(sample.begin(), sample.begin() + found, i) == sample.begin() + found) sample[found++] = i;
    }
  }
  return sample;
}

struct Score {
  double loss = std::numeric_limits<double>::infinity();
  double inlier_share = 0;
};

Score score(const Normalised& n, const PixelMatrix& m, double squared_threshold,
            const std::vector<std::size_t>& judges) {
  Score total{0, 0};
  for (const std::size_t i : judges) {
    const double s = squared_residual(n, m, i);
    total.loss += std::min(s, squared_threshold);
    total.inlier_share += s < squared_threshold;
  }
  total.inlier_share /= double(judges.size());
  return total;
}

// Trials in parallel batches of fixed size; the first of the best wins, so the order of threads is nothing.
PixelMatrix best_sample(const Normalised& n, const RansacOptions& options) {
  constexpr int batch = 64;
  const double squared = options.threshold_sigmas * options.threshold_sigmas;
  const std::vector<std::size_t> judges = evenly_spread(n.x.size(), 2000);
  PixelMatrix best = PixelMatrix::Zero();
  Score best_score;
  double needed = options.max_trials;
  for (int trial = 0; trial < options.max_trials && trial < needed; trial += batch) {
    std::array<PixelMatrix, batch> candidates;
    std::array<Score, batch> scores;
    parallel_for(batch, [&](std::size_t k) {
      const auto sample = sample_of(options.seed, std::uint32_t(trial + k), n.x.size());
      candidates[k] = minimal_solution(n, sample);
      scores[k] = score(n, candidates[k], squared, judges);
    });
    for (int k = 0; k < batch; ++k) {
      if (!(scores[k].loss < best_score.loss)) continue;
      best = candidates[k], best_score = scores[k];
    }
    const double all_good = std::pow(best_score.inlier_share, 6);
    if (all_good > 1e-9)
      needed = std::log(1 - options.confidence) / std::log1p(-std::min(all_good, 0.999999));
  }
  return best;
}

std::vector<std::size_t> agreeing(const Normalised& n, const PixelMatrix& m, double squared_threshold) {
  std::vector<std::size_t> inliers;
  for (std::size_t i = 0; i < n.x.size(); ++i) {
    if (squared_residual(n, m, i) < squared_threshold) inliers.push_back(i);
  }
  return inliers;
}

}  // namespace

DltResult dlt(const Correspondences& c, glm::ivec2 size) {
  std::vector<std::size_t> all(c.world_points.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  return solve_chosen(normalise(c), all, size);
}

DltResult ransac_dlt(const Correspondences& c, glm::ivec2 size, const RansacOptions& options) {
  const Normalised n = normalise(c);
  const double squared = options.threshold_sigmas * options.threshold_sigmas;
  DltResult result;
  PixelMatrix m = best_sample(n, options);
  std::vector<std::size_t> inliers = agreeing(n, m, 4 * squared);
  for (int round = 0; round < 3 && inliers.size() >= 6; ++round) {
    const Eigen::JacobiSVD<Eigen::Matrix<double, 12, 12>> svd(system_factor(n, inliers), Eigen::ComputeFullV);
    const Eigen::Matrix<double, 12, 1> null = svd.matrixV().col(11);
    m = Eigen::Map<const PixelMatrix>(null.data());
    auto next = agreeing(n, m, squared);
    if (next.size() < 6) break;
    inliers = std::move(next);
  }
  if (inliers.size() < 6) {
    result.reason = "no six points agree on a projector";
    return result;
  }
  result = solve_chosen(n, inliers, size);
  result.inliers = std::move(inliers);
  return result;
}

}  // namespace laterna
