#include "apps/lab/explain.h"

#include "sim/scene_build.h"
#include "sim/scene_file.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

TEST(Explain, TellsWhatEachEffectChanges) {
  const SceneSpec spec = parse_scene(
      "[[mesh]]\nshape = \"plane\"\nshape_size = [4, 4, 1]\nsolid = { kind = \"checker\", cell = 0.2, low = "
      "0.5 }\n"
      "[[projector]]\nsize = [32, 24]\nthrow_ratio = 1\nposition = [0.2, 0, 2]\nlook_at = [0.2, 0, 0]\n"
      "up = [0, 1, 0]\nscaler = { overscan = 0.25 }\n"
      "[[camera]]\nsize = [40, 30]\nfov_x_deg = 40\nposition = [0, 0, 2]\nlook_at = [0, 0, 0]\nup = [0, 1, "
      "0]\n",
      "s");
  const std::vector<EffectCost> costs = explain_effects(spec, build_scene(spec, {}), {}, 1);
  ASSERT_EQ(costs.size(), all_effects.size());
  const auto of = [&](const std::string& name) {
    return *std::find_if(costs.begin(), costs.end(), [&](const EffectCost& c) { return c.name == name; });
  };
  EXPECT_TRUE(of("shadow").on);
  EXPECT_EQ(of("shadow").max_dn, 0);  // a plane has none
  EXPECT_EQ(of("gloss").max_dn, 0);   // the scene gives it nothing to do
  EXPECT_FALSE(of("solid_albedo").on);
  EXPECT_GT(of("solid_albedo").max_dn, 50);
  EXPECT_EQ(of("solid_albedo").max_uv_px, 0);
  EXPECT_GT(of("scaler").rms_uv_px, 0.5);  // an eighth of the picture at its edges
  EXPECT_GT(of("shadow").entries_per_pixel, 0.5);
  EXPECT_THAT(explain_json(costs), ::testing::HasSubstr("\"stage\":\"pattern\""));
  EXPECT_THAT(explain_text(costs), ::testing::HasSubstr("solid_albedo"));
}

TEST(Explain, CountsWhatBouncesAdd) {
  const SceneSpec spec = parse_scene(
      "[[mesh]]\nshape = \"v_groove\"\nshape_size = [2, 2, 1]\n"
      "[[projector]]\nsize = [32, 24]\nthrow_ratio = 1\nposition = [0, 0, 2]\nlook_at = [0, 0, 0]\n"
      "up = [0, 1, 0]\n"
      "[[camera]]\nsize = [40, 30]\nfov_x_deg = 40\nposition = [0, 0, 2]\nlook_at = [0, 0, 0]\nup = [0, 1, "
      "0]\n[inter_reflection]\nbounces = 2\npaths = 8\n",
      "s");
  for (const EffectCost& c : explain_effects(spec, build_scene(spec, {}), {}, 1)) {
    if (c.name != std::string("inter_reflection")) continue;
    EXPECT_GT(c.entries_per_pixel, 1.5);  // 1 + 8·(F + ...), F about 1/3 on the whole
    EXPECT_LT(c.entries_per_pixel, 1 + 2 * 8);
    EXPECT_GT(c.rms_dn, 1);
  }
}

TEST(Explain, PricesBlurAndLenses) {
  const SceneSpec spec = parse_scene(
      "[[mesh]]\nshape = \"plane\"\nshape_size = [4, 4, 1]\n"
      "[[projector]]\nsize = [32, 24]\nthrow_ratio = 1\nposition = [0, 0, 2]\nlook_at = [0, 0, 0]\n"
      "up = [0, 1, 0]\naperture_m = 0.5\nfocus_m = 1\n"
      "lens = { model = \"LENSMODEL_OPENCV4\", parameters = [-0.1, 0, 0, 0] }\n"
      "[[camera]]\nsize = [40, 30]\nfov_x_deg = 40\nposition = [0, 0, 2]\nlook_at = [0, 0, 0]\n"
      "up = [0, 1, 0]\n[effects]\nprojector_lens = false\n",
      "s");
  const std::vector<EffectCost> costs = explain_effects(spec, build_scene(spec, {}), {}, 1);
  const auto of = [&](const std::string& name) {
    return *std::find_if(costs.begin(), costs.end(), [&](const EffectCost& c) { return c.name == name; });
  };
  // A disc of 8 px holds 50 pixels and cuts some 25 more, fewer at the border.
  EXPECT_GT(of("projector_defocus").entries_per_pixel, 50);
  EXPECT_LT(of("projector_defocus").entries_per_pixel, 76);
  EXPECT_LE(of("shadow").entries_per_pixel, 1);
  EXPECT_GT(of("projector_lens").rms_uv_px, 0.05);
  EXPECT_EQ(of("camera_lens").max_dn, 0);  // it is a pinhole
}

}  // namespace
}  // namespace laterna
