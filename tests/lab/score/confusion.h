// Who is named for what: mistakes planted in results of random rigs, against the first suspect of a score.
#pragma once

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace laterna::testing {

/// One mistake in one file, and what was said of it.
struct Verdict {
  std::string planted, how, format;  ///< "right", "noisy" and "generally wrong" are planted as well
  std::vector<std::string> named;    ///< most likely first
  double error_px = 0, bound_px = 0;
  bool shows = true;  ///< whether the mistake moves the projector by more than noise does
};

/// Plants every mistake once in each of `rigs` random rigs, each written as one of the formats that hold it
/// and read back, beside right and merely noisy results.
std::vector<Verdict> planted_verdicts(int rigs, std::uint64_t seed);

/// Of the mistakes that show, the share that is named first (of two mistakes: both in front); by name, pairs
/// as "two mistakes".
std::map<std::string, double> named_rates(const std::vector<Verdict>& verdicts);

/// How many right results, noisy ones up to three times the bound, and those that a gamma did no harm to have
/// anybody named.
int falsely_named(const std::vector<Verdict>& verdicts);

/// Planted (and how) × first named, as a table for people.
void print_confusion(const std::vector<Verdict>& verdicts, std::ostream& out);

}  // namespace laterna::testing
