#include "calib/boards/rig_fit.h"

#include "calib/boards/rig_covariance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace laterna {

namespace {

// |residual|² of each sighting of a capture, in its order, in px².
std::vector<double> squared_px(const BoardCapture& capture, const RigModel& model, const BoardRig& rig) {
  const RigProblem problem(capture, model);
  std::vector<double> squared;
  for (const Sighting& s : capture.sightings) {
    double pixel[2] = {INFINITY, INFINITY};
    predict(problem, rig, s, pixel, nullptr);
    squared.push_back(std::pow(pixel[0] - s.pixel.x, 2) + std::pow(pixel[1] - s.pixel.y, 2));
  }
  return squared;
}

// The covariance of the global parameters where some have a prior; empty without, or where it is singular.
std::vector<double> covariance_with_priors(const RigFit& fit, const RigProblem& problem) {
  const bool any = std::any_of(fit.model.devices.begin(), fit.model.devices.end(),
                               [](const DeviceModel& m) { return !m.prior.empty(); });
  const auto covariance = any ? rig_covariance(problem, fit.adjustment) : std::nullopt;
  return covariance ? covariance->global : std::vector<double>{};
}

// What the residuals of a device have adapted to. A parameter with a prior counts by the share that the
// sightings say of it, 1 - variance/prior variance.
double free_parameters(const RigFit& fit, const RigColumns& columns, const std::vector<double>& covariance,
                       int device) {
  const RigColumns::Of& of = columns.devices[device];
  const IntrinsicsPrior& prior = fit.model.devices[device].prior;
  double count = of.pose >= 0 ? 6 : 0;
  for (std::size_t i = 0; i < of.intrinsics.size(); ++i) {
    const int at = of.intrinsics[i];
    if (at < 0 || (i > 0 && at == of.intrinsics[i - 1])) continue;
    const bool weighed = !prior.empty() && !covariance.empty();
    const double kept = weighed ? covariance[std::size_t(at) * (std::size_t(columns.count) + 1)] : 0;
    count += 1 - (weighed ? std::min(1.0, kept * prior.inverse_sigma[i] * prior.inverse_sigma[i]) : 0);
  }
  if (device > 0) return count;
  return count + (fit.model.bend ? 2 : 0) + (fit.model.hold_poses ? 0 : 6 * fit.capture.pose_count());
}

void describe(RigFit& fit) {
  const std::vector<double> squared = squared_px(fit.capture, fit.model, fit.adjustment.rig);
  const std::size_t devices = fit.capture.devices.size();
  std::vector<double> sum(devices, 0.0), count(devices, 0.0);
  for (std::size_t i = 0; i < squared.size(); ++i) {
    sum[fit.capture.sightings[i].device] += squared[i];
    ++count[fit.capture.sightings[i].device];
  }
  fit.rms_px.clear(), fit.sigma_px.clear();
  const RigProblem problem(fit.capture, fit.model);
  const std::vector<double> covariance = covariance_with_priors(fit, problem);
  for (std::size_t d = 0; d < devices; ++d) {
    fit.rms_px.push_back(count[d] > 0 ? std::sqrt(sum[d] / count[d]) : 0);
    fit.sigma_px.push_back(std::sqrt(
        sum[d] / std::max(1.0, 2 * count[d] - free_parameters(fit, problem.columns, covariance, int(d)))));
  }
}

// Weights by residuals that a wrong model made would bend the solution: one common sigma, unless the devices'
// differ by more than a factor of two (equal weights lose little below it).
std::vector<double> weighting_sigmas(const RigFit& fit) {
  const auto [least, most] = std::minmax_element(fit.sigma_px.begin(), fit.sigma_px.end());
  if (*most > 2 * *least) return fit.sigma_px;
  double sum = 0, count = 0;
  for (const Sighting& s : fit.capture.sightings)
    sum += fit.sigma_px[s.device] * fit.sigma_px[s.device], ++count;
  return std::vector<double>(fit.sigma_px.size(), std::sqrt(sum / count));
}

void set_sigmas(BoardCapture& capture, const std::vector<double>& sigma_px) {
  for (Sighting& s : capture.sightings) s.sigma_px = std::max(sigma_px[s.device], 1e-9);
}

std::vector<double> median_sigmas(const BoardCapture& capture, const std::vector<double>& squared) {
  std::vector<double> sigmas;
  for (std::size_t d = 0; d < capture.devices.size(); ++d) {
    std::vector<double> of_device;
    for (std::size_t i = 0; i < squared.size(); ++i)
      if (capture.sightings[i].device == int(d)) of_device.push_back(squared[i]);
    if (of_device.empty()) of_device.push_back(1);
    const auto middle = of_device.begin() + std::ptrdiff_t(of_device.size() / 2);
    std::nth_element(of_device.begin(), middle, of_device.end());
    sigmas.push_back(std::sqrt(*middle / (2 * std::numbers::ln2)));
  }
  return sigmas;
}

}  // namespace

std::optional<RigFit> fit_rig(const BoardCapture& capture, const RigModel& model, const BoardRig& start,
                              bool estimate_sigma) {
  RigFit fit{model, capture, {}, {}, {}};
  BoardRig rig = fitted_to(start, model, capture);
  for (int round = 0; round < (estimate_sigma ? 3 : 1); ++round) {
    auto adjusted = adjust({fit.capture, model}, rig);
    if (!adjusted || !adjusted->converged) return std::nullopt;
    fit.adjustment = std::move(*adjusted);
    rig = fit.adjustment.rig;
    describe(fit);
    if (estimate_sigma && round < 2) set_sigmas(fit.capture, weighting_sigmas(fit));
  }
  return fit;
}

std::optional<Outliers> drop_outliers(const BoardCapture& capture, const RigModel& model,
                                      const BoardRig& start, double sigmas, double least_sigma_px) {
  Outliers result{capture, {}, {}};
  BoardRig rig = fitted_to(start, model, capture);
  for (int round = 0; round < 20; ++round) {
    auto adjusted = adjust({result.kept, model, {RobustLoss::Kind::cauchy, 3}}, rig);
    if (!adjusted) return std::nullopt;
    rig = adjusted->rig;
    const std::vector<double> squared = squared_px(result.kept, model, rig);
    std::vector<double> scale = median_sigmas(result.kept, squared);
    for (double& s : scale) s = std::max(s, least_sigma_px);
    std::vector<Sighting> kept;
    for (std::size_t i = 0; i < squared.size(); ++i) {
      const Sighting& s = result.kept.sightings[i];
      const double residual = std::sqrt(squared[i]);
      if (residual <= sigmas * scale[s.device]) {
        kept.push_back(s);
        continue;
      }
      result.dropped.push_back(s);
      result.residual_px.push_back(residual);
    }
    const bool settled = round > 0 && kept.size() == squared.size();
    result.kept.sightings = std::move(kept);
    set_sigmas(result.kept, scale);
    if (settled) break;
  }
  return result;
}

}  // namespace laterna
