#include "calib/verify.h"

#include "calib/projection_rows.h"
#include "calib/row_kernels.h"
#include "sim/error.h"
#include "sim/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace laterna {

namespace {

constexpr std::size_t chunk = 4096;
constexpr double infinity = std::numeric_limits<double>::infinity();

// By linear interpolation between order statistics; reorders `values`.
double percentile(std::vector<double>& values, double share) {
  const double at = share * double(values.size() - 1);
  const auto low = values.begin() + std::ptrdiff_t(at);
  std::nth_element(values.begin(), low, values.end());
  const double next = low + 1 == values.end() ? *low : *std::min_element(low + 1, values.end());
  return *low + (at - std::floor(at)) * (next - *low);
}

double between(double first, double last, int i, int intervals) {
  return first + (last - first) * i / intervals;
}

// Calls body(chunk index, begin, end) in parallel.
template <class Body>
std::size_t in_chunks(std::size_t count, const Body& body) {
  const std::size_t chunks = (count + chunk - 1) / chunk;
  parallel_for(chunks, [&](std::size_t k) { body(k, k * chunk, std::min(count, (k + 1) * chunk)); });
  return chunks;
}

// trace(J·C·Jᵀ) for two rows of J.
double trace_of(const std::vector<double>& rows, const std::vector<double>& c, int p) {
  double sum = 0;
  for (int r = 0; r < 2; ++r) {
    const double* j = &rows[r * p];
    for (int a = 0; a < p; ++a) {
      double row = 0;
      for (int b = 0; b < p; ++b) row += c[a * p + b] * j[b];
      sum += j[a] * row;
    }
  }
  return sum;
}

// Σ trace(J·C·Jᵀ), and over how many points.
struct TraceSum {
  double sum = 0;
  std::size_t points = 0;
};

TraceSum trace_one_by_one(const LensGradient& lens, const ProjectorState& state, const std::vector<double>& c,
                          const glm::dvec3* points, std::size_t count) {
  const int p = lens.parameter_count() + 6;
  std::vector<double> rows(2 * std::size_t(p));
  double pixel[2];
  TraceSum trace;
  for (std::size_t i = 0; i < count; ++i) {
    if (!project_with_rows(lens, state, points[i], pixel, rows.data())) continue;
    ++trace.points;
    trace.sum += trace_of(rows, c, p);
  }
  return trace;
}

// The same as Σ_ab C_ab·(JᵀJ)_ab, column by column; point by point where some cannot be projected.
TraceSum trace_together(const LensGradient& lens, const ProjectorState& state, const std::vector<double>& c,
                        const glm::dvec3* points, std::size_t count) {
  const int p = lens.parameter_count() + 6;
  constexpr std::size_t rows = 2 * group_points;
  PointTable table;
  for (auto* column : {&table.u, &table.v}) column->assign(count, 0.0);
  table.inverse_sigma.assign(count, 1.0);
  for (std::size_t i = 0; i < count; ++i)
    table.x.push_back(points[i].x), table.y.push_back(points[i].y), table.z.push_back(points[i].z);
  std::vector<double> block(rows * (p + 1));
  TraceSum trace{0, count};
  for (std::size_t i = 0; i < count; i += group_points) {
    const std::size_t end = std::min(count, i + group_points);
    std::fill(block.begin(), block.end(), 0.0);
    if (!fill_rows(table, lens, state, {}, i, end, {block.data(), rows, group_points}))
      return trace_one_by_one(lens, state, c, points, count);
    for (int a = 0; a < p; ++a) {
      for (int b = a; b < p; b += 4) {
        double* columns[4];
        double dots[4];
        for (int j = 0; j < 4; ++j) columns[j] = &block[rows * std::min(b + j, p - 1)];
        dot4(&block[rows * a], columns, rows, dots);
        for (int j = 0; j < 4 && b + j < p; ++j)
          trace.sum += (b + j == a ? 1 : 2) * c[a * p + b + j] * dots[j];
      }
    }
  }
  return trace;
}

ErrorSummary summarise(const Device& truth, const Device& estimate, const std::vector<double>& covariance,
                       std::span<const glm::dvec3> points) {
  const WorldProjection true_projection(truth), estimated_projection(estimate);
  struct Part {
    double sum = 0, max = 0;
    std::size_t points = 0, failed = 0;
  };
  std::vector<Part> parts((points.size() + chunk - 1) / chunk);
  in_chunks(points.size(), [&](std::size_t k, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const glm::dvec3 a = true_projection.project(points[i]), b = estimated_projection.project(points[i]);
      if (!std::isfinite(a.x) || !std::isfinite(a.y)) continue;
      ++parts[k].points;
      const double squared = (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
      if (!std::isfinite(squared)) {
        ++parts[k].failed;
        continue;
      }
      parts[k].sum += squared;
      parts[k].max = std::max(parts[k].max, squared);
    }
  });
  ErrorSummary s;
  double sum = 0;
  for (const auto& part : parts) {
    sum += part.sum, s.max = std::max(s.max, part.max);
    s.points += part.points, s.failed += part.failed;
  }
  s.max = s.failed ? infinity : std::sqrt(s.max);
  s.rms = s.failed ? infinity : std::sqrt(sum / double(std::max<std::size_t>(1, s.points)));
  s.predicted_rms = covariance.empty() ? std::numeric_limits<double>::quiet_NaN()
                                       : predicted_rms(estimate, covariance, points).value_or(infinity);
  return s;
}

}  // namespace

std::vector<double> volume_depths(std::vector<double> lit) {
  const double first = percentile(lit, 0.05), last = percentile(lit, 0.95);
  std::vector<double> depths;
  depths.reserve(12);
  for (int i = 0; i < 12; ++i) depths.push_back(between(first, last, i, 11));
  return depths;
}

std::vector<double> extrapolation_depths(std::vector<double> lit) {
  const auto [nearest, farthest] = std::minmax_element(lit.begin(), lit.end());
  const double first = 0.8 * *nearest, last = 1.25 * *farthest;
  const double low = percentile(lit, 0.05), high = percentile(lit, 0.95);
  std::vector<double> depths;
  depths.reserve(12);
  for (int i = 0; i < 6; ++i) depths.push_back(between(first, low, i, 6));
  for (int i = 1; i <= 6; ++i) depths.push_back(between(high, last, i, 6));
  return depths;
}

std::vector<glm::dvec3> image_grid(const Device& device, const std::vector<double>& depths_m) {
  const LensProjection lens(device.intrinsics, device.lens);
  const Rigid world_from_device = inverse(device.device_from_world);
  const glm::dvec2 size(device.intrinsics.size);
  std::vector<glm::dvec3> points;
  for (int j = 0; j < 12; ++j) {
    for (int i = 0; i < 16; ++i) {
      const auto ray =
          lens.unproject({between(-0.5, size.x - 0.5, i, 15), between(-0.5, size.y - 0.5, j, 11)});
      for (const double depth : depths_m)
        if (ray) points.push_back(apply(world_from_device, *ray * depth));
    }
  }
  return points;
}

std::vector<double> depths_of(const Device& device, std::span<const glm::dvec3> points) {
  std::vector<double> depths;
  depths.reserve(points.size());
  for (const auto& x : points) {
    const double depth = apply(device.device_from_world, x).z;
    if (depth > 0 && std::isfinite(depth)) depths.push_back(depth);
  }
  return depths;
}

std::vector<glm::dvec2> error_vectors(const Device& truth, const Device& estimate,
                                      std::span<const glm::dvec3> points) {
  const WorldProjection true_projection(truth), estimated_projection(estimate);
  std::vector<glm::dvec2> errors(points.size());
  in_chunks(points.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      errors[i] = glm::dvec2(estimated_projection.project(points[i])) -
                  glm::dvec2(true_projection.project(points[i]));
    }
  });
  return errors;
}

std::optional<double> predicted_rms(const Device& device, const std::vector<double>& covariance,
                                    std::span<const glm::dvec3> points) {
  const LensGradient lens(device.lens.model);
  const ProjectorState state = state_of(device);
  const int p = lens.parameter_count() + 6;
  if (covariance.size() != std::size_t(p) * p) {
    throw InputError(fmt::format("covariance: {} numbers, expected {}×{} for this projector's parameters",
                                 covariance.size(), p, p));
  }
  std::vector<TraceSum> parts((points.size() + chunk - 1) / chunk);
  in_chunks(points.size(), [&](std::size_t k, std::size_t begin, std::size_t end) {
    parts[k] = trace_together(lens, state, covariance, &points[begin], end - begin);
  });
  TraceSum total;
  for (const auto& part : parts) total.sum += part.sum, total.points += part.points;
  if (total.points == 0) return std::nullopt;
  return std::sqrt(std::max(0.0, total.sum / double(total.points)));
}

Verification verify(const Device& truth, const Device& estimate, const std::vector<double>& covariance,
                    std::span<const glm::dvec3> surface_points) {
  if (truth.intrinsics.size != estimate.intrinsics.size) {
    throw InputError(fmt::format("verify: the estimate's image is {}x{}, expected {}x{}",
                                 estimate.intrinsics.size.x, estimate.intrinsics.size.y,
                                 truth.intrinsics.size.x, truth.intrinsics.size.y));
  }
  const std::vector<double> depths = depths_of(truth, surface_points);
  if (depths.empty())
    throw InputError("verify: no surface point lies in front of the projector, expected some");
  return {summarise(truth, estimate, covariance, surface_points),
          summarise(truth, estimate, covariance, image_grid(truth, volume_depths(depths))),
          summarise(truth, estimate, covariance, image_grid(truth, extrapolation_depths(depths)))};
}

}  // namespace laterna
