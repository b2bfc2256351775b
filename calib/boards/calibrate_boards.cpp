#include "calib/boards/calibrate_boards.h"

#include "calib/boards/known_devices.h"
#include "calib/boards/rig_start.h"
#include "sim/error.h"
#include "sim/spline_knots.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

constexpr const char* more_poses =
    "add poses until there are five or more, tilted by 20° to 40° about both axes";

RigModel generous_model(const BoardCapture& capture) {
  RigModel model;
  for (const BoardDevice& device : capture.devices)
    model.devices.push_back(device_model(device, lens_terms("k1k2p1p2")));
  model.bend = true;
  return model;
}

// Without the poses of which every camera sees fewer than 4 corners.
BoardCapture usable_poses(const BoardCapture& capture, std::vector<int>& unused_labels) {
  std::vector<char> seen(capture.pose_labels.size(), 0);
  std::vector<int> usable;
  for (int d = 0; d < int(capture.devices.size()); ++d)
    for (const int k : is_camera(capture, d) ? poses_seen_by(capture, d) : std::vector<int>{}) seen[k] = 1;
  for (int k = 0; k < capture.pose_count(); ++k) {
    if (seen[k])
      usable.push_back(k);
    else
      unused_labels.push_back(capture.pose_labels[k]);
  }
  return with_poses(capture, usable);
}

bool is_flat(const BoardCapture& capture) {
  return std::all_of(capture.sightings.begin(), capture.sightings.end(),
                     [&](const Sighting& s) { return s.x_board.z == capture.sightings.front().x_board.z; });
}

// The generous model needs more poses than two; with fewer nothing is dropped.
BoardCapture without_outliers(const BoardCapture& capture, const BoardRig& start, const BoardOptions& options,
                              BoardCalibration& result) {
  if (!(options.drop_beyond_sigmas > 0) || capture.pose_count() < 3) return capture;
  auto outliers = drop_outliers(capture, generous_model(capture), start, options.drop_beyond_sigmas);
  if (!outliers || outliers->dropped.empty()) return capture;
  result.dropped = std::move(outliers->dropped);
  result.dropped_residual_px = std::move(outliers->residual_px);
  for (const Sighting& s : result.dropped) {
    result.dropped_devices.push_back(capture.devices[s.device].name);
    result.dropped_poses.push_back(capture.pose_labels[s.pose]);
  }
  if (!options.estimate_sigma) {  // the believed sigmas come back
    BoardCapture kept = capture;
    std::erase_if(kept.sightings, [&](const Sighting& s) {
      return std::any_of(result.dropped.begin(), result.dropped.end(), [&](const Sighting& d) {
        return d.device == s.device && d.pose == s.pose && d.corner == s.corner && d.pixel == s.pixel;
      });
    });
    return kept;
  }
  return outliers->kept;
}

double focal_sigma_share(const BoardCalibration& result) {
  const RigColumns columns = columns_of(result.ladder.fit.model);
  double most = 0;
  for (std::size_t d = 0; d < columns.devices.size(); ++d)
    for (int i = 0; i < 2; ++i)
      if (const int at = columns.devices[d].intrinsics[i]; at >= 0)
        most = std::max(most, result.sigma[at] / result.ladder.fit.adjustment.rig.devices[d].parameters[i]);
  return most;
}

void add_capture_weaknesses(const BoardCalibration& r, const BoardCapture& capture,
                            std::vector<std::string>& weak) {
  const int poses = r.ladder.fit.capture.pose_count();
  const bool placements_alone = all_known(capture);
  if (poses < 3 && !placements_alone)
    weak.push_back(
        fmt::format("only {} poses: none can be held out to test the result; {}", poses, more_poses));
  if (r.diagnosis.tilt_spread_deg < 10 && !placements_alone)
    weak.push_back(
        fmt::format("the boards are nearly parallel (their normals within {:.1f}°): focal length and "
                    "distance trade off; add poses tilted by 20° to 40° about both axes",
                    r.diagnosis.tilt_spread_deg));
  const double share = double(r.dropped.size()) / double(std::max<std::size_t>(1, capture.sightings.size()));
  if (share > 0.05)
    weak.push_back(
        fmt::format("{:.0f} % of the sightings are outliers; look at the dropped corners, and at "
                    "the board's measures",
                    100 * share));
}

void add_forecast_weaknesses(const BoardCalibration& r, const BoardOptions& options,
                             std::vector<std::string>& weak) {
  const Diagnosis& d = r.diagnosis;
  const HeldOut& held_out = r.held_out();
  if (r.ladder.fit.capture.pose_count() >= 3 && !held_out.failed.empty()) {
    std::vector<int> labels;
    for (const int k : held_out.failed) labels.push_back(r.ladder.fit.capture.pose_labels[k]);
    weak.push_back(
        fmt::format("there is no solution without pose {}; {}", fmt::join(labels, ", "), more_poses));
  }
  const double predicted = std::max(d.predicted_volume_rms_px, d.jackknife_volume_rms_px.value_or(0));
  if (!(predicted <= options.tolerance_px)) {
    weak.push_back(fmt::format(
        "the predicted error over the projector's whole image is {:.2g} px, above the tolerance of "
        "{:.2g} px ({}); {}",
        predicted, options.tolerance_px, d.weakest_direction, cure_for(d.weakest_direction)));
  }
  if (const double share = focal_sigma_share(r); !(share <= 0.02)) {
    weak.push_back(fmt::format("a focal length is known to {:.2g} % only ({}); {}", 100 * share,
                               d.weakest_direction, cure_for(" fx")));
  }
  if (!held_out.folds.empty() && held_out.rms_px > 3 * std::max(r.fit_rms_px(), 1e-9) &&
      held_out.rms_px > 0.2 * options.tolerance_px) {
    weak.push_back(fmt::format("it forecasts held-out poses to {:.3g} px where it fits to {:.3g} px; {}",
                               held_out.rms_px, r.fit_rms_px(), more_poses));
  }
  if (!d.maps_its_volume) weak.emplace_back("the estimated lens maps no ray to parts of an image");
}

// A spline is told only where sightings lie: what it predicts over its own image, at the boards' middle
// range.
void add_spline_weakness(const BoardCalibration& r, const BoardOptions& options,
                         std::vector<std::string>& weak) {
  const RigModel& model = r.ladder.fit.model;
  for (std::size_t d = 0; d < r.devices.size(); ++d) {
    const DeviceDiagnosis& device = r.diagnosis.devices[d];
    if (!is_splined(model.devices[d].lens_model) || model.devices[d].known || device.ranges.size() < 2)
      continue;
    const double predicted_px = device.ranges[1].rms_px;
    if (predicted_px <= options.tolerance_px) continue;
    weak.push_back(
        fmt::format("{}: its spline is predicted to {:.2g} px over its whole image, above the tolerance of "
                    "{:.2g} px, with "
                    "sightings in {:.0f} % of it; let boards reach the rest, or take a lens of few terms",
                    r.devices[d].name, predicted_px, options.tolerance_px, 100 * device.coverage));
  }
}

void add_residual_weakness(const BoardCalibration& r, const BoardOptions& options,
                           std::vector<std::string>& weak) {
  if (options.estimate_sigma) return;
  const RigFit& fit = r.ladder.fit;
  for (std::size_t d = 0; d < fit.sigma_px.size(); ++d) {
    double believed = 0, count = 0;
    for (const Sighting& s : fit.capture.sightings)
      if (s.device == int(d)) believed += s.sigma_px * s.sigma_px, ++count;
    const double ratio = fit.sigma_px[d] / std::sqrt(believed / std::max(1.0, count));
    if (ratio > 2)
      weak.push_back(
          fmt::format("{}: the residuals are {:.2g} times what the sigmas explain: a lens modelled "
                      "too simply, a bent board or outliers",
                      fit.capture.devices[d].name, ratio));
  }
}

// Where the bend was left out by order: whether the residuals follow one that would move the volume by more
// than twice what is predicted. χ² with two degrees of freedom is above 23 once in 10⁵.
void add_bend_weakness(const BoardCalibration& r, const BoardOptions& options,
                       std::vector<std::string>& weak) {
  const RigFit& fit = r.ladder.fit;
  if (fit.model.bend || options.ladder.bend != LadderOptions::Bend::off || fit.capture.pose_count() < 3)
    return;
  RigModel model = fit.model;
  model.bend = true;
  const auto bent = fit_rig(fit.capture, model, fit.adjustment.rig, false);
  if (!bent || fit.adjustment.loss - bent->adjustment.loss < 23) return;
  const double moved = volume_distance_px(fit, bent->adjustment.rig).value_or(INFINITY);
  const double predicted =
      std::max(r.diagnosis.predicted_volume_rms_px, r.diagnosis.jackknife_volume_rms_px.value_or(0));
  if (moved <= 2 * predicted) return;
  weak.push_back(
      fmt::format("the residuals follow a bent board ({:.2g} and {:.2g} in the middle), which would move the "
                  "projector's volume by {:.2g} px where {:.2g} px are predicted; let the bend be solved for",
                  bent->adjustment.rig.bend.x, bent->adjustment.rig.bend.y, moved, predicted));
}

BoardCalibration& refuse(BoardCalibration& result, std::string reason) {
  result.status = Status::refused;
  result.reason = std::move(reason);
  return result;
}

// Devices, sigmas, diagnosis; a reason where the parameters are not determined.
std::string describe(BoardCalibration& result) {
  const RigFit& fit = result.ladder.fit;
  const RigProblem problem(fit.capture, fit.model);
  result.parameter_names = column_names(fit.model, fit.capture);
  const auto covariance = rig_covariance(problem, fit.adjustment);
  if (!covariance) {
    const std::string words = weakest_direction(fit, eliminated_factor(problem, fit.adjustment)).words;
    return fmt::format("the sightings do not determine every parameter: {}; {}", words, cure_for(words));
  }
  for (int d = 0; d < int(fit.capture.devices.size()); ++d) {
    result.devices.push_back(device_of(fit.adjustment.rig, fit.model, fit.capture, d));
    const Intrinsics& k = result.devices.back().intrinsics;
    if (!(k.fx > 0 && k.fy > 0))
      return fmt::format("{}: the best fit has a negative focal length: the picture is mirrored",
                         result.devices.back().name);
  }
  result.covariance = *covariance;
  const int g = covariance->globals;
  for (int i = 0; i < g; ++i) result.sigma.push_back(std::sqrt(covariance->global[i * g + i]));
  result.diagnosis = diagnose(fit, *covariance, result.held_out());
  return "";
}

}  // namespace

double BoardCalibration::fit_rms_px() const {
  const RigFit& fit = ladder.fit;
  double sum = 0, count = 0;
  for (const Sighting& s : fit.capture.sightings)
    if (!is_camera(fit.capture, s.device)) sum += fit.rms_px[s.device] * fit.rms_px[s.device], ++count;
  return count > 0 ? std::sqrt(sum / count) : 0;
}

const HeldOut& BoardCalibration::held_out() const {
  static const HeldOut none;
  return ladder.rungs.empty() ? none : ladder.rungs[ladder.winner].held_out;
}

BoardCalibration calibrate_boards(const BoardCapture& capture, const BoardOptions& options) {
  validate(capture);
  BoardCalibration result;
  const BoardCapture usable = usable_poses(capture, result.unused_poses);
  if (usable.pose_count() == 1 && is_flat(usable) && !all_known(usable)) {
    return refuse(result, fmt::format("one pose of a flat board: focal length and distance cannot be told "
                                      "apart; {}, or give the known intrinsics of every device",
                                      more_poses));
  }
  const RigStart start = start_rig(usable);
  if (!start.rig) return refuse(result, start.refusal);
  const BoardCapture kept = without_outliers(usable, *start.rig, options, result);
  try {
    result.ladder = options.terms.empty() ? climb(kept, *start.rig, options.estimate_sigma, options.ladder)
                                          : single_rung(kept, *start.rig, options.estimate_sigma,
                                                        options.terms, options.ladder);
  } catch (const Refusal& refusal) {
    return refuse(result, fmt::format("{}; {}", refusal.what(), more_poses));
  }
  const std::string undetermined = describe(result);
  if (!undetermined.empty()) return refuse(result, undetermined);
  std::vector<std::string> weak;
  add_capture_weaknesses(result, capture, weak);
  add_forecast_weaknesses(result, options, weak);
  add_spline_weakness(result, options, weak);
  add_residual_weakness(result, options, weak);
  add_bend_weakness(result, options, weak);
  if (const std::string twin = second_placement(result.ladder.fit); !twin.empty()) weak.push_back(twin);
  result.status = weak.empty() ? Status::ok : Status::weak;
  result.reason = fmt::format("{}", fmt::join(weak, "; "));
  return result;
}

void add_doubts(BoardCalibration& calibration, const std::vector<std::string>& doubts) {
  if (doubts.empty()) return;
  if (calibration.status == Status::ok) calibration.status = Status::weak;
  calibration.reason += (calibration.reason.empty() ? "" : "; ") + fmt::format("{}", fmt::join(doubts, "; "));
}

}  // namespace laterna
