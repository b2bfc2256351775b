// The least model that will do: the cheapest scene whose calibration answer is within a tolerance of the
// full scene's.
#pragma once

#include "apps/lab/plan/answer.h"
#include "apps/lab/plan/choices.h"
#include "apps/lab/simulation.h"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace laterna {

struct PlanOptions {
  double tolerance_px = 0;  ///< above 0
  int seeds = 3;            ///< of every comparison, at least 2; four times as many where 3 cannot tell
  std::uint64_t seed = 1;   ///< all seeds are drawn from it
  bool resume = false;
  std::vector<std::string> set{};  ///< keys of the scene at other values, as parse_scene() takes them
};

/// A level of a choice, tried alone at low cost.
struct LevelTried {
  std::string value;
  Change change;
  int seeds = 0;
  double seconds_saved = NAN;  ///< of the full model's round trip at low cost, medians over the seeds
  Verdict verdict = Verdict::unsure;
};

/// A choice, and what became of it.
struct ChoiceMade {
  std::string name;
  bool is_effect = false;
  std::string full, plan;         ///< its value in the scene and in the plan
  std::vector<LevelTried> tried;  /// in the order of its levels, as far as was tried
  /// "dropped", or for a setting "cheaper"; "matters": any less changes the answer by more than the
  /// tolerance; "unsure": noise does not let its change be told from the tolerance; "not together": small
  /// alone, too much beside what was dropped; "not needed": nothing that was kept looks at it
  std::string end;
};

struct Plan {
  SceneSpec scene;  ///< files are looked for in the folder of the scene file
  std::vector<ChoiceMade> choices;
  Change confirmed;  ///< of the whole plan, at full cost, on seeds that chose nothing
  int confirmed_seeds = 0;
  double tolerance_px = 0;
  double noise_px = 0;  ///< spread of the full model's answer over the seeds, rms over the volume
  int halvings = 0;     ///< of the cameras' pixels, at low cost
  double seconds_full = NAN, seconds_plan = NAN;  ///< of whole round trips, in turn: medians over the seeds
  std::string weak;  ///< why the full model's own answer is weak; empty: it is ok
  bool interrupted = false;
};

/// Searches as follows, everything compared with the full scene by change_between().
///
///   full       The scene as it stands, at full cost and at low cost: with half the camera's pixels each way,
///              as often as that leaves 320 on the longer side and the answer's verdict no worse.
///   one by one Every level of every choice alone, at low cost (a camera's resolution at full cost), until
///              one changes too much. What is small is dropped, what is large or unsure stays.
///   jointly    All that is dropped together, at low cost. Where that is not small, the choice with the
///   largest
///              change per second saved goes one level back, until it is; seconds count in powers of two and
///              from a 64th of the round trip, so that a busy machine seldom plans otherwise. Then whatever
///              was given back and fits after all is dropped again.
///   confirmed  The same at full cost on fresh seeds, which chose nothing; where it is not small, more is
///   given
///              back. Each seed's full and reduced scene run one after the other, for their seconds.
///
/// Comparisons where the noise does not let tell are done again on four times the seeds.
///
/// All trials run in the given order, each with all threads; `folder` holds their journal (runner.h), and a
/// resumed run ends with what an uninterrupted one does. Throws InputError where the scene is unsound, has no
/// projector or camera or no patterns to decode, where an option is out of its range, and as run_jobs() does;
/// Refusal where the full scene's answer is refused.
Plan make_plan(const std::filesystem::path& scene_file, const std::filesystem::path& folder,
               const PlanOptions& options, const Progress& progress = {});

}  // namespace laterna
