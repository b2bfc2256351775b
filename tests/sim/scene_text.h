// Texts of scenes, and what is said of wrong ones, for the tests of what reads them.
#pragma once

#include "sim/scene_file.h"
#include "tests/testing.h"

#include <string>

namespace laterna::testing {

inline const std::string mesh_line = "[[mesh]]\nshape = \"plane\"\n";
inline const std::string device_lines =
    "size = [640, 480]\nfx = 500\nposition = [0, 0, 2]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\n";

inline std::string with_mesh(const std::string& lines) { return mesh_line + lines; }
inline std::string with_device(const std::string& lines) { return mesh_line + "[[camera]]\n" + lines; }
inline std::string error_of(const std::string& text) {
  return input_error([&] { parse_scene(text, "scene.toml"); });
}

/// The text with `from`, which must be there, replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

}  // namespace laterna::testing
