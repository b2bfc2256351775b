#include "sim/lens.h"

#include "sim/error.h"
#include "sim/spline_knots.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

extern "C" {
#include <mrcal/mrcal.h>
}

namespace laterna {

struct LensProjection::Model {
  mrcal_lensmodel_t lensmodel{};
  std::vector<double> parameters;  // fx, fy, cx, cy, lens
};

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// mrcal aborts, or reads beyond its control points, on the splined models that are refused here.
bool is_usable_spline(const mrcal_LENSMODEL_SPLINED_STEREOGRAPHIC__config_t& spline) {
  const bool known_order = spline.order == 2 || spline.order == 3;
  return known_order && spline.Nx > spline.order && spline.Ny > spline.order && spline.Nx <= 512 &&
         spline.Ny <= 512 && spline.fov_x_deg >= 1 && spline.fov_x_deg < 360;
}

mrcal_lensmodel_t parse_model(const std::string& name) {
  mrcal_lensmodel_t lensmodel{};
  const bool known = mrcal_lensmodel_from_name(&lensmodel, name.c_str());
  const auto type = lensmodel.type;
  const bool accepted = known && type != MRCAL_LENSMODEL_LONLAT && type != MRCAL_LENSMODEL_LATLON &&
                        type != MRCAL_LENSMODEL_CAHVORE;
  if (accepted && type == MRCAL_LENSMODEL_SPLINED_STEREOGRAPHIC &&
      !is_usable_spline(lensmodel.LENSMODEL_SPLINED_STEREOGRAPHIC__config)) {
    throw InputError(
        fmt::format("lens model is \"{}\", expected order 2 or 3, Nx and Ny above the order and at "
                    "most 512, and fov_x_deg from 1 to 359",
                    name));
  }
  if (!accepted) {
    throw InputError(
        fmt::format("lens model is \"{}\", expected LENSMODEL_PINHOLE, _STEREOGRAPHIC, _OPENCV4, _OPENCV5, "
                    "_OPENCV8, _OPENCV12, "
                    "_CAHVOR or _SPLINED_STEREOGRAPHIC_order=..._Nx=..._Ny=..._fov_x_deg=...",
                    name));
  }
  return lensmodel;
}

bool call_mrcal(const mrcal_lensmodel_t& lensmodel, const double* parameters, const glm::dvec3& x,
                glm::dvec2& pixel, double* dpixel_dx, double* dpixel_dparameters) {
  const mrcal_point3_t p{.x = x.x, .y = x.y, .z = x.z};
  mrcal_point2_t q{};
  mrcal_point3_t dq_dp[2]{};
  if (!mrcal_project(&q, dpixel_dx ? dq_dp : nullptr, dpixel_dparameters, &p, 1, &lensmodel, parameters))
    return false;
  pixel = {q.x, q.y};
  for (int i = 0; dpixel_dx && i < 2; ++i) {
    dpixel_dx[3 * i] = dq_dp[i].x;
    dpixel_dx[3 * i + 1] = dq_dp[i].y;
    dpixel_dx[3 * i + 2] = dq_dp[i].z;
  }
  return std::isfinite(q.x) && std::isfinite(q.y);
}

}  // namespace

int lens_parameter_count(const std::string& model) {
  const mrcal_lensmodel_t lensmodel = parse_model(model);
  return mrcal_lensmodel_num_params(&lensmodel) - 4;
}

std::vector<glm::dvec2> spline_knots(const std::string& model) {
  const mrcal_lensmodel_t lensmodel = parse_model(model);
  if (lensmodel.type != MRCAL_LENSMODEL_SPLINED_STEREOGRAPHIC)
    throw InputError(fmt::format("lens model is \"{}\", expected a splined one", model));
  const auto& grid = lensmodel.LENSMODEL_SPLINED_STEREOGRAPHIC__config;
  std::vector<double> ux(grid.Nx), uy(grid.Ny);
  mrcal_knots_for_splined_models(ux.data(), uy.data(), &lensmodel);
  std::vector<glm::dvec2> knots;
  for (const double y : uy)
    for (const double x : ux) knots.emplace_back(x, y);
  return knots;
}

LensProjection::LensProjection(const Intrinsics& intrinsics, const Lens& lens)
    : intrinsics_(intrinsics), fold_radius_(infinity) {
  const int expected = lens_parameter_count(lens.model);
  if (int(lens.parameters.size()) != expected) {
    throw InputError(fmt::format("lens {}: found {} parameters, expected {}", lens.model,
                                 lens.parameters.size(), expected));
  }
  for (const double p : lens.parameters) {
    if (!std::isfinite(p))
      throw InputError(fmt::format("lens {}: a parameter is {}, expected finite numbers", lens.model, p));
  }
  if (laterna::is_pinhole(lens)) return;
  auto model = std::make_shared<Model>();
  model->lensmodel = parse_model(lens.model);
  model->parameters = {intrinsics.fx, intrinsics.fy, intrinsics.cx, intrinsics.cy};
  model->parameters.insert(model->parameters.end(), lens.parameters.begin(), lens.parameters.end());
  model_ = std::move(model);
  fold_radius_ = find_fold_radius();
}

bool LensProjection::evaluate(const glm::dvec2& xy, glm::dvec2& pixel, glm::dmat2& dpixel_dxy) const {
  double gradient[6];
  if (!call_mrcal(model_->lensmodel, model_->parameters.data(), {xy, 1.0}, pixel, gradient, nullptr))
    return false;
  dpixel_dxy = glm::dmat2(gradient[0], gradient[3], gradient[1], gradient[4]);
  return true;
}

// Marches outwards along 64 azimuths and bisects the first change of sign of the determinant.
double LensProjection::find_fold_radius() const {
  const double last = std::tan(89.0 * std::numbers::pi / 180);
  double fold = infinity;
  for (int k = 0; k < 64; ++k) {
    const double azimuth = 2 * std::numbers::pi * k / 64;
    const glm::dvec2 direction(std::cos(azimuth), std::sin(azimuth));
    const auto folded = [&](double r) {
      glm::dvec2 pixel(0.0);
      glm::dmat2 jacobian(0.0);
      return !evaluate(r * direction, pixel, jacobian) || !(glm::determinant(jacobian) > 0);
    };
    double inside = 0;
    for (double r = 0.005; r <= last && r < fold; r = r * 1.01 + 0.005) {
      if (!folded(r)) {
        inside = r;
        continue;
      }
      double outside = r;
      for (int i = 0; i < 50; ++i)
        (folded((inside + outside) / 2) ? outside : inside) = (inside + outside) / 2;
      fold = std::min(fold, inside);
    }
  }
  return fold;
}

std::optional<glm::dvec2> LensProjection::project(const glm::dvec3& x) const {
  if (!(x.z > 0)) return std::nullopt;
  const glm::dvec2 xy(x.x / x.z, x.y / x.z);
  if (is_pinhole()) {
    const glm::dvec2 pixel(intrinsics_.fx * xy.x + intrinsics_.cx, intrinsics_.fy * xy.y + intrinsics_.cy);
    if (!std::isfinite(pixel.x) || !std::isfinite(pixel.y)) return std::nullopt;
    return pixel;
  }
  if (!(glm::length(xy) < fold_radius_)) return std::nullopt;
  glm::dvec2 pixel(0.0);
  if (!call_mrcal(model_->lensmodel, model_->parameters.data(), {xy, 1.0}, pixel, nullptr, nullptr))
    return std::nullopt;
  return pixel;
}

// Newton with halved steps: a step that leaves the fold's circle, or does not come nearer, is halved.
std::optional<glm::dvec2> LensProjection::newton(const glm::dvec2& pixel, glm::dvec2 xy) const {
  constexpr double tolerance_px = 1e-9;
  glm::dvec2 seen(0.0), trial(0.0);
  glm::dmat2 jacobian(1.0), trial_jacobian(1.0);
  if (!(glm::length(xy) < fold_radius_) || !evaluate(xy, seen, jacobian)) return std::nullopt;
  double error = glm::length(pixel - seen);
  for (int iteration = 0; iteration < 50; ++iteration) {
    const glm::dvec2 step = glm::inverse(jacobian) * (pixel - seen);
    double fraction = 1;
    bool nearer = false;
    // Within the tolerance one more full step is tried, and no halves of it.
    for (; fraction > (error <= tolerance_px ? 0.6 : 1e-6) && !nearer; fraction /= 2) {
      const glm::dvec2 candidate = xy + fraction * step;
      if (!(glm::length(candidate) < fold_radius_) || !evaluate(candidate, trial, trial_jacobian)) continue;
      if (!(glm::length(pixel - trial) < error)) continue;
      xy = candidate, seen = trial, jacobian = trial_jacobian, error = glm::length(pixel - trial),
      nearer = true;
    }
    if (!nearer) break;  // at the rounding limit, or stuck
  }
  if (error <= tolerance_px) return xy;
  return std::nullopt;
}

std::optional<glm::dvec3> LensProjection::unproject(const glm::dvec2& pixel,
                                                    const std::optional<glm::dvec3>& start) const {
  const glm::dvec2 pinhole((pixel.x - intrinsics_.cx) / intrinsics_.fx,
                           (pixel.y - intrinsics_.cy) / intrinsics_.fy);
  if (!std::isfinite(pinhole.x) || !std::isfinite(pinhole.y)) return std::nullopt;
  if (is_pinhole()) return glm::dvec3(pinhole, 1.0);
  if (start) {
    if (const auto xy = newton(pixel, glm::dvec2(*start) / start->z)) return glm::dvec3(*xy, 1.0);
  }
  if (const auto xy = newton(pixel, pinhole)) return glm::dvec3(*xy, 1.0);
  if (const auto xy = newton(pixel, glm::dvec2(0.0))) return glm::dvec3(*xy, 1.0);
  return std::nullopt;
}

std::optional<glm::dvec2> LensProjection::warp(const glm::dvec2& pinhole_pixel) const {
  if (is_pinhole()) return pinhole_pixel;
  return project({(pinhole_pixel.x - intrinsics_.cx) / intrinsics_.fx,
                  (pinhole_pixel.y - intrinsics_.cy) / intrinsics_.fy, 1.0});
}

double LensProjection::pixels_per_unit_area(const glm::dvec3& x) const {
  if (is_pinhole()) return intrinsics_.fx * intrinsics_.fy;
  glm::dvec2 pixel(0.0);
  glm::dmat2 jacobian(0.0);
  if (!(x.z > 0) || !evaluate({x.x / x.z, x.y / x.z}, pixel, jacobian)) return 0;
  return std::max(0.0, glm::determinant(jacobian));
}

LensGradient::LensGradient(const std::string& model) : parameter_count_(4 + lens_parameter_count(model)) {
  if (laterna::is_pinhole(Lens{model, {}})) return;
  auto parsed = std::make_shared<LensProjection::Model>();
  parsed->lensmodel = parse_model(model);
  model_ = std::move(parsed);
}

bool LensGradient::project(std::span<const double> k, const glm::dvec3& x, double pixel[2], double* dpixel_dx,
                           double* dpixel_dparameters) const {
  if (!(x.z > 0)) return false;
  if (model_) {
    glm::dvec2 seen(0.0);
    if (!call_mrcal(model_->lensmodel, k.data(), x, seen, dpixel_dx, dpixel_dparameters)) return false;
    pixel[0] = seen.x, pixel[1] = seen.y;
    return true;
  }
  const double iz = 1 / x.z, a = x.x * iz, b = x.y * iz;
  pixel[0] = k[0] * a + k[2];
  pixel[1] = k[1] * b + k[3];
  if (dpixel_dx) {
    const double rows[6] = {k[0] * iz, 0, -k[0] * a * iz, 0, k[1] * iz, -k[1] * b * iz};
    std::copy(rows, rows + 6, dpixel_dx);
  }
  if (dpixel_dparameters) {
    const double rows[8] = {a, 0, 1, 0, 0, b, 0, 1};
    std::copy(rows, rows + 8, dpixel_dparameters);
  }
  return std::isfinite(pixel[0]) && std::isfinite(pixel[1]);
}

}  // namespace laterna
