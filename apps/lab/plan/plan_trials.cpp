#include "apps/lab/plan/plan_trials.h"

#include "apps/lab/cell_seed.h"
#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace laterna {

namespace {

using Json = nlohmann::json;

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n == 0 ? NAN : (values[(n - 1) / 2] + values[n / 2]) / 2;
}

double median_seconds(const std::vector<RoundTrip>& trips) {
  std::vector<double> seconds;
  for (const RoundTrip& trip : trips)
    if (std::isfinite(trip.seconds)) seconds.push_back(trip.seconds);
  return median(std::move(seconds));
}

}  // namespace

PlanTrials::PlanTrials(const SceneSpec& spec, const std::filesystem::path& scene_folder,
                       const std::vector<Choice>& choices, RunnerOptions runner, const PlanOptions& options,
                       const Progress& progress)
    : spec_(spec),
      folder_(scene_folder),
      choices_(choices),
      runner_(std::move(runner)),
      options_(options),
      progress_(progress),
      volumes_(volumes_of(spec, scene_folder)) {}

std::uint64_t PlanTrials::seed_of(const PlanSeeds& seeds, int k) const {
  return cell_seed(seeds.confirm ? "plan, confirmed" : "plan", options_.seed, k);
}

std::string PlanTrials::id(const Model& model, const PlanSeeds& seeds, int k) const {
  return fmt::format("{}{}, cameras halved {} times, seed {}", seeds.confirm ? "full and " : "",
                     levels_text(choices_, model.levels), model.halvings, k);
}

Json PlanTrials::simulate(const Model& model, std::uint64_t seed) const {
  const SceneSpec spec =
      with_cameras_halved(at_levels(spec_, choices_, model.levels), model.halvings, folder_);
  return round_trip_json(round_trip(spec, folder_, seed));
}

Job PlanTrials::job(const Model& model, const PlanSeeds& seeds, int k) const {
  return {id(model, seeds, k), [this, model, seed = seed_of(seeds, k)] { return simulate(model, seed); }};
}

Job PlanTrials::pair_job(const Model& model, const PlanSeeds& seeds, int k) const {
  return {id(model, seeds, k), [this, model, seed = seed_of(seeds, k)] {
            const Model full{Levels(choices_.size(), 0), model.halvings};
            return Json{{"full", simulate(full, seed)}, {"other", simulate(model, seed)}};
          }};
}

void PlanTrials::run(const std::vector<Job>& jobs, const std::string& what) {
  std::vector<Job> open;
  std::set<std::string> ids;
  for (const Job& job : jobs)
    if (!results_.contains(job.id) && ids.insert(job.id).second) open.push_back(job);
  if (StopSignals::asked()) throw PlanInterrupted{};
  if (open.empty()) return;
  runner_.noun = "round trips, " + what;
  const RunOutcome run = run_jobs(open, runner_, progress_);
  runner_.resume = true;  // what follows goes on with the same journal
  if (run.interrupted) throw PlanInterrupted{};
  for (std::size_t k = 0; k < open.size(); ++k) {
    if (!run.jobs[k].crashed.empty())
      throw std::runtime_error(fmt::format("{}: {}", open[k].id, run.jobs[k].crashed));
    results_[open[k].id] = run.jobs[k].result;
  }
}

std::vector<RoundTrip> PlanTrials::full(int halvings, const PlanSeeds& seeds) {
  const Model model{Levels(choices_.size(), 0), halvings};
  measure({model}, seeds, "the full model");
  std::vector<RoundTrip> trips;
  for (int k = 0; k < seeds.count; ++k) trips.push_back(round_trip_from(results_.at(id(model, seeds, k))));
  return trips;
}

void PlanTrials::measure(const std::vector<Model>& models, const PlanSeeds& seeds, const std::string& what) {
  std::vector<Job> jobs;
  for (const Model& model : models)
    for (int k = 0; k < seeds.count; ++k)
      jobs.push_back(seeds.confirm ? pair_job(model, seeds, k) : job(model, seeds, k));
  run(jobs, what);
}

Compared PlanTrials::compared(const Model& model, const PlanSeeds& seeds) {
  std::vector<RoundTrip> full, other;
  for (int k = 0; k < seeds.count; ++k) {
    const Json& result = results_.at(id(model, seeds, k));
    other.push_back(round_trip_from(seeds.confirm ? result.at("other") : result));
    const Model base{Levels(choices_.size(), 0), model.halvings};
    full.push_back(round_trip_from(seeds.confirm ? result.at("full") : results_.at(id(base, seeds, k))));
  }
  const Change change = change_between(volumes_, full, other);
  return {change, median_seconds(full), median_seconds(other), seeds.count,
          verdict_on(change, options_.tolerance_px)};
}

std::vector<Compared> PlanTrials::compare(const std::vector<Levels>& levels, int halvings, PlanSeeds seeds,
                                          const std::string& what) {
  std::vector<Compared> all(levels.size());
  std::vector<std::size_t> open;
  for (std::size_t m = 0; m < levels.size(); ++m) open.push_back(m);
  for (int round = 0; round < 2 && !open.empty(); ++round, seeds.count *= 4) {
    std::vector<Model> models;
    if (!seeds.confirm) models.push_back({Levels(choices_.size(), 0), halvings});
    for (const std::size_t m : open) models.push_back({levels[m], halvings});
    measure(models, seeds, what);
    for (const std::size_t m : open) all[m] = compared({levels[m], halvings}, seeds);
    std::erase_if(open, [&](std::size_t m) { return all[m].verdict != Verdict::unsure; });
  }
  return all;
}

}  // namespace laterna
