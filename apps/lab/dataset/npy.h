// Tables of numbers as NumPy reads them.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace laterna {

/// What stands before the numbers in a .npy file (format 1.0): little-endian single precision, of a shape
/// whose last index runs fastest. Its length is a multiple of 64.
std::string npy_header(const std::vector<std::size_t>& shape);

/// Leaves a .npy file that numpy.load() reads, as write_file() does. Throws InputError where the shape's
/// product is not the number of values.
void write_npy(const std::filesystem::path& path, std::span<const float> values,
               const std::vector<std::size_t>& shape);

}  // namespace laterna
