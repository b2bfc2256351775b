// Displacement from the scene file to everything that sees the surface.
#include "apps/lab/preview.h"
#include "apps/lab/truth_picture.h"
#include "sim/image_file.h"
#include "sim/scene_file.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace laterna {
namespace {

const std::string facing = R"(
[[projector]]
size = [64, 48]
fx = 60
position = [0.2, 0, 2]
look_at = [0.2, 0, 0]
up = [0, 1, 0]
[[camera]]
size = [40, 30]
fx = 60
position = [0, 0, 2]
look_at = [0, 0, 0]
up = [0, 1, 0]
[[mesh]]
shape = "plane"
shape_size = [4, 4, 1]
detail = 1
displacement_map = "heights.exr"
displacement = 0.5
)";

TEST(LabDisplacement, TheTruthIsThatOfTheDisplacedSurface) {
  const testing::ScratchFolder folder;
  write_picture(folder / "heights.exr", Image<float>(16, 8, 0.5f));
  StageTimes times;
  for (const bool on : {false, true}) {
    const std::string effects = on ? "[effects]\ndisplacement = true\n" : "";
    const Scene scene = load_scene(testing::write_text(folder / "s.toml", facing + effects));
    const Traced traced = trace(scene, times);
    const double depth_m = on ? 1.75 : 2;
    for (const double found : traced.surfaces[0].depth_m.values)
      EXPECT_NEAR(found, depth_m, 1e-14);  // a few roundings of a double
    write_truth(folder / "truth.exr", scene, traced, 0, 0);
    const ExrLayers truth = read_exr_layers(folder / "truth.exr");
    const auto depth = std::find(truth.names.begin(), truth.names.end(), "depth.m") - truth.names.begin();
    EXPECT_THAT(truth.planes.at(depth).values, ::testing::Each(float(depth_m)));
    EXPECT_GT(preview_picture(scene, traced).width, 0);  // shades the refined mesh's triangles
    const CapturedStack stack = capture_view(scene, traced, traced.views[0], 1, times);
    EXPECT_EQ(std::get<ImageStack<std::uint8_t>>(stack).count, 26);
  }
}

}  // namespace
}  // namespace laterna
