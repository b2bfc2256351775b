#include "apps/lab/cell_seed.h"

#include <array>
#include <random>

namespace laterna {

std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = 14695981039346656037U;
  for (const char c : text) hash = (hash ^ std::uint8_t(c)) * 1099511628211U;
  return hash;
}

std::uint64_t cell_seed(std::string_view name, std::uint64_t seed, int k) {
  const std::uint64_t hash = hash_of(name);
  std::seed_seq sequence{std::uint32_t(hash), std::uint32_t(hash >> 32), std::uint32_t(seed),
                         std::uint32_t(seed >> 32), std::uint32_t(k)};
  std::array<std::uint32_t, 2> words{};
  sequence.generate(words.begin(), words.end());
  return std::uint64_t(words[0]) << 32 | words[1];
}

}  // namespace laterna
