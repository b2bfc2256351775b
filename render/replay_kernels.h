// The hot loops of replay, over blocks of 64 pixels. Each is compiled for several instruction sets, with the
// same bits from all.
#pragma once

#include <cstddef>
#include <cstdint>

namespace laterna {

/// How many pixels of an image row are played together: one cache line of each 8-bit picture.
inline constexpr int block_pixels = 64;

/// Gathers value = upper + below·(lower - upper), upper = a + right·(c - a), lower = d + right·(e - d), from
/// four texels with all patterns side by side.
struct BilinearTap {
  const std::uint8_t *a, *c, *d, *e;
  float right, below, gain;
};

/// Gathers one texel.
struct NearestTap {
  const std::uint8_t* texel;
  float gain;
};

/// Gathers one texel through a table of light: light[texel] + added[k], shares of the white picture's light.
struct TableTap {
  const std::uint8_t* texel;
  const float *light, *added;  ///< 256 values; one per pattern
  float gain;
};

/// Gathers bit k of a code for pattern k.
struct BitTap {
  std::uint64_t code;
  float gain;
};

/// levels[k·64 + i] = base[i] + Σ gain·value_k over the taps first[i] to first[i + 1] - 1 of pixel i, in that
/// order, for `pixels` ≤ 64 pixels and all patterns k < count. `scratch` holds 64·padded(count) floats.
void sum_taps(const BilinearTap* taps, const std::uint32_t* first, const float* base, int pixels, int count,
              float* scratch, float* levels);
void sum_taps(const NearestTap* taps, const std::uint32_t* first, const float* base, int pixels, int count,
              float* scratch, float* levels);
void sum_taps(const TableTap* taps, const std::uint32_t* first, const float* base, int pixels, int count,
              float* scratch, float* levels);
void sum_taps(const BitTap* taps, const std::uint32_t* first, const float* base, int pixels, int count,
              float* scratch, float* levels);
constexpr int padded(int count) { return (count + 15) / 16 * 16; }

/// One entry of light for each pixel of a whole block (LightEntry: u_px, v_px, weight and 8 bytes more).
struct BlockEntries {
  const double* first;
  double scale;  ///< gain = single precision of scale·weight
};

/// Codes of a width×height picture: column_codes[x] | row_codes[y].
struct CodePicture {
  int width, height;
  const std::uint64_t *column_codes, *row_codes;
};

/// codes[i]: that of the texel whose box holds entry i (nearest_texel); white[i] += 255·gain. 64 each.
void nearest_codes(const BlockEntries& entries, const CodePicture& picture, std::uint64_t* codes,
                   float* white);

/// Pictures of equal size, one after the other: picture k's pixel is at first[k·stride].
template <class Number>
struct Planes {
  Number* first;
  std::size_t stride;
};

/// Picture k's pixel i is on[i] where bit k of codes[i] is set, else off[i]. All arrays hold 64.
void expand_bits(const std::uint64_t* codes, const std::uint8_t* off, const std::uint8_t* on, int pixels,
                 int count, Planes<std::uint8_t> out);
void expand_bits(const std::uint64_t* codes, const std::uint16_t* off, const std::uint16_t* on, int pixels,
                 int count, Planes<std::uint16_t> out);

/// Copies rows of bytes, `count` of them, past the cache where the machine can: from + k·from_stride to
/// to + k·to_stride.
void stream_rows(const std::byte* from, std::size_t from_stride, std::size_t bytes, int count, std::byte* to,
                 std::size_t to_stride);

/// Makes what this thread has streamed visible to others; once, after the last stream_rows: until then the
/// stores drain while the next row is made.
void finish_streams();

}  // namespace laterna
