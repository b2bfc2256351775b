// Blur and timing through a scene file: grey edges, soft pictures and the warning that goes with them, a rig
// that moves.
#include "apps/lab/simulation.h"

#include "apps/lab/capture_warnings.h"
#include "render/effects/rig_move.h"
#include "sim/scene_build.h"
#include "sim/scene_file.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A plane that ends at camera column 41.3, in a picture 80 px wide with f = 100 px at 2 m.
Scene half_plane(const std::string& projector, const std::string& camera, const std::string& effects) {
  const std::string device = "position = [0, 0, 2]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\n";
  return build_scene(
      parse_scene("[[mesh]]\nshape = \"plane\"\nshape_size = [4, 4, 1]\ntranslate = [-1.964, 0, 0]\n"
                  "[[projector]]\nsize = [64, 64]\nfx = 40\n" +
                      device + projector + "[[camera]]\nsize = [80, 60]\nfx = 100\n" + device + camera +
                      "[effects]\n" + effects,
                  "s"),
      {});
}

TEST(Simulation, GreyAtAnEdgeIsTheCoveredArea) {
  const Scene scene = half_plane("", "samples_per_pixel = 64\n", "antialiasing = true\n");
  StageTimes times;
  const Traced traced = trace(scene, times);
  const CapturedStack stack = capture_view(scene, traced, traced.views[0], testing::seed(), times);
  const auto& pictures = std::get<ImageStack<std::uint8_t>>(stack);
  const auto white = pictures.picture(pictures.count - 2);
  double inside = 0, cut = 0;
  for (int y = 0; y < 60; ++y) {
    inside += white[y * 80 + 39] / 60.0, cut += white[y * 80 + 41] / 60.0;
    EXPECT_EQ(white[y * 80 + 42], 0);
  }
  // Of 8 columns of cells the edge cuts one: 480 samples, each at most 1/2 off in sigma and worth 1/64 of 60
  // rows' mean: 0.5·√8/64/√60 = 0.003, five times; DN are whole numbers of some 200.
  EXPECT_NEAR(cut / inside, 0.8, 0.02);
}

TEST(Simulation, WarnsOfAProjectorThatIsOutOfFocus) {
  const std::string lens = "aperture_m = 0.2\nfocus_m = 1\n";  // 40·0.2·|1/1 - 1/2| = 4 px
  const auto warnings = [&](const std::string& projector, const std::string& effects) {
    const Scene scene = half_plane(projector, "", effects);
    StageTimes times;
    return capture_warnings(scene, make_rig(scene, times));
  };
  const std::string on = "projector_defocus = true\n";
  ASSERT_EQ(warnings(lens, on).size(), 1u);
  EXPECT_THAT(warnings(lens, on)[0], HasSubstr("a blur of 4.0 px"));
  EXPECT_THAT(warnings(lens, on)[0], HasSubstr("18 % of their contrast"));  // 2·J1(π)/π
  EXPECT_THAT(warnings("aperture_m = 0.4\nfocus_m = 1\n", on)[0], HasSubstr("they will not decode"));
  EXPECT_THAT(warnings(lens, ""), IsEmpty());
  EXPECT_THAT(warnings("aperture_m = 0.2\nfocus_m = 2\n", on), IsEmpty());
}

TEST(Simulation, AWideFillFactorsPeaksDoNotSaturate) {
  const Scene scene = half_plane("fill_factor = 0.5\n", "", "fill_factor = true\n");
  StageTimes times;
  const Traced traced = trace(scene, times);
  const CapturedStack stack = capture_view(scene, traced, traced.views[0], 1, times);
  for (const std::uint8_t dn : std::get<ImageStack<std::uint8_t>>(stack).values) EXPECT_LT(dn, 250);
}

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
