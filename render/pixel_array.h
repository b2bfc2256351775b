// Per-pixel results, left uninitialised so that the thread that computes a row is the first to touch its
// memory.
#pragma once

#include "sim/uninitialised.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

namespace laterna {

/// As Image, row by row from the top; whoever makes one writes every pixel.
template <class T>
struct PixelArray {
  int width = 0, height = 0;
  std::vector<T, UninitialisedAllocator<T>> values;

  PixelArray() = default;
  PixelArray(int width_px, int height_px)
      : width(width_px), height(height_px), values(std::size_t(width_px) * height_px) {}
  std::size_t index(int x, int y) const { return std::size_t(y) * width + x; }
  T& operator()(int x, int y) { return values[index(x, y)]; }
  const T& operator()(int x, int y) const { return values[index(x, y)]; }
};

/// Copies `count` ≤ 4 values, a row of a tile.
template <class T>
void copy_row(const T* from, int count, T* to) {
  if (count == 4) {
    std::memcpy(to, from, 4 * sizeof(T));
  } else {
    std::copy_n(from, count, to);
  }
}

/// A rectangle of a camera's image, in pixels. `x` and `y` are multiples of 4, so that the tiles of rays that
/// travel together are those of the whole image.
struct PixelRegion {
  int x = 0, y = 0, width = 0, height = 0;

  std::size_t size() const { return std::size_t(width) * height; }
};

}  // namespace laterna
