#include "calib/boards/lens_ladder.h"

#include "calib/boards/known_devices.h"
#include "calib/boards/rig_splines.h"
#include "sim/error.h"
#include "sim/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace laterna {

namespace {

using Terms = DeviceTerms;

struct Candidate {
  Terms terms;
  bool bend = false;
  std::string added;
  std::optional<RigFit> fit = {};
  Rung rung = {};
};

bool has(const std::vector<std::string>& terms, const char* term) {
  return std::find(terms.begin(), terms.end(), term) != terms.end();
}

std::vector<Candidate> candidates_after(const Candidate& current, const BoardCapture& capture,
                                        const LadderOptions& options) {
  const Terms& terms = current.terms;
  std::vector<Candidate> candidates;
  const bool none = std::all_of(terms.begin(), terms.end(), [](const auto& t) { return t.empty(); });
  const bool none_known = std::none_of(capture.devices.begin(), capture.devices.end(),
                                       [](const BoardDevice& device) { return device.known.has_value(); });
  if (none && none_known && terms.size() > 1)
    candidates.push_back({Terms(terms.size(), {"k1"}), current.bend, "k1 of every device"});
  for (std::size_t d = 0; d < terms.size(); ++d) {
    if (capture.devices[d].known) continue;
    for (const std::string& term : next_lens_terms(terms[d])) {
      Candidate c{terms, current.bend, capture.devices[d].name + " " + term};
      c.terms[d] = with_lens_term(terms[d], term);
      candidates.push_back(std::move(c));
    }
  }
  if (options.bend == LadderOptions::Bend::climbs && !current.bend)
    candidates.push_back({terms, true, "board bend"});
  return candidates;
}

RigModel model_of(const Terms& terms, bool bend, const LadderOptions& options, const BoardCapture& capture) {
  RigModel model;
  for (std::size_t d = 0; d < terms.size(); ++d) {
    model.devices.push_back(device_model(capture.devices[d], terms[d]));
    if (capture.devices[d].known) continue;
    model.devices.back().one_focal_length = options.one_focal_length;
    model.devices.back().fixed_center = options.fixed_center;
  }
  model.bend = bend;
  return model;
}

double scatter(const HeldOut& held_out) {
  const double n = double(held_out.folds.size());
  if (n < 2) return 0;
  double mean = 0, sum = 0;
  for (const HeldOutPose& fold : held_out.folds) mean += fold.rms_px / n;
  for (const HeldOutPose& fold : held_out.folds) sum += (fold.rms_px - mean) * (fold.rms_px - mean);
  return std::sqrt(sum / (n - 1));
}

// The focal length, principal point or distance that changed most, in shares of the focal length.
std::string what_moved(const BoardRig& before, const BoardRig& after, const BoardCapture& capture) {
  constexpr std::array<const char*, 4> names = {"fx", "fy", "cx", "cy"};
  std::string text;
  double most = 0;
  for (std::size_t d = 0; d < before.devices.size(); ++d) {
    for (int i = 0; i < 4; ++i) {
      const double step = after.devices[d].parameters[i] - before.devices[d].parameters[i];
      const double share = std::abs(step) / after.devices[d].parameters[0];
      if (!(share > most)) continue;
      most = share;
      text = fmt::format("{} {} {:+.1f}", capture.devices[d].name, names[i], step);
    }
  }
  return text;
}

void evaluate(Candidate& c, const BoardCapture& capture, const BoardRig& start, bool estimate_sigma,
              const LadderOptions& options) {
  c.rung.terms = c.terms, c.rung.bend = c.bend, c.rung.added = c.added;
  RigModel model = model_of(c.terms, c.bend, options, capture);
  add_spline_priors(model, start);
  c.fit = fit_rig(capture, model, start, estimate_sigma);
  if (!c.fit) return;
  c.rung.fit_rms_px = c.fit->rms_px;
  c.rung.held_out = hold_out_poses(c.fit->capture, c.fit->model, c.fit->adjustment.rig);
  c.rung.typical_px = geometric_mean_px(c.rung.held_out);
  c.rung.scatter_px = scatter(c.rung.held_out);
  c.rung.solved = c.rung.held_out.failed.empty();
}

void compare(Candidate& c, const Candidate& current, const BoardCapture& capture) {
  if (!c.fit) return;
  c.rung.gain_over_error = paired_gain_over_error(current.rung.held_out, c.rung.held_out);
  c.rung.moved = what_moved(current.fit->adjustment.rig, c.fit->adjustment.rig, capture);
}

bool passes(const Candidate& c, const Candidate& current, const LadderOptions& options) {
  return c.rung.solved && forecasts_better(current.rung.held_out, c.rung.held_out, options);
}

// A start for many terms: the fit with those of OpenCV's first four, then with k3 too. From a pinhole a
// rational model can wander off into a valley of its own.
BoardRig nearer_start(const BoardCapture& capture, const BoardRig& start, bool estimate_sigma,
                      const Terms& terms, const LadderOptions& options) {
  BoardRig rig = start;
  for (const char* word : {"opencv4", "opencv5"}) {
    Terms fewer = terms;
    for (auto& of_device : fewer) {
      const std::vector<std::string> within = lens_terms(word);
      std::erase_if(of_device, [&](const std::string& t) { return !has(within, t.c_str()); });
    }
    if (fewer == terms) break;
    const bool bend = options.bend == LadderOptions::Bend::on;
    if (const auto fit = fit_rig(capture, model_of(fewer, bend, options, capture), rig, estimate_sigma))
      rig = fit->adjustment.rig;
  }
  return rig;
}

[[noreturn]] void refuse_lens(const Terms& terms) {
  std::string names;
  for (const auto& t : terms) names += (names.empty() ? "" : " and ") + terms_text(t);
  throw Refusal(fmt::format("the solver does not converge with the lens {}", names));
}

Candidate first_rung(const BoardCapture& capture, const BoardRig& start, bool estimate_sigma,
                     const Terms& terms, const LadderOptions& options) {
  Candidate first{terms, options.bend == LadderOptions::Bend::on, ""};
  const Terms lean = lean_terms(terms);
  BoardRig rig = nearer_start(capture, start, estimate_sigma, lean, options);
  if (lean != terms) {
    const auto fit = fit_rig(capture, model_of(lean, first.bend, options, capture), rig, estimate_sigma);
    if (!fit) refuse_lens(lean);
    rig = with_splines(*fit, first.terms);
  }
  evaluate(first, capture, rig, estimate_sigma, options);
  if (!first.fit) refuse_lens(first.terms);
  first.rung.chosen = true;
  return first;
}

}  // namespace

std::vector<std::string> next_lens_terms(const std::vector<std::string>& terms) {
  if (!has(terms, "k1")) return {"k1"};
  std::vector<std::string> next;
  if (!has(terms, "k2")) next.emplace_back("k2");
  if (!has(terms, "p1p2")) next.emplace_back("p1p2");
  if (has(terms, "k2") && !has(terms, "k3")) next.emplace_back("k3");
  if (has(terms, "k3") && !has(terms, "k456")) next.emplace_back("k456");
  return next;
}

std::vector<std::string> with_lens_term(const std::vector<std::string>& terms, const std::string& term) {
  std::vector<std::string> all;
  for (const std::string& t : lens_terms("opencv12"))
    if (t == term || has(terms, t.c_str())) all.push_back(t);
  return all;
}

double geometric_mean_px(const HeldOut& held_out) {
  double sum = 0, count = 0;
  for (const HeldOutPose& fold : held_out.folds)
    if (fold.rms_px > 0) sum += std::log(fold.rms_px), ++count;
  return count > 0 ? std::exp(sum / count) : 0;
}

bool forecasts_better(const HeldOut& before, const HeldOut& after, const LadderOptions& options) {
  return paired_gain_over_error(before, after) > options.least_gain_over_error &&
         geometric_mean_px(after) < (1 - options.least_gain) * geometric_mean_px(before);
}

double paired_gain_over_error(const HeldOut& before, const HeldOut& after) {
  std::vector<double> gains;
  for (const HeldOutPose& a : before.folds) {
    for (const HeldOutPose& b : after.folds) {
      if (a.pose == b.pose && a.rms_px > 0 && b.rms_px > 0) gains.push_back(std::log(a.rms_px / b.rms_px));
    }
  }
  const double n = double(gains.size());
  if (n < 2) return 0;
  double mean = 0, sum = 0;
  for (const double gain : gains) mean += gain / n;
  for (const double gain : gains) sum += (gain - mean) * (gain - mean);
  const double error = std::sqrt(sum / (n - 1) / n);
  return error > 0 ? mean / error : 0;
}

Ladder climb(const BoardCapture& capture, const BoardRig& start, bool estimate_sigma,
             const LadderOptions& options) {
  Candidate current = first_rung(capture, start, estimate_sigma, Terms(capture.devices.size()), options);
  Ladder ladder;
  ladder.rungs.push_back(current.rung);
  while (capture.pose_count() >= 3) {
    std::vector<Candidate> candidates = candidates_after(current, capture, options);
    parallel_for(candidates.size(), [&](std::size_t i) {
      evaluate(candidates[i], capture, current.fit->adjustment.rig, estimate_sigma, options);
      compare(candidates[i], current, capture);
    });
    std::size_t best = candidates.size();
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (!passes(candidates[i], current, options)) continue;
      if (best == candidates.size() || candidates[i].rung.typical_px < candidates[best].rung.typical_px)
        best = i;
    }
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      candidates[i].rung.chosen = i == best;
      if (i == best) ladder.winner = ladder.rungs.size();
      ladder.rungs.push_back(candidates[i].rung);
    }
    if (best == candidates.size()) break;
    current = std::move(candidates[best]);
  }
  ladder.fit = std::move(*current.fit);
  return ladder;
}

Ladder single_rung(const BoardCapture& capture, const BoardRig& start, bool estimate_sigma,
                   const Terms& terms, const LadderOptions& options) {
  Candidate only = first_rung(capture, start, estimate_sigma, terms, options);
  return {{only.rung}, std::move(*only.fit), 0};
}

}  // namespace laterna
