#include "apps/lab/board_text.h"

#include "apps/lab/trial_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>

namespace laterna {

namespace {

// A column for each device.
template <class Cell>
std::string columns_text(std::size_t devices, const Cell& cell) {
  std::string text;
  for (std::size_t d = 0; d < devices; ++d) text += cell(d);
  return text;
}

std::string rung_text(const Rung& rung) {
  const std::size_t devices = rung.terms.size();
  std::string text = fmt::format(
      "  {} {}{:<4}", rung.chosen ? '*' : ' ',
      columns_text(devices, [&](std::size_t d) { return fmt::format("{:<18} ", terms_text(rung.terms[d])); }),
      rung.bend ? "yes" : "no");
  if (rung.fit_rms_px.empty()) return text + " does not converge\n";
  text += columns_text(devices, [&](std::size_t d) { return fmt::format(" {:>6.3f}", rung.fit_rms_px[d]); });
  if (rung.held_out.folds.empty())
    text += fmt::format("   {:>8} {:>9} {:>6}", "-", "-", "-");
  else
    text += fmt::format("   {:>8.4f} {:>9.3f} {:>+6.1f}", rung.held_out.rms_px, rung.scatter_px,
                        rung.gain_over_error);
  text += "  " + rung.moved;
  if (!rung.held_out.failed.empty()) text += fmt::format("  ({} folds fail)", rung.held_out.failed.size());
  return text + "\n";
}

std::string ladder_text(const Ladder& ladder, const std::vector<Device>& devices) {
  std::string text = "lens ladder; * is climbed\n    ";
  text +=
      columns_text(devices.size(), [&](std::size_t d) { return fmt::format("{:<18} ", devices[d].name); });
  text +=
      fmt::format("{:<4}{}   {:>8} {:>9} {:>6}  {}\n", "bend",
                  columns_text(devices.size(),
                               [](std::size_t d) { return fmt::format(" {:>6}", d == 0 ? "fit px" : ""); }),
                  "held-out", "± scatter", "gain/σ", "moved");
  for (const Rung& rung : ladder.rungs) text += rung_text(rung);
  return text;
}

double value_of(const BoardCalibration& c, std::size_t column) {
  const RigFit& fit = c.ladder.fit;
  const RigColumns columns = columns_of(fit.model);
  for (std::size_t d = 0; d < columns.devices.size(); ++d) {
    const RigColumns::Of& of = columns.devices[d];
    for (std::size_t i = 0; i < of.intrinsics.size(); ++i)
      if (of.intrinsics[i] == int(column)) return fit.adjustment.rig.devices[d].parameters[i];
    const int at = int(column) - of.pose;
    const Rigid& place = fit.adjustment.rig.devices[d].device_from_camera;
    if (of.pose >= 0 && at >= 0 && at < 6)
      return at < 3 ? rotation_vector_rad(place.rotation)[at] : place.translation[at - 3];
  }
  return fit.adjustment.rig.bend[int(column) - columns.bend];
}

std::string parameters_text(const BoardCalibration& c) {
  std::string text = fmt::format("{:<28} {:>14} {:>12}\n", "parameter", "value", "sigma");
  for (std::size_t i = 0; i < c.parameter_names.size(); ++i)
    text += fmt::format("{:<28} {:>14.8g} {:>12.3g}\n", c.parameter_names[i], value_of(c, i), c.sigma[i]);
  return text;
}

std::string poses_text(const BoardCalibration& c) {
  std::string text = fmt::format("{:<6} {:>12} {:>14} {:>9} {:>6} {:>10} {:>9}\n", "pose", "sightings",
                                 "fit px", "distance", "tilt", "held-out", "leverage");
  for (std::size_t k = 0; k < c.diagnosis.poses.size(); ++k) {
    const PoseDiagnosis& p = c.diagnosis.poses[k];
    std::string held_out = "-";
    for (const HeldOutPose& fold : c.held_out().folds)
      if (fold.pose == int(k)) held_out = fmt::format("{:.3f}", fold.rms_px);
    text += fmt::format("{:<6} {:>12} {:>14} {:>9.4g} {:>5.0f}° {:>10} {:>9}\n", p.label,
                        fmt::format("{}", fmt::join(p.sightings, "+")),
                        fmt::format("{:.3f}", fmt::join(p.fit_rms_px, " ")), p.distance, p.tilt_deg, held_out,
                        p.leverage_px ? fmt::format("{:.3f}", *p.leverage_px) : "-");
  }
  return text;
}

std::string sureness_text(const BoardCalibration& c) {
  std::string text = "standard deviation of predicted pixels (noise alone)\n";
  for (std::size_t d = 0; d < c.devices.size(); ++d) {
    const bool known = c.ladder.fit.capture.devices[d].known.has_value();
    const bool exact = c.ladder.fit.model.devices[d].known;
    text += fmt::format("  {}: sightings in {:.0f} % of the image{}\n", c.devices[d].name,
                        100 * c.diagnosis.devices[d].coverage,
                        !known  ? ""
                        : exact ? "; its known intrinsics are taken for exact"
                                : "; its known intrinsics are a prior, with their sigmas");
    for (const RangeSigma& r : c.diagnosis.devices[d].ranges)
      text += fmt::format("    range {:>9.4g}: centre {:.3f}, whole image {:.3f}, worst {:.3f} px\n", r.range,
                          r.center_px, r.rms_px, r.worst_px);
  }
  return text;
}

std::string summary_text(const BoardCalibration& c) {
  const Diagnosis& d = c.diagnosis;
  int projectors = 0;
  for (std::size_t n = 0; n < c.devices.size(); ++n) projectors += !is_camera(c.ladder.fit.capture, int(n));
  const std::string held_out = c.held_out().folds.empty() ? "-" : fmt::format("{:.4f}", c.held_out().rms_px);
  std::string text =
      fmt::format("fit {:.4f} px rms, held out {} px rms; {} iterations ({})\n", c.fit_rms_px(), held_out,
                  c.ladder.fit.adjustment.iterations, c.ladder.fit.adjustment.termination);
  text += fmt::format(
      "predicted error over {}'s volume, of points fixed on the boards: {:.3f} px by noise alone, {} px by "
      "leaving poses out; of points fixed in the camera's frame, which turns with its centre: {:.3f} px\n",
      projectors > 1 ? "the worst projector" : c.devices.back().name, d.predicted_volume_rms_px,
      d.jackknife_volume_rms_px ? fmt::format("{:.3f}", *d.jackknife_volume_rms_px) : "-",
      d.predicted_volume_camera_frame_rms_px);
  text += fmt::format("weakest: {} (sigma {:.2g} in natural units, gap {:.1g})\n", d.weakest_direction,
                      d.weakest_sigma, d.smallest_gap);
  for (const std::string& words : d.correlations) text += "  " + words + "\n";
  return text;
}

std::string dropped_text(const BoardCalibration& c) {
  std::string text;
  for (std::size_t i = 0; i < c.dropped.size(); ++i)
    text += fmt::format("dropped: pose {}, corner {}, {}: {:.2f} px off\n", c.dropped_poses[i],
                        c.dropped[i].corner, c.dropped_devices[i], c.dropped_residual_px[i]);
  if (!c.unused_poses.empty())
    text +=
        fmt::format("not used: pose {}: no camera sees 4 corners or more\n", fmt::join(c.unused_poses, ", "));
  return text;
}

}  // namespace

std::string board_text(const BoardCalibration& c) {
  std::string text;
  if (c.status != Status::refused) {
    text = ladder_text(c.ladder, c.devices) + "\n" + parameters_text(c) + "\n" + poses_text(c) + "\n" +
           sureness_text(c) + "\n" + summary_text(c);
  }
  text += dropped_text(c);
  return text +
         fmt::format("verdict: {}{}{}\n", status_word(c.status), c.reason.empty() ? "" : ": ", c.reason);
}

std::string placements_text(const BoardFolders& folders) {
  std::string text;
  if (!folders.placements.empty())
    text = fmt::format("{:<6} {:<28} {:>7}  {}\n", "pose", "folder", "points",
                       "camera, projector: points read, median residual of the local fits");
  for (const BoardPlacement& p : folders.placements) {
    text += fmt::format("{:<6} {:<28} {:>7}  {},", p.pose, p.folder, p.points, p.camera);
    for (const BoardPlacement::Reading& r : p.projectors)
      text += fmt::format(" {}: {}, {:.3f} px", r.projector, r.reading.points, r.reading.median_residual_px);
    text += "\n";
  }
  for (const std::string& warning : folders.warnings) text += fmt::format("warning: {}\n", warning);
  return text.empty() ? text : text + "\n";
}

std::string methods_text(const std::vector<MethodResult>& results) {
  std::string text = fmt::format("{:<16} {:>14} {:>9} {:>10} {:>8} {:>9}  {}\n", "method", "fit px",
                                 "held-out", "over bound", "failures", "seconds", "projector fx, fy, cx, cy");
  for (const MethodResult& r : results) {
    if (!r.rig) {
      text += fmt::format("{:<16} {:>14} {:>9} {:>10} {:>8} {:>9}  {}\n", r.name, "-", "-", "-", "all", "-",
                          r.failure);
      continue;
    }
    const std::vector<double>& k = r.rig->devices.back().parameters;
    const std::string failures =
        fmt::format("{}/{}", r.held_out.failed.size(), r.held_out.failed.size() + r.held_out.folds.size());
    text += fmt::format("{:<16} {:>14} {:>9.4f} {:>10} {:>8} {:>9.4f}  {:.1f}, {:.1f}, {:.1f}, {:.1f}\n",
                        r.name, fmt::format("{:.3f}", fmt::join(r.fit_rms_px, " ")), r.held_out.rms_px,
                        r.over_bound ? fmt::format("{:.2f}", *r.over_bound) : "no truth", failures, r.seconds,
                        k[0], k[1], k[2], k[3]);
  }
  if (std::none_of(results.begin(), results.end(), [](const auto& r) { return r.over_bound.has_value(); }))
    text +=
        "over bound: the error over the least that noise allows, which takes a truth; of real sightings "
        "held-out is what tells methods apart\n";
  return text;
}

}  // namespace laterna
