// The round trips of a plan: run once, kept in the journal, compared.
#pragma once

#include "apps/lab/plan/plan.h"
#include "apps/lab/runner.h"

#include <map>

namespace laterna {

/// Thrown where the run was interrupted.
struct PlanInterrupted {};

/// Seeds that chose nothing are those of `confirm`.
struct PlanSeeds {
  bool confirm = false;
  int count = 3;
};

/// A comparison of a model with the full one.
struct Compared {
  Change change;
  double seconds_full = NAN, seconds = NAN;  ///< medians over the seeds
  int seeds = 0;
  Verdict verdict = Verdict::unsure;
};

class PlanTrials {
 public:
  /// All must outlive the object.
  PlanTrials(const SceneSpec& spec, const std::filesystem::path& scene_folder,
             const std::vector<Choice>& choices, RunnerOptions runner, const PlanOptions& options,
             const Progress& progress);

  /// The full model's round trips with the cameras' pixels halved.
  std::vector<RoundTrip> full(int halvings, const PlanSeeds& seeds);

  /// Models against the full one, at the same halvings; those on which the verdict is unsure again on four
  /// times the seeds. With seeds to confirm, full and other run in turn.
  std::vector<Compared> compare(const std::vector<Levels>& models, int halvings, PlanSeeds seeds,
                                const std::string& what);

 private:
  struct Model {
    Levels levels;
    int halvings;
  };
  std::string id(const Model& model, const PlanSeeds& seeds, int k) const;
  Job job(const Model& model, const PlanSeeds& seeds, int k) const;
  Job pair_job(const Model& model, const PlanSeeds& seeds, int k) const;
  nlohmann::json simulate(const Model& model, std::uint64_t seed) const;
  std::uint64_t seed_of(const PlanSeeds& seeds, int k) const;
  void run(const std::vector<Job>& jobs, const std::string& what);
  Compared compared(const Model& model, const PlanSeeds& seeds);
  void measure(const std::vector<Model>& models, const PlanSeeds& seeds, const std::string& what);

  const SceneSpec& spec_;
  const std::filesystem::path& folder_;
  const std::vector<Choice>& choices_;
  RunnerOptions runner_;
  const PlanOptions& options_;
  const Progress& progress_;
  std::map<std::string, nlohmann::json> results_;
  std::vector<std::vector<glm::dvec3>> volumes_;
};

}  // namespace laterna
