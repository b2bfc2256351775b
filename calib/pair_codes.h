// The pairs of an axis to stripes, for the decoders of binary codes.
#pragma once

#include "sim/image_view.h"
#include "sim/pattern_sequence.h"

#include <cstdint>
#include <vector>

namespace laterna {

/// Pictures of one axis, as pointers to their pixels.
template <class T>
struct PairPictures {
  std::vector<const T*> pattern, inverse;  ///< the most significant bit first
  WordCode code;

  PairPictures(const ImageStackView<T>& stack, const PatternSequence& sequence, int axis);

  /// For `count` pixels from `begin` on: stripe = what their word means (it may be ≥ code.stripes), weakest =
  /// the least of what it held and every |pattern - inverse|.
  void read(std::size_t begin, std::size_t count, std::uint16_t* stripe, T* weakest) const;
};

}  // namespace laterna
