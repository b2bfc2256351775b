#include "apps/lab/report/trial_figures.h"

#include "apps/lab/json_number.h"
#include "calib/correspondences.h"
#include "calib/verify.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace laterna {

using Json = nlohmann::json;

namespace {

constexpr std::size_t most_triangles = 20000, most_residuals = 20000, most_arrows = 1500, most_points = 3000;
constexpr int cells_along = 96, bins = 40;

// Six digits are plenty for looking at, and short.
double shortened(double value) {
  if (value == 0 || !std::isfinite(value)) return 0;
  const double scale = std::pow(10.0, 5 - std::floor(std::log10(std::abs(value))));
  return std::round(value * scale) / scale;
}

void append(Json& list, const glm::dvec3& x) {
  for (int k = 0; k < 3; ++k) list.push_back(shortened(x[k]));
}

struct ThinMesh {
  std::vector<glm::dvec3> positions;
  std::vector<glm::uvec3> triangles;
};

// One vertex, the first, for each cell; triangles that keep three corners stay, once each.
ThinMesh thinned(const Mesh& mesh) {
  if (mesh.triangles.size() <= most_triangles) return {mesh.positions, mesh.triangles};
  const Box box = bounds(mesh);
  const glm::dvec3 size = box.high - box.low;
  const double cell = std::max({size.x, size.y, size.z}) / cells_along;
  std::map<std::tuple<int, int, int>, std::uint32_t> index_of;
  ThinMesh thin;
  const auto merged = [&](std::uint32_t vertex) {
    const glm::dvec3 at = glm::floor((mesh.positions[vertex] - box.low) / cell);
    const auto [found, fresh] =
        index_of.try_emplace({int(at.x), int(at.y), int(at.z)}, thin.positions.size());
    if (fresh) thin.positions.push_back(mesh.positions[vertex]);
    return found->second;
  };
  std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> seen;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::uvec3 m(merged(t.x), merged(t.y), merged(t.z));
    if (m.x == m.y || m.y == m.z || m.z == m.x) continue;
    if (seen.emplace(m.x, m.y, m.z).second) thin.triangles.push_back(m);
  }
  return thin;
}

Json mesh_figure(const Object& object) {
  const ThinMesh thin = thinned(object.mesh);
  Json positions = Json::array(), triangles = Json::array();
  for (const glm::dvec3& x : thin.positions)
    append(positions, glm::dvec3(object.world_from_object * glm::dvec4(x, 1)));
  for (const glm::uvec3& t : thin.triangles)
    for (int k = 0; k < 3; ++k) triangles.push_back(t[k]);
  return {{"name", object.name},
          {"triangles_in_file", object.mesh.triangles.size()},
          {"positions", std::move(positions)},
          {"triangles", std::move(triangles)}};
}

struct Residual {
  glm::dvec2 pixel, error;
  double sigma_px;
};

std::vector<Residual> residuals_of(const DecodedMap& decoded, const PixelArray<glm::dvec3>& points_world,
                                   const Device& estimate, std::size_t& valid) {
  std::vector<glm::ivec2> pixels;
  for (int y = 0; y < decoded.height; ++y)
    for (int x = 0; x < decoded.width; ++x)
      if (decoded.valid(x, y) && std::isfinite(points_world.values[points_world.index(x, y)].x))
        pixels.emplace_back(x, y);
  valid = pixels.size();
  const WorldProjection projection(estimate);
  std::vector<Residual> residuals;
  for (const std::size_t k : evenly_spread(pixels.size(), most_residuals)) {
    const glm::ivec2 p = pixels[k];
    const glm::dvec2 pixel(decoded.u_px(p.x, p.y), decoded.v_px(p.x, p.y));
    const glm::dvec2 error =
        pixel - glm::dvec2(projection.project(points_world.values[points_world.index(p.x, p.y)]));
    if (std::isfinite(error.x + error.y)) residuals.push_back({pixel, error, decoded.sigma_px(p.x, p.y)});
  }
  return residuals;
}

double below(double value, double sigma) { return 0.5 * std::erfc(-value / (sigma * std::sqrt(2.0))); }

Json histogram_figure(const std::vector<Residual>& residuals, double rms_px) {
  const double reach = std::max(4 * rms_px / std::sqrt(2.0), 1e-12), width = 2 * reach / bins;
  std::vector<double> edges, predicted(bins, 0.0);
  std::vector<int> count(bins, 0);
  for (int b = 0; b <= bins; ++b) edges.push_back(-reach + b * width);
  for (const Residual& r : residuals) {
    for (const double e : {r.error.x, r.error.y})
      if (std::abs(e) < reach) ++count[std::min(bins - 1, int((e + reach) / width))];
    for (int b = 0; b < bins; ++b)
      predicted[b] += 2 * (below(edges[b + 1], r.sigma_px) - below(edges[b], r.sigma_px));
  }
  return {{"edges_px", edges}, {"count", count}, {"predicted", predicted}};
}

double rms_of(const std::vector<glm::dvec2>& errors) {
  double sum = 0;
  for (const glm::dvec2& e : errors) sum += glm::dot(e, e);
  return std::sqrt(sum / double(errors.size()));
}

Json grid_row(const Device& truth, const Device& estimate, const std::vector<double>& covariance,
              double depth_m, const glm::dvec3& point) {
  const glm::dvec3 pixel = WorldProjection(truth).project(point);
  const glm::dvec2 error = error_vectors(truth, estimate, {&point, 1}).front();
  const auto sigma = predicted_rms(estimate, covariance, {&point, 1});
  return {{"depth_m", depth_m},
          {"u", finite_or_null(pixel.x)},
          {"v", finite_or_null(pixel.y)},
          {"du", finite_or_null(error.x)},
          {"dv", finite_or_null(error.y)},
          {"sigma_px", finite_or_null(sigma)}};
}

Json range_rows(const Device& truth, const Device& estimate, const std::vector<double>& covariance,
                double nearest_m, double farthest_m) {
  constexpr int steps = 16;
  Json rows = Json::array();
  for (int k = 0; k <= steps; ++k) {
    const double depth = nearest_m / 2 * std::pow(4 * farthest_m / nearest_m, double(k) / steps);
    const std::vector<glm::dvec3> points = image_grid(truth, {depth});
    if (points.empty()) continue;
    const auto predicted = predicted_rms(estimate, covariance, points);
    rows.push_back({{"depth_m", depth},
                    {"error_rms_px", finite_or_null(rms_of(error_vectors(truth, estimate, points)))},
                    {"predicted_rms_px", finite_or_null(predicted)}});
  }
  return rows;
}

}  // namespace

Json device_figure(const Device& device) {
  const Intrinsics& k = device.intrinsics;
  return {{"name", device.name},
          {"size", {k.size.x, k.size.y}},
          {"fx", k.fx},
          {"fy", k.fy},
          {"cx", k.cx},
          {"cy", k.cy},
          {"lens", {{"model", device.lens.model}}},
          {"device_from_world", rows_of(device.device_from_world)}};
}

Json rig_figure(const Scene& scene) {
  Json rig{{"projectors", Json::array()}, {"cameras", Json::array()}, {"meshes", Json::array()}};
  for (const Projector& p : scene.projectors) rig["projectors"].push_back(device_figure(p.device));
  for (const Camera& c : scene.cameras) rig["cameras"].push_back(device_figure(c.device));
  for (const Object& object : scene.objects) rig["meshes"].push_back(mesh_figure(object));
  return rig;
}

Json residual_figure(const DecodedMap& decoded, const PixelArray<glm::dvec3>& points_world,
                     const Device& estimate, const std::string& camera, const std::string& projector) {
  std::size_t valid = 0;
  const std::vector<Residual> residuals = residuals_of(decoded, points_world, estimate, valid);
  if (residuals.empty()) return nullptr;
  std::vector<glm::dvec2> errors;
  double variance = 0;
  for (const Residual& r : residuals) errors.push_back(r.error), variance += r.sigma_px * r.sigma_px;
  Json sample = Json::array();
  for (const std::size_t k : evenly_spread(residuals.size(), most_arrows)) {
    const Residual& r = residuals[k];
    sample.push_back(
        {shortened(r.pixel.x), shortened(r.pixel.y), shortened(r.error.x), shortened(r.error.y)});
  }
  const double rms = rms_of(errors);
  return {{"camera", camera},
          {"projector", projector},
          {"points", valid},
          {"used", residuals.size()},
          {"rms_px", rms},
          {"sigma_px", std::sqrt(variance / double(residuals.size()))},
          {"sample", std::move(sample)},
          {"histogram", histogram_figure(residuals, rms)}};
}

Json projection_figure(const Device& truth, const Device& estimate, const std::vector<double>& covariance,
                       std::span<const glm::dvec3> surface_points) {
  const std::vector<double> lit = depths_of(truth, surface_points);
  if (lit.empty()) return nullptr;
  const std::vector<double> volume = volume_depths(lit);
  const std::vector<double> shown{volume.front(), volume[volume.size() / 2], volume.back()};
  Json grid = Json::array();
  for (const double depth : shown)
    for (const glm::dvec3& point : image_grid(truth, {depth}))
      grid.push_back(grid_row(truth, estimate, covariance, depth, point));
  return {{"projector", truth.name},
          {"lit_depths_m", {volume.front(), volume.back()}},
          {"depths_m", shown},
          {"grid", std::move(grid)},
          {"by_range", range_rows(truth, estimate, covariance, volume.front(), volume.back())}};
}

Json points_figure(std::span<const glm::dvec3> points) {
  Json list = Json::array();
  for (const std::size_t k : evenly_spread(points.size(), most_points)) append(list, points[k]);
  return list;
}

}  // namespace laterna
