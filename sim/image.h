// Pictures in memory: planar, row by row from the top, integer coordinates at pixel centres.
#pragma once

#include "sim/uninitialised.h"

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace laterna {

/// One channel. Pixel (x, y) stands at values[y·width + x].
template <class T>
struct Image {
  int width = 0, height = 0;
  std::vector<T> values;

  Image() = default;
  Image(int width_px, int height_px, T fill = T{})
      : width(width_px), height(height_px), values(std::size_t(width_px) * height_px, fill) {}
  T& operator()(int x, int y) { return values[std::size_t(y) * width + x]; }
  const T& operator()(int x, int y) const { return values[std::size_t(y) * width + x]; }
};

/// A stack of equally large one-channel pictures, one after the other in memory; whoever makes one writes
/// every pixel.
template <class T>
struct ImageStack {
  using value_type = T;
  int width = 0, height = 0, count = 0;
  std::vector<T, UninitialisedAllocator<T>> values;

  ImageStack() = default;
  ImageStack(int width_px, int height_px, int pictures)
      : width(width_px),
        height(height_px),
        count(pictures),
        values(std::size_t(width_px) * height_px * pictures) {}
  std::size_t picture_size() const { return std::size_t(width) * height; }
  std::span<T> picture(int k) { return {values.data() + k * picture_size(), picture_size()}; }
  std::span<const T> picture(int k) const { return {values.data() + k * picture_size(), picture_size()}; }
};

/// What a camera delivers: digital numbers (DN) of 8 bits, or of 9 to 16.
using CapturedStack = std::variant<ImageStack<std::uint8_t>, ImageStack<std::uint16_t>>;

}  // namespace laterna
