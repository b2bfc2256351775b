// A small data set for tests: tiny pictures, quick to make.
#pragma once

#include "tests/testing.h"

#include <string>

namespace laterna::testing {

inline const std::string tiny_scene = R"(
[[mesh]]
name = "floor"
shape = "plane"
shape_size = [2, 2, 1]
detail = 4
[[mesh]]
name = "thing"
[[projector]]
size = [64, 48]
position = [0, -0.6, 1]
look_at = [0, 0, 0]
[[camera]]
size = [48, 36]
position = [0.3, -0.4, 1]
sensor = { noise_sigma_dn = 1.0 }
[patterns]
kind = "gray"
)";

inline const std::string tiny_spec = R"(
name = "tiny"
description = "Tiny pictures."
scene = "scene.toml"
tar_samples = 2
correspondence_step_px = 2
[reject]
least_lit = 0.2
least_projector = 0.1
[present]
"mesh.1" = 0.8
[random]
"camera.fov_x_deg" = { uniform = [30, 60] }
"camera.look_at" = { uniform = [[-0.9, -0.1, 0], [0.9, 0.1, 0]] }
"projector.throw_ratio" = { log_uniform = [1, 2] }
"projector.flux_lm" = { normal = [100, 20, 50, 150] }
"mesh.1" = { choice = [
  { shape = "sphere", shape_size = [0.4, 0.4, 0.4], scale = { uniform = [0.5, 1] } },
  { shape = "box", shape_size = { uniform = [[0.1, 0.1, 0.1], [0.3, 0.3, 0.3]] } },
  { file = "wedge.ply" },
] }
"mesh.1.detail" = { whole = [4, 8] }
"patterns.kind" = { choice = ["gray", "xor_gray"] }
)";

inline const std::string wedge = R"(ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 2
property list uchar int vertex_indices
end_header
-0.3 -0.3 0.05
0.3 -0.3 0.05
0.3 0.3 0.3
-0.3 0.3 0.3
3 0 1 2
3 0 2 3
)";

/// FOLDER/spec.toml, scene.toml and wedge.ply.
inline std::filesystem::path write_tiny_spec(const std::filesystem::path& folder,
                                             const std::string& spec = tiny_spec) {
  write_text(folder / "scene.toml", tiny_scene);
  write_text(folder / "wedge.ply", wedge);
  return write_text(folder / "spec.toml", spec);
}

}  // namespace laterna::testing
