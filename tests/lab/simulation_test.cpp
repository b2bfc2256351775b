#include "apps/lab/simulation.h"

#include "render/effects/rig_move.h"
#include "sim/scene_build.h"
#include "sim/scene_file.h"
#include "tests/testing.h"

namespace laterna {
namespace {

Scene scene_with(const std::string& timing) {
  return build_scene(
      parse_scene(
          "[[mesh]]\nshape = \"relief\"\nshape_size = [4, 4, 0.3]\n"
          "[[projector]]\nsize = [32, 24]\nthrow_ratio = 1\nposition = [0.2, 0, 2]\nlook_at = [0.2, 0, 0]\n"
          "up = [0, 1, 0]\n"
          "[[camera]]\nsize = [40, 30]\nfov_x_deg = 40\nposition = [0, 0, 2]\nlook_at = [0, 0, 0]\nup = [0, "
          "1, "
          "0]\nsensor = { noise_sigma_dn = 1 }\n" +
              timing,
          "s"),
      {});
}

ImageStack<std::uint8_t> capture(const Scene& scene) {
  StageTimes times;
  const Traced traced = trace(scene, times);
  return std::get<0>(capture_view(scene, traced, traced.views[0], 1, times));
}

bool same_picture(const ImageStack<std::uint8_t>& a, const ImageStack<std::uint8_t>& b, int k) {
  return std::equal(a.picture(k).begin(), a.picture(k).end(), b.picture(k).begin());
}

TEST(Simulation, AMovedCameraSplicesTheSequencesOfBothPlaces) {
  const std::string timing =
      "[timing]\nmoved = { device = \"camera\", from_picture = 7, translation = [0.05, 0, 0] }\n";
  const Scene scene = scene_with(timing + "[effects]\ntiming = true\n");
  Scene still = scene, moved = after_move(scene);
  still.timing.moved = {};
  StageTimes times;
  // At the exposure that suits the first place.
  moved.cameras[0].sensor.saturation_cd_per_m2 = trace(still, times).views[0].saturation_cd_per_m2;
  const auto spliced = capture(scene), before = capture(still), after = capture(moved);
  for (int k = 0; k < spliced.count; ++k) EXPECT_TRUE(same_picture(spliced, k < 7 ? before : after, k)) << k;
  EXPECT_FALSE(same_picture(before, after, 7));
}

TEST(Simulation, TimingSwitchedOffLeavesNoTrace) {
  const auto plain = capture(scene_with(""));
  const auto off = capture(scene_with("[timing]\ndropped_frame = 3\nrolling_shutter_frames = 0.5\n"));
  ASSERT_EQ(plain.count, off.count);
  for (int k = 0; k < plain.count; ++k) EXPECT_TRUE(same_picture(plain, off, k)) << k;
}

}  // namespace
}  // namespace laterna
