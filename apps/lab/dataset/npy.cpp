#include "apps/lab/dataset/npy.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>

namespace laterna {

std::string npy_bytes(std::span<const float> values, const std::vector<std::size_t>& shape) {
  static_assert(std::endian::native == std::endian::little);
  constexpr std::size_t before_header = 10, alignment = 64;
  std::string header =
      fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}), }}", fmt::join(shape, ", "));
  const std::size_t unpadded = before_header + header.size() + 1;
  header += std::string((alignment - unpadded % alignment) % alignment, ' ') + "\n";
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += char(header.size() & 0xff);
  bytes += char(header.size() >> 8);
  bytes += header;
  return bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

}  // namespace laterna
