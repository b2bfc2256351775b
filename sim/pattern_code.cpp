// The binary part of pattern families: words shown bit by bit, each as pattern and inverse.
#include "sim/pattern_sequence.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace laterna {

namespace {

int stripe_of(const WordCode& code, int x) { return int(std::floor((x + 0.5) / code.stripe_px)); }

std::uint32_t word_of(const WordCode& code, int x) {
  const std::uint32_t gray = gray_from_binary(std::uint32_t(stripe_of(code, x)));
  return gray >> code.base & 1u ? gray ^ code.mask : gray;
}

}  // namespace

WordCode word_code(const PatternSequence& sequence, int axis) {
  const PatternParameters& p = sequence.parameters;
  const int size = sequence.projector_size[axis];
  if (p.kind == PatternKind::gray_phase) {
    WordCode code{.bits = 0, .base = 0, .mask = 0, .stripes = 0, .stripe_px = p.pitch_px / 2};
    code.stripes = stripe_of(code, size - 1) + 1;
    code.bits = gray_bits(code.stripes);
    return code;
  }
  WordCode code{.bits = gray_bits(size), .base = 0, .mask = 0, .stripes = size, .stripe_px = 1};
  if (p.kind != PatternKind::xor_gray) return code;
  // Bit b of a Gray code has stripes of 2^(b+1) pixels. A word too short for the base has its widest.
  code.base = std::max(0, std::min(int(std::bit_width(std::uint32_t(p.xor_stripe_px))) - 2, code.bits - 1));
  code.mask = ((1u << code.bits) - 1) & ~(1u << code.base);
  return code;
}

std::uint32_t code_word(const PatternSequence& sequence, int axis, int x) {
  return word_of(word_code(sequence, axis), x);
}

}  // namespace laterna
