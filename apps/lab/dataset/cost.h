// What a data set costs: processor seconds and bytes, from what its runs took.
#pragma once

#include "apps/lab/dataset/dataset_folder.h"

#include <cstdint>
#include <vector>

namespace laterna {

/// Of one run of one shard, or of several together.
struct RunCost {
  std::uint64_t samples = 0;
  double cpu_s = 0, wall_s = 0;
  int threads = 0;  ///< of each of them; 0 where they differ
};

/// Starts to count at its making.
class CostClock {
 public:
  CostClock();
  /// Since then; processor time of all threads, user and system.
  RunCost cost(std::uint64_t samples) const;

 private:
  double cpu_s_, wall_s_;
};

/// Adds a line to the run's cost.jsonl.
void keep_cost(const std::filesystem::path& run_folder, const RunCost& cost);

/// What all runs of all shards that ended took, one sum for each number of threads, fewest threads first;
/// what a killed run took is not known.
std::vector<RunCost> costs_by_threads(const DatasetFolder& folder);

RunCost sum_of(const std::vector<RunCost>& costs);

}  // namespace laterna
