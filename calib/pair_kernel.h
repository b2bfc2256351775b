// The hot loops of binary codes: pattern and inverse to bits, bits to stripes, stripes to verdicts. Compiled
// for several instruction sets, with the same bits from all.
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

/// For each of `count` pixels: stripe = binary_from_gray(w ^ (bit `base` of w ? mask : 0)) on 16 bits, with
/// the word w = high·2^low_bits | low, low_bits ≤ 8.
void stripes_of_words(std::uint16_t mask, int base, int low_bits, const std::uint8_t* high,
                      const std::uint8_t* low, std::size_t count, std::uint16_t* stripe);

/// What a pixel's code must hold to count; thresholds in the pictures' own DN.
struct PairLimits {
  float white_minus_black, pair_difference, pair_fraction;
  int columns, rows;  ///< stripes of each axis
};

/// For each of `count` pixels: valid = 1 where white - black > white_minus_black, weakest ≥ pair_difference
/// and ≥ pair_fraction·(white - black), column < columns and row < rows; else 0.
void judge_pairs(const std::uint8_t* white, const std::uint8_t* black, const std::uint8_t* weakest,
                 const std::uint16_t* column, const std::uint16_t* row, const PairLimits& limits,
                 std::size_t count, std::uint8_t* valid);
void judge_pairs(const std::uint16_t* white, const std::uint16_t* black, const std::uint16_t* weakest,
                 const std::uint16_t* column, const std::uint16_t* row, const PairLimits& limits,
                 std::size_t count, std::uint8_t* valid);

}  // namespace laterna
