#include "apps/lab/plan/plan.h"

#include "apps/lab/cell_seed.h"
#include "apps/lab/files_digest.h"
#include "apps/lab/plan/plan_trials.h"
#include "sim/error.h"
#include "sim/scene_build.h"
#include "sim/scene_file.h"
#include "sim/self_contained.h"
#include "sim/text_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

namespace laterna {

namespace {

constexpr int low_cost_side_px = 320;

/// What a plan knows while it is made.
struct Search {
  const std::vector<Choice>& choices;
  PlanTrials& trials;
  Plan& plan;
  PlanSeeds seeds;
  std::vector<std::vector<LevelTried>> tried;  // by choice, by level
  Levels levels;                               // of the plan so far
  std::vector<std::size_t> given_back;         // choices, in this order
};

bool is_resolution(const Choice& choice) { return choice.name == "resolution"; }

Status worst_of(const std::vector<RoundTrip>& trips) {
  Status worst = Status::ok;
  for (const RoundTrip& trip : trips)
    for (const Answer& answer : trip.answers) worst = std::max(worst, answer.status);
  return worst;
}

std::string first_reason(const std::vector<RoundTrip>& trips, Status status) {
  for (const RoundTrip& trip : trips)
    for (const Answer& answer : trip.answers)
      if (answer.status == status) return answer.reason;
  return "";
}

// How far the cameras can be halved for the search.
void find_low_cost(Search& s, const Scene& scene) {
  const std::vector<RoundTrip> full = s.trials.full(0, s.seeds);
  const Status status = worst_of(full);
  if (status == Status::refused)
    throw Refusal("the full scene itself: " + first_reason(full, Status::refused));
  if (status == Status::weak) s.plan.weak = first_reason(full, Status::weak);
  int halvings = 0;
  while (longest_side_px(scene) >> (halvings + 1) >= low_cost_side_px) ++halvings;
  while (halvings > 0 && worst_of(s.trials.full(halvings, s.seeds)) > status) --halvings;
  s.plan.halvings = halvings;
}

// The scene with one choice at a level and all else as it stands.
Levels alone(const Search& s, std::size_t choice, int level) {
  Levels levels(s.choices.size(), 0);
  levels[choice] = level;
  return levels;
}

void note(Search& s, std::size_t choice, const Compared& c) {
  const Choice& of = s.choices[choice];
  s.tried[choice].push_back(
      {of.levels[s.tried[choice].size()].value, c.change, c.seeds, c.seconds_full - c.seconds, c.verdict});
}

// Whether the choice's next level is worth a try.
bool goes_on(const Search& s, std::size_t choice) {
  const auto& tried = s.tried[choice];
  return tried.size() < s.choices[choice].levels.size() &&
         (tried.empty() || !s.choices[choice].is_ordered || tried.back().verdict == Verdict::small);
}

void one_by_one(Search& s) {
  for (bool more = true; more;) {
    more = false;
    for (const bool at_full_cost : {false, true}) {
      std::vector<std::size_t> at;
      std::vector<Levels> models;
      for (std::size_t k = 0; k < s.choices.size(); ++k) {
        if (is_resolution(s.choices[k]) != at_full_cost || !goes_on(s, k)) continue;
        at.push_back(k);
        models.push_back(alone(s, k, int(s.tried[k].size()) + 1));
      }
      if (at.empty()) continue;
      const auto compared =
          s.trials.compare(models, at_full_cost ? 0 : s.plan.halvings, s.seeds, "one by one");
      for (std::size_t i = 0; i < at.size(); ++i) note(s, at[i], compared[i]);
      more = true;
    }
  }
}

// The last level up to `most` that is small alone; 0: none.
int smallest_level(const Search& s, std::size_t choice, int most) {
  for (int level = std::min(most, int(s.tried[choice].size())); level > 0; --level)
    if (s.tried[choice][std::size_t(level) - 1].verdict == Verdict::small) return level;
  return 0;
}

// What a level changes for each second that it saves, as coarsely as seconds are known.
double price(const LevelTried& tried, double seconds_full) {
  const double share = std::max(tried.seconds_saved / seconds_full, 1.0 / 64);  // NaN: 1/64
  return tried.change.change_px / std::exp2(std::round(std::log2(std::isfinite(share) ? share : 1.0 / 64)));
}

// Gives one level back of the choice with the largest price; false where nothing is left to give.
bool give_back(Search& s, double seconds_full, bool with_resolution) {
  std::optional<std::size_t> dearest;
  double largest = -1;
  for (std::size_t k = 0; k < s.choices.size(); ++k) {
    if (s.levels[k] == 0 || (is_resolution(s.choices[k]) && !with_resolution)) continue;
    const double p = price(s.tried[k][std::size_t(s.levels[k]) - 1], seconds_full);
    if (p > largest) largest = p, dearest = k;
  }
  if (!dearest) return false;
  s.levels[*dearest] = smallest_level(s, *dearest, s.levels[*dearest] - 1);
  s.given_back.push_back(*dearest);
  return true;
}

Levels without_resolution(const Search& s, Levels levels) {
  for (std::size_t k = 0; k < s.choices.size(); ++k)
    if (is_resolution(s.choices[k])) levels[k] = 0;
  return levels;
}

bool is_nothing(const Levels& levels) {
  return std::all_of(levels.begin(), levels.end(), [](int level) { return level == 0; });
}

Compared jointly_at_low_cost(Search& s, const Levels& levels) {
  return s.trials.compare({without_resolution(s, levels)}, s.plan.halvings, s.seeds, "jointly").front();
}

void jointly(Search& s) {
  for (std::size_t k = 0; k < s.choices.size(); ++k)
    s.levels[k] = smallest_level(s, k, int(s.tried[k].size()));
  while (!is_nothing(without_resolution(s, s.levels))) {
    const Compared c = jointly_at_low_cost(s, s.levels);
    if (c.verdict == Verdict::small || !give_back(s, c.seconds_full, false)) break;
  }
  for (const std::size_t k : std::vector<std::size_t>(s.given_back)) {
    Levels again = s.levels;
    again[k] = smallest_level(s, k, int(s.tried[k].size()));
    if (again[k] > s.levels[k] && jointly_at_low_cost(s, again).verdict == Verdict::small) s.levels = again;
  }
}

void confirm(Search& s, const PlanOptions& options) {
  for (;;) {
    const Compared c =
        s.trials.compare({s.levels}, 0, {true, options.seeds}, "confirming at full cost").front();
    if (c.verdict != Verdict::small && give_back(s, c.seconds_full, true)) continue;
    s.plan.confirmed = c.change, s.plan.confirmed_seeds = c.seeds;
    s.plan.seconds_full = c.seconds_full, s.plan.seconds_plan = c.seconds;
    s.plan.noise_px = c.change.spread_full_px;
    return;
  }
}

std::string end_of(const Search& s, std::size_t k, int level) {
  const Choice& choice = s.choices[k];
  if (!choice.is_needed(s.plan.scene) && !choice.is_effect) return "not needed";
  if (level > 0) return choice.is_effect ? "dropped" : "cheaper";
  if (std::find(s.given_back.begin(), s.given_back.end(), k) != s.given_back.end()) return "not together";
  return std::any_of(s.tried[k].begin(), s.tried[k].end(),
                     [](const LevelTried& t) { return t.verdict == Verdict::unsure; })
             ? "unsure"
             : "matters";
}

void report_choices(Search& s, const SceneSpec& spec) {
  s.plan.scene = at_levels(spec, s.choices, s.levels);
  for (std::size_t k = 0; k < s.choices.size(); ++k) {
    const Choice& choice = s.choices[k];
    const int level = s.levels[k];
    const bool fell = choice.is_effect && !choice.is_needed(s.plan.scene);  // also with another
    const std::string& value = level > 0 ? choice.levels[std::size_t(level) - 1].value : choice.full;
    s.plan.choices.push_back({choice.name, choice.is_effect, choice.full, fell ? "off" : value, s.tried[k],
                              fell ? "dropped" : end_of(s, k, level)});
  }
}

void check_options(const PlanOptions& options) {
  if (!(options.tolerance_px > 0) || !std::isfinite(options.tolerance_px))
    throw InputError(fmt::format("the tolerance is {} px, expected a number above 0", options.tolerance_px));
  if (options.seeds < 2)
    throw InputError(fmt::format(
        "seeds is {}, expected at least 2: one does not tell how much an answer scatters", options.seeds));
}

Scene checked_scene(const SceneSpec& spec, const std::filesystem::path& file) {
  Scene scene = [&] {
    try {
      return build_scene(spec, file.parent_path());
    } catch (const InputError& error) {
      throw InputError(file.string() + ": " + error.what());
    }
  }();
  if (scene.projectors.empty() || scene.cameras.empty())
    throw InputError(fmt::format("{}: the scene has no [[{}]], expected at least one", file.string(),
                                 scene.projectors.empty() ? "projector" : "camera"));
  if (comes_from_files(spec.patterns.parameters.kind))
    throw InputError(file.string() +
                     ": [patterns]: pictures from files tell no pixel its place, expected coded patterns");
  return scene;
}

}  // namespace

Plan make_plan(const std::filesystem::path& scene_file, const std::filesystem::path& folder,
               const PlanOptions& options, const Progress& progress) {
  const StopSignals signals;  // also between the runs
  check_options(options);
  const std::string text = read_text(scene_file, std::size_t(16) << 20);
  const SceneSpec spec = parse_scene(text, scene_file.string(), options.set);
  const Scene scene = checked_scene(spec, scene_file);
  const std::filesystem::path scene_folder = scene_file.parent_path();
  const std::vector<Choice> choices = choices_of(spec, scene, scene_folder);
  std::vector<std::filesystem::path> files = files_of(spec, scene_folder);
  files.insert(files.begin(), scene_file);
  const RunnerOptions runner{
      .folder = folder,
      .fingerprint = fmt::format("plan, set {} seed {} seeds {} tolerance {}", fmt::join(options.set, "|"),
                                 options.seed, options.seeds, options.tolerance_px),
      .files = file_digests(files, scene_folder),
      .resume = options.resume,
      .parallel = false};
  PlanTrials trials(spec, scene_folder, choices, runner, options, progress);
  Plan plan;
  plan.tolerance_px = options.tolerance_px;
  Search search{choices, trials, plan, {false, options.seeds}, {}, {}, {}};
  search.tried.resize(choices.size()), search.levels.assign(choices.size(), 0);
  try {
    find_low_cost(search, scene);
    one_by_one(search);
    jointly(search);
    confirm(search, options);
    report_choices(search, spec);
    plan.interrupted = StopSignals::asked();
  } catch (const PlanInterrupted&) {
    plan.interrupted = true;
  }
  return plan;
}

}  // namespace laterna
