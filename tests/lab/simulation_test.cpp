// Blur through a scene file: grey edges, soft pictures, and the warning that goes with them.
#include "apps/lab/simulation.h"

#include "apps/lab/capture_warnings.h"
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

}  // namespace
}  // namespace laterna
