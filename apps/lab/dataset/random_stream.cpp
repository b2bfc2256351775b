#include "apps/lab/dataset/random_stream.h"

#include "apps/lab/cell_seed.h"

#include <Random123/threefry.h>

#include <cmath>
#include <numbers>

namespace laterna {

RandomStream::RandomStream(std::uint64_t seed, std::uint64_t sample, std::uint64_t attempt,
                           std::string_view name)
    : seed_(seed), name_(hash_of(name)), sample_(sample), attempt_(attempt) {}

std::uint64_t RandomStream::bits() {
  using Threefry = r123::Threefry4x64;
  return Threefry()(Threefry::ctr_type{{sample_, attempt_, n_++, 0}},
                    Threefry::key_type{{seed_, name_, 0, 0}})[0];
}

double RandomStream::unit() { return double(bits() >> 11) * 0x1p-53; }

double RandomStream::normal() {
  const double radius = std::sqrt(-2 * std::log(1 - unit()));  // 1 - unit() is never 0
  return radius * std::cos(2 * std::numbers::pi * unit());
}

std::uint64_t RandomStream::below(std::uint64_t count) {
  return std::uint64_t((static_cast<unsigned __int128>(bits()) * count) >> 64);
}

}  // namespace laterna
