// Random numbers by counting: each is a function of where it is used, never of what was drawn before it.
#pragma once

#include <cstdint>
#include <string_view>

namespace laterna {

/// Numbers of one name in one attempt at one sample, under a data set's seed: the words of Threefry-4×64-20
/// with key (seed, hash_of(name), 0, 0) and counter (sample, attempt, n, 0), n = 0, 1, 2, .... So they are
/// the same whatever the shard, thread or order, and a name's do not change with the other names.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t sample, std::uint64_t attempt, std::string_view name);
  std::uint64_t bits();
  double unit();                             ///< in [0, 1), 53 bits
  double normal();                           ///< standard deviation 1; Box and Muller
  std::uint64_t below(std::uint64_t count);  ///< 0 to count - 1; biased by less than count/2⁶⁴

 private:
  std::uint64_t seed_, name_, sample_, attempt_, n_ = 0;
};

}  // namespace laterna
