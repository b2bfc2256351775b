#include "calib/selfcal/track_ladder.h"

#include "calib/selfcal/count.h"
#include "calib/selfcal/held_out_points.h"
#include "calib/selfcal/track_lens.h"
#include "calib/solve.h"

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

constexpr std::size_t most_points = 1000;

struct Candidate {
  Tracks tracks;
  TrackRig rig;
  TrackRung rung;
};

double rms_px(const Tracks& tracks, const TrackRig& rig) {
  const std::vector<double> r = scaled_residuals(tracks, rig);
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < r.size(); ++i)
    if (rig.has_point(tracks.sightings[i].point))
      sum += std::pow(r[i] * tracks.sightings[i].sigma_px, 2), ++count;
  return count > 0 ? std::sqrt(sum / count) : 0;
}

Candidate with_terms(const Candidate& current, std::vector<std::vector<std::string>> terms,
                     std::string added) {
  Candidate c{current.tracks, current.rig, {}};
  for (std::size_t d = 0; d < terms.size(); ++d)
    if (terms[d] != current.rung.terms[d]) set_lens_terms(c.tracks, c.rig, d, terms[d]);
  c.rung.terms = std::move(terms), c.rung.added = std::move(added);
  return c;
}

void evaluate(Candidate& c, const std::vector<UnitBaseline>& units, const RobustLoss& loss) {
  if (!count_numbers(c.tracks).enough()) return;
  const auto a = adjust_tracks(c.tracks, c.rig, units, loss, 200, 1e-10);
  if (!a) return;
  c.rig = a->rig;
  c.rung.fit_rms_px = rms_px(c.tracks, c.rig);
  c.rung.held_out = hold_out_points(c.tracks, c.rig, units);
  c.rung.solved = c.rung.held_out.failed.empty() && !c.rung.held_out.folds.empty();
}

std::vector<Candidate> candidates_after(const Candidate& current) {
  const auto& terms = current.rung.terms;
  std::vector<Candidate> candidates;
  std::vector<std::vector<std::string>> all = terms;
  int climbing = 0;
  for (std::size_t d = 0; d < terms.size(); ++d) {
    if (!current.tracks.devices[d].lens_climbs) continue;
    climbing += terms[d].empty();
    if (terms[d].empty()) all[d] = {"k1"};
  }
  if (climbing > 1) candidates.push_back(with_terms(current, all, "k1 of every device"));
  for (std::size_t d = 0; d < terms.size(); ++d) {
    if (!current.tracks.devices[d].lens_climbs) continue;
    for (const std::string& term : next_lens_terms(terms[d])) {
      auto more = terms;
      more[d] = with_lens_term(terms[d], term);
      candidates.push_back(with_terms(current, more, current.tracks.devices[d].name + " " + term));
    }
  }
  return candidates;
}

}  // namespace

Tracks some_points(const Tracks& tracks, std::size_t wanted) {
  std::vector<int> seen;  // points with sightings, in order
  for (const TrackSighting& s : tracks.sightings)
    if (seen.empty() || seen.back() != s.point) seen.push_back(s.point);
  std::vector<char> keep(tracks.point_names.size(), 0);
  for (const std::size_t i : evenly_spread(seen.size(), wanted)) keep[seen[i]] = 1;
  Tracks some = tracks;
  std::erase_if(some.sightings, [&](const TrackSighting& s) { return !keep[s.point]; });
  return some;
}

TrackLadder climb_lenses(Tracks& tracks, TrackRig& rig, const std::vector<UnitBaseline>& units,
                         const RobustLoss& loss, const LadderOptions& options) {
  TrackLadder ladder;
  if (std::none_of(tracks.devices.begin(), tracks.devices.end(), [](const auto& d) { return d.lens_climbs; }))
    return ladder;
  Candidate current{some_points(tracks, most_points), rig, {}};
  std::vector<char> used(rig.points.size(), 0);
  for (const TrackSighting& s : current.tracks.sightings) used[s.point] = 1;
  for (std::size_t p = 0; p < used.size(); ++p)
    if (!used[p]) current.rig.points[p] = glm::dvec3(NAN);
  current.rung.terms.resize(tracks.devices.size());
  evaluate(current, units, loss);
  current.rung.chosen = true;
  ladder.rungs.push_back(current.rung);
  while (current.rung.solved) {
    std::vector<Candidate> candidates = candidates_after(current);
    const Candidate* best = nullptr;
    for (Candidate& c : candidates) {
      evaluate(c, units, loss);
      c.rung.gain_over_error = paired_gain_over_error(current.rung.held_out, c.rung.held_out);
      if (c.rung.solved && forecasts_better(current.rung.held_out, c.rung.held_out, options) &&
          (!best || geometric_mean_px(c.rung.held_out) < geometric_mean_px(best->rung.held_out)))
        best = &c;
    }
    for (Candidate& c : candidates) {
      c.rung.chosen = &c == best;
      if (c.rung.chosen) ladder.winner = ladder.rungs.size();
      ladder.rungs.push_back(c.rung);
    }
    if (!best) break;
    current = *best;
  }
  tracks.devices = current.tracks.devices;
  rig.devices = current.rig.devices, rig.lenses = current.rig.lenses;
  rig.station_from_first = current.rig.station_from_first;
  for (std::size_t p = 0; p < used.size(); ++p) rig.points[p] = current.rig.points[p];
  return ladder;
}

}  // namespace laterna
