#include "apps/lab/dataset/npy.h"

#include "sim/error.h"
#include "sim/safe_write.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <functional>
#include <numeric>

namespace laterna {

std::string npy_header(const std::vector<std::size_t>& shape) {
  constexpr std::size_t before_header = 10, alignment = 64;
  std::string header = fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}{}), }}",
                                   fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
  const std::size_t unpadded = before_header + header.size() + 1;
  header += std::string((alignment - unpadded % alignment) % alignment, ' ') + "\n";
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += char(header.size() & 0xff);
  bytes += char(header.size() >> 8);
  bytes += header;
  return bytes;
}

void write_npy(const std::filesystem::path& path, std::span<const float> values,
               const std::vector<std::size_t>& shape) {
  static_assert(std::endian::native == std::endian::little);
  const std::size_t expected =
      std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
  if (values.size() != expected)
    throw InputError(fmt::format("{}: {} numbers for an array of {}, expected {}", path.string(),
                                 values.size(), fmt::join(shape, " × "), expected));
  write_file(path, {npy_header(shape), {reinterpret_cast<const char*>(values.data()), values.size_bytes()}});
}

}  // namespace laterna
