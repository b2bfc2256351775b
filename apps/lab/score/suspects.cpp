#include "apps/lab/score/suspects.h"

#include "apps/lab/score/fitted.h"
#include "apps/lab/score/unconverged.h"
#include "apps/lab/score/undo.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace laterna {

namespace {

constexpr double beyond_noise = 5, within_noise = 3, least_error_px = 1e-3, parameter_penalty = 1e-3;

// A mistake with the way of undoing it that leaves least.
struct Trial {
  std::string suspect;
  int parameters = 0;
  double remaining_px2 = 0;
  double key(double error_px2) const { return remaining_px2 + parameter_penalty * parameters * error_px2; }
};

double needed_share(const Trial& trial) {
  if (trial.parameters > 1 && trial.suspect == "keystone") return 0.999;
  if (trial.parameters > 0) return 0.99;
  return trial.suspect == "half_pixel" ? 0.9 : 0.8;
}

std::vector<Trial> all_trials(const ScoreRig& result, const Probe& probe) {
  std::vector<Trial> trials;
  for (const Undo& undo : undoings(probe.truth.projector.intrinsics.size)) {
    std::vector<glm::dvec2> pixels = result_pixels(undo.rig ? undo.rig(result) : result, probe);
    if (undo.pixel) std::transform(pixels.begin(), pixels.end(), pixels.begin(), undo.pixel);
    trials.push_back({undo.suspect, 0, squared_error_px2(pixels, probe)});
  }
  for (const FittedUndo& undo : fitted_undoings(result, probe))
    trials.push_back({undo.suspect, undo.parameters, undo.remaining_px2});
  const auto resolved = resolve_from(result, probe);
  if (resolved && (resolved->is_stopped_descent || resolved->is_nominal_start))
    trials.push_back(
        {"unconverged", int(4 + result.projector.lens.parameters.size() + 6), resolved->remaining_px2});
  return trials;
}

// Whether a trial before this one, with fewer parameters, does as well.
bool is_needless(const Trial& trial, const std::vector<Trial>& before, double error_px2, double noise_px2) {
  return std::any_of(before.begin(), before.end(), [&](const Trial& simpler) {
    return simpler.suspect == trial.suspect ||
           (simpler.parameters < trial.parameters &&
            (simpler.remaining_px2 <= noise_px2 ||
             simpler.remaining_px2 - trial.remaining_px2 <= 0.01 * error_px2));
  });
}

}  // namespace

std::vector<Suspect> geometric_suspects(const ScoreRig& result, const Probe& probe, double noise_px) {
  const double error_px2 = squared_error_px2(result_pixels(result, probe), probe);
  if (std::sqrt(error_px2) <= std::max(least_error_px, beyond_noise * noise_px)) return {};
  const double noise_px2 = std::pow(within_noise * noise_px, 2);
  std::vector<Trial> trials = all_trials(result, probe);
  std::erase_if(trials, [&](const Trial& t) {
    const double explains = 1 - t.remaining_px2 / error_px2;
    return !(explains >= needed_share(t) || (t.remaining_px2 <= noise_px2 && explains > 0.5));
  });
  std::stable_sort(trials.begin(), trials.end(),
                   [&](const Trial& a, const Trial& b) { return a.key(error_px2) < b.key(error_px2); });
  std::vector<Trial> kept;
  for (const Trial& trial : trials)
    if (!is_needless(trial, kept, error_px2, noise_px2)) kept.push_back(trial);
  std::vector<Suspect> suspects;
  for (const Trial& trial : kept)
    suspects.push_back({trial.suspect, 1 - trial.remaining_px2 / error_px2, advice(trial.suspect)});
  return suspects;
}

std::string advice(const std::string& suspect) {
  static const std::map<std::string, std::string> clauses{
      {"size_swapped",
       "exchange width and height of the projector's picture where the calibration is told them"},
      {"half_pixel", "count pixels from their centres: move the principal point by half a pixel"},
      {"y_flipped", "turn the y axis: rows are counted from the top, and y points down"},
      {"inverse_pose", "invert the placement: projector_from_world is wanted, not world_from_projector"},
      {"rotation_transposed", "transpose the rotation, and leave the translation"},
      {"unit_scale", "give lengths in metres"},
      {"axes_exchanged", "exchange the codes of columns and rows"},
      {"gamma", "show and photograph linear light, or take the response out of the pictures before decoding"},
      {"keystone", "turn the projector's keystone off, or keep the skew: no zero-skew K holds it"},
      {"overscan", "turn the projector's overscan off, or calibrate for the picture that it scales"},
      {"dropped_frame", "take the pictures again: a pattern was dropped, repeated or stored out of order"},
      {"unconverged", "let the solver run on: more iterations, or another start"}};
  const auto found = clauses.find(suspect);
  return found == clauses.end() ? "" : found->second;
}

}  // namespace laterna
