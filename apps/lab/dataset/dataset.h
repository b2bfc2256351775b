// Data sets: many samples of one specification, made by any number of shards and threads.
#pragma once

#include "apps/lab/dataset/data_card.h"
#include "apps/lab/simulation.h"

#include <cstdint>
#include <filesystem>

namespace laterna {

struct DatasetOptions {
  std::uint64_t count = 0, seed = 1;
  int shard = 0, shards = 1;  ///< this run makes the samples k with k mod shards = shard
  bool resume = false;        ///< go on where a run of the same words stopped; begins where there was none
  bool merge = false;         ///< make no sample: only complete the set from what all shards made
};

struct DatasetOutcome {
  std::uint64_t made = 0;    ///< samples that this run made
  bool interrupted = false;  ///< by SIGINT or SIGTERM
  bool whole = false;        ///< all samples of all shards are there: checksums.txt and card.md are written
  RunCost cost{};            ///< of this run
  RunCost all_cost{};        ///< of all runs, where whole
  DatasetTotals totals{};    ///< where whole
};

/// Makes a data set in `folder` (dataset_folder.h). Shards may share the folder, at once or one after the
/// other, and K may change when they go on: whichever ends last, or `merge`, completes it. A run that is
/// killed at any moment is gone on with by `resume`; nothing whole is made twice, nothing partial bears a
/// final name. checksums.txt is the same bytes for any shards, threads and order on one instruction set.
///
/// Throws InputError for a specification that is not sound (nothing is written then), a folder that holds
/// another set or this shard's run already, a set of which parts are missing to merge, and where something
/// cannot be written; what is whole stays, and can be gone on with.
DatasetOutcome make_dataset(const std::filesystem::path& specification, const std::filesystem::path& folder,
                            const DatasetOptions& options, const Progress& progress = {});

}  // namespace laterna
