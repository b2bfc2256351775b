#include "apps/lab/score/suspects.h"

#include "apps/lab/score/fitted.h"
#include "apps/lab/score/pairs.h"
#include "apps/lab/score/unconverged.h"
#include "apps/lab/score/undo.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace laterna {

namespace {

constexpr double beyond_noise = 5, within_noise = 3, least_error_px = 1e-3, parameter_penalty = 1e-3;
constexpr double above_any_noise = 30, above_most_noise = 10;

// A mistake with the way of undoing it that leaves least.
struct Trial {
  std::string suspect;
  int parameters = 0;
  double remaining_px2 = 0;
  std::string words{};
  double key(double error_px2) const { return remaining_px2 + parameter_penalty * parameters * error_px2; }
};

// What a result is told apart by.
struct Scale {
  double error_px2 = 0, noise_px2 = 0;  ///< noise_px2: three times the noise, squared
  double explains(double remaining_px2) const { return 1 - remaining_px2 / error_px2; }
};

double needed_share(const Trial& trial) {
  if (trial.suspect == "keystone") return 0.999;
  if (trial.parameters > 0) return 0.99;
  return trial.suspect == "half_pixel" ? 0.97 : 0.95;
}

bool is_told(const Trial& t, const Scale& scale) {
  const double explains = scale.explains(t.remaining_px2);
  return explains >= needed_share(t) || (t.remaining_px2 <= scale.noise_px2 && explains > 0.5);
}

std::vector<Trial> simple_trials(const ScoreRig& result, const Probe& probe) {
  std::vector<Trial> trials;
  for (const Undo& undo : undoings(probe.truth.projector.intrinsics.size)) {
    std::vector<glm::dvec2> pixels = result_pixels(undo.rig(result), probe);
    undo_pixels(undo, pixels);
    trials.push_back({undo.suspect, 0, squared_error_px2(pixels, probe)});
  }
  for (const FittedUndo& undo : fitted_undoings(result, probe))
    trials.push_back({undo.suspect, undo.parameters, undo.remaining_px2, undo.words});
  return trials;
}

// Whether a trial before this one, with fewer parameters, does as well.
bool is_needless(const Trial& trial, const std::vector<Trial>& before, const Scale& scale) {
  return std::any_of(before.begin(), before.end(), [&](const Trial& simpler) {
    return simpler.suspect == trial.suspect ||
           (simpler.parameters < trial.parameters &&
            (simpler.remaining_px2 <= scale.noise_px2 ||
             simpler.remaining_px2 - trial.remaining_px2 <= 0.01 * scale.error_px2));
  });
}

std::vector<Trial> told(std::vector<Trial> trials, const Scale& scale) {
  std::erase_if(trials, [&](const Trial& t) { return !is_told(t, scale); });
  std::stable_sort(trials.begin(), trials.end(), [&](const Trial& a, const Trial& b) {
    return a.key(scale.error_px2) < b.key(scale.error_px2);
  });
  std::vector<Trial> kept;
  for (const Trial& trial : trials)
    if (!is_needless(trial, kept, scale)) kept.push_back(trial);
  return kept;
}

Suspect suspect_of(const Trial& t, const Scale& scale) {
  return {t.suspect, scale.explains(t.remaining_px2),
          advice(t.suspect) + (t.words.empty() ? "" : " (" + t.words + ")")};
}

// Two in front of the others, where they do what no single one does.
void add_pair(const Pair& pair, double least_px2, const Scale& scale, std::vector<Suspect>& suspects) {
  const double explains = scale.explains(pair.remaining_px2);
  if (!(explains >= 0.999 && pair.remaining_px2 <= 0.1 * least_px2)) return;
  std::erase_if(suspects, [&](const Suspect& s) { return s.name == pair.first || s.name == pair.second; });
  suspects.insert(suspects.begin(),
                  {{pair.first, explains, advice(pair.first) + " (together with " + pair.second + ")"},
                   {pair.second, explains, advice(pair.second) + " (together with " + pair.first + ")"}});
}

}  // namespace

std::vector<Suspect> geometric_suspects(const ScoreRig& result, const Probe& probe, double noise_px,
                                        const Correspondences& decoded) {
  const Scale scale{squared_error_px2(result_pixels(result, probe), probe),
                    std::pow(within_noise * noise_px, 2)};
  const double error_px = std::sqrt(scale.error_px2);
  if (error_px <= std::max(least_error_px, beyond_noise * noise_px)) return {};
  std::vector<Trial> trials = simple_trials(result, probe);
  std::optional<Trial> stopped;
  const auto resolved = resolve_from(result, probe, decoded);
  if (resolved)
    stopped = {"unconverged", int(4 + result.projector.lens.parameters.size() + 6), resolved->remaining_px2};
  if (stopped && (resolved->is_stopped_descent || resolved->is_nominal_start)) trials.push_back(*stopped);
  const std::vector<Trial> kept = told(std::move(trials), scale);
  std::vector<Suspect> suspects;
  for (const Trial& trial : kept) suspects.push_back(suspect_of(trial, scale));
  const double least_px2 = kept.empty() ? scale.error_px2 : kept.front().remaining_px2;
  if (least_px2 > std::max(scale.noise_px2, least_error_px * least_error_px))
    add_pair(best_pair(result, probe), least_px2, scale, suspects);
  const double in_noises = noise_px > 0 ? error_px / noise_px : above_any_noise;
  const bool is_noise =
      in_noises < (resolved && resolved->is_like_noise ? above_any_noise : above_most_noise);
  if (suspects.empty() && stopped && !is_noise && is_told(*stopped, scale)) {
    stopped->words = "nothing else explains it, and a solver that goes on from here ends at the truth";
    suspects.push_back(suspect_of(*stopped, scale));
  }
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
