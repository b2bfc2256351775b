// Stacks of pictures that somebody else holds: read in place, whoever made them.
#pragma once

#include "sim/image.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>

namespace laterna {

/// Equally large one-channel pictures, one after the other in memory, as ImageStack: pixel (x, y) of picture
/// k stands at data[(k·height + y)·width + x]. The memory must outlive the view.
template <class T>
struct ImageStackView {
  using value_type = T;
  int width = 0, height = 0, count = 0;
  const T* data = nullptr;

  ImageStackView(int width_px, int height_px, int pictures, const T* values)
      : width(width_px), height(height_px), count(pictures), data(values) {}
  ImageStackView(const ImageStack<T>& stack)
      : ImageStackView(stack.width, stack.height, stack.count, stack.values.data()) {}
  std::size_t picture_size() const { return std::size_t(width) * height; }
  std::span<const T> picture(int k) const { return {data + k * picture_size(), picture_size()}; }
};

/// What a camera delivered, digital numbers of 8 bits, or of 9 to 16, in anyone's memory.
struct CapturedView : std::variant<ImageStackView<std::uint8_t>, ImageStackView<std::uint16_t>> {
  using variant::variant;
  template <class T>
  CapturedView(const ImageStack<T>& stack) : variant(ImageStackView<T>(stack)) {}
  CapturedView(const CapturedStack& stack)
      : CapturedView(std::visit([](const auto& pictures) { return CapturedView(pictures); }, stack)) {}
};

}  // namespace laterna
