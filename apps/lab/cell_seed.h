// Seeds of trials that depend on a name alone, so that results do not change with what else a run holds.
#pragma once

#include <cstdint>
#include <string_view>

namespace laterna {

/// Fowler, Noll and Vo's 64-bit hash (FNV-1a): the same on every platform.
std::uint64_t hash_of(std::string_view text);

/// The k-th seed of what bears a name, under a run's seed: the same on every platform.
std::uint64_t cell_seed(std::string_view name, std::uint64_t run_seed, int k);

}  // namespace laterna
