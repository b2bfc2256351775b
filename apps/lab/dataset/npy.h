// Tables of numbers as NumPy reads them.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace laterna {

/// The bytes of a .npy file (format 1.0): little-endian single precision, of a shape whose product is the
/// number of values, the last index running fastest. numpy.load() gives it back.
std::string npy_bytes(std::span<const float> values, const std::vector<std::size_t>& shape);

}  // namespace laterna
