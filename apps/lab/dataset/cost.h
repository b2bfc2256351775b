// What a data set costs: processor seconds and bytes, from what its runs took.
#pragma once

#include "apps/lab/dataset/dataset_folder.h"

#include <cstdint>

namespace laterna {

/// Of one run of one shard, or of several together.
struct RunCost {
  std::uint64_t samples = 0;
  double cpu_s = 0, wall_s = 0;
  int threads = 0;  ///< of one run; of several, those of the last
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

/// The sum over all runs of all shards that ended; what a killed run took is not known.
RunCost all_costs(const DatasetFolder& folder);

}  // namespace laterna
