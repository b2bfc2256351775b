// Per-pixel results, left uninitialised so that the thread that computes a row is the first to touch its
// memory.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace laterna {

/// An allocator that leaves numbers uninitialised where a vector is made with a size alone.
template <class T>
struct UninitialisedAllocator : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = UninitialisedAllocator<U>;
  };
  template <class U, class... Arguments>
  void construct(U* where, Arguments&&... arguments) {
    if constexpr (sizeof...(Arguments) == 0) {
      ::new (static_cast<void*>(where)) U;
    } else {
      ::new (static_cast<void*>(where)) U(std::forward<Arguments>(arguments)...);
    }
  }
};

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

}  // namespace laterna
