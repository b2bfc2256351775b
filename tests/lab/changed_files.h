// Runs that are to be resumed after a file has changed.
#pragma once

#include "sim/text_file.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <string>
#include <vector>

namespace laterna::testing {

/// FOLDER/s.toml, a small camera and projector before FOLDER/roof.obj: two slopes, so that it calibrates.
inline std::filesystem::path write_roof_scene(const std::filesystem::path& folder) {
  write_text(folder / "roof.obj",
             "v -2 -2 0\nv 0 -2 0.8\nv 2 -2 0\nv -2 2 0\nv 0 2 0.8\nv 2 2 0\n"
             "f 1 2 5\nf 1 5 4\nf 2 3 6\nf 2 6 5\n");
  return write_text(folder / "s.toml", R"(
[[mesh]]
file = "roof.obj"
[[projector]]
size = [128, 80]
throw_ratio = 1
position = [0.3, 0, 2.5]
look_at = [0, 0, 0.4]
up = [0, 1, 0]
[[camera]]
size = [160, 100]
fov_x_deg = 50
position = [-0.3, 0, 2.5]
look_at = [0, 0, 0.4]
up = [0, 1, 0]
)");
}

/// Appends a space to each of the files in turn: `resume` then throws one sentence that names it. With all as
/// they were, it goes on.
template <class Resume>
void expect_each_change_refused(const std::vector<std::filesystem::path>& files, const Resume& resume) {
  for (const std::filesystem::path& file : files) {
    const std::string text = read_text(file, 1 << 20);
    write_text(file, text + " ");
    EXPECT_THAT(input_error(resume), ::testing::StartsWith(file.string() + ": has changed since "));
    write_text(file, text);
  }
  EXPECT_NO_THROW(resume());
}

}  // namespace laterna::testing
