// Tables of numbers as NumPy reads them.
#pragma once

#include <span>
#include <string>

namespace laterna {

/// The bytes of a .npy file (format 1.0): little-endian single precision, rows × columns, row by row.
/// numpy.load() gives it back.
std::string npy_bytes(std::span<const float> values, std::size_t columns);

}  // namespace laterna
