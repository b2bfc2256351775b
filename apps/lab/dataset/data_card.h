// The data card: what a data set is, for people.
#pragma once

#include "apps/lab/dataset/cost.h"
#include "apps/lab/dataset/dataset_spec.h"

#include <cstdint>
#include <map>
#include <string>

namespace laterna {

/// Sums over the samples of a whole set.
struct DatasetTotals {
  std::uint64_t samples = 0, bytes = 0, files = 0;
  std::map<std::string, std::uint64_t> rejected;  ///< attempts, by reason
};

/// Markdown: description, licence, counts, distributions, rejections by reason, what a sample holds, how to
/// read and check it, what it cost, by the number of threads, and what a million samples would.
std::string data_card(const DatasetSpec& spec, std::uint64_t seed, const DatasetTotals& totals,
                      const std::vector<RunCost>& costs_by_threads);

/// "a million samples: 93 CPU-hours, 7.7 TB"; empty where no cost is known.
std::string million_text(const DatasetTotals& totals, const RunCost& cost);

}  // namespace laterna
