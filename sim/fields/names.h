// What a scene file calls the values of each enumeration.
#pragma once

#include "sim/scene_spec.h"

namespace laterna {

inline std::span<const char* const> names_of(UpAxis) {
  static constexpr const char* names[] = {"y", "z"};
  return names;
}
inline std::span<const char* const> names_of(Encoding) {
  static constexpr const char* names[] = {"linear", "srgb"};
  return names;
}
inline std::span<const char* const> names_of(Lookup) {
  static constexpr const char* names[] = {"nearest", "bilinear"};
  return names;
}
inline std::span<const char* const> names_of(Border) {
  static constexpr const char* names[] = {"black", "clamp"};
  return names;
}
inline std::span<const char* const> names_of(SensorKind) {
  static constexpr const char* names[] = {"ideal", "emva1288"};
  return names;
}
inline std::span<const char* const> names_of(PatternKind) {
  static constexpr const char* names[] = {
      "gray",        "slide",    "gray_phase", "phase",   "multi_frequency",
      "micro_phase", "xor_gray", "chessboard", "charuco", "pictures"};
  return names;
}
inline std::span<const char* const> names_of(VignettingModel) {
  static constexpr const char* names[] = {"none", "cos4", "polynomial", "map"};
  return names;
}
inline std::span<const char* const> names_of(GlossModel) {
  static constexpr const char* names[] = {"none", "phong", "ggx"};
  return names;
}
inline std::span<const char* const> names_of(SolidKind) {
  static constexpr const char* names[] = {"none", "checker", "noise"};
  return names;
}
inline std::span<const char* const> names_of(ColourFilter) {
  static constexpr const char* names[] = {"mono", "bayer_rggb", "bayer_bggr", "bayer_grbg", "bayer_gbrg"};
  return names;
}

}  // namespace laterna
