// The hot loop of binary codes: pattern and inverse to bits. Compiled for several instruction sets, with the
// same bits from all.
#pragma once

#include <cstddef>
#include <cstdint>

namespace laterna {

/// For each of `count` pixels: codes = the bits (pattern > inverse) of up to 8 pairs, the first most
/// significant; weakest = the least of what it held and |pattern - inverse|.
void read_pairs(const std::uint8_t* const* pattern, const std::uint8_t* const* inverse, int pairs,
                std::size_t count, std::uint8_t* codes, std::uint8_t* weakest);
void read_pairs(const std::uint16_t* const* pattern, const std::uint16_t* const* inverse, int pairs,
                std::size_t count, std::uint8_t* codes, std::uint16_t* weakest);

}  // namespace laterna
