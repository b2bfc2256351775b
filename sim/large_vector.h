// Vectors of very many numbers.
#pragma once

#include "sim/uninitialised.h"

#include <vector>

namespace laterna {

/// A vector that leaves numbers uninitialised when it is made or resized with a size alone, whose memory is
/// first touched by the thread that computes, in huge pages where it is large: whoever makes one writes every
/// number.
template <class T>
using LargeVector = std::vector<T, UninitialisedAllocator<T>>;

}  // namespace laterna
