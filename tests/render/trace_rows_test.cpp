// Rows traced on request beside those from maps, idle projectors, and frames that pictures share.
#include "render/trace_rows.h"

#include "render/effects/apply_effects.h"
#include "tests/render/effects/lit_scene.h"
#include "tests/testing.h"

namespace laterna {
namespace {

using testing::device_at;
using testing::object_of;
using testing::scene_of;

// Two projectors on a relief, with effects on surface, weight and camera.
Scene two_projectors() {
  Scene scene =
      scene_of({object_of(relief(2, 2, 0.3, 40, 40))}, device_at({0.3, 0, 3}, {0, 0, 0}, {130, 90}, 150),
               device_at({-0.3, 0, 3}, {0, 0, 0}, {60, 40}, 60));
  scene.projectors.push_back({device_at({0, 0.4, 2.5}, {0, 0, 0}, {50, 30}, 40), 800});
  scene.projectors[1].effects.black_level = 0.02;
  scene.projectors[0].effects.vignetting.model = VignettingModel::cos4;
  scene.cameras[0].vignetting = {VignettingModel::polynomial, {-0.2}, ""};
  scene.objects[0].effects.solid = {SolidKind::noise, 0.2, 0.3};
  scene.ambient_lx = 5;
  Effects& on = scene.effects;
  on.black_level = on.projector_vignetting = on.camera_vignetting = on.solid_albedo = true;
  return scene;
}

TEST(TraceRows, WithEffectsTheRegionsRowsAreTheWholeMapsRows) {
  const Scene scene = two_projectors();
  ASSERT_TRUE(rows_are_direct(scene, 0));
  const testing::Lit lit(scene);
  const CameraRays directions(scene.cameras[0].device);
  const IdleLight idle{&lit.lights[1], 0.02};
  LightRows traced, mapped;
  traced.region = mapped.region = {64, 48, 66, 42};
  trace_rows(lit.rays, scene, 0, directions, 0)(traced);
  direct_rows(lit.surface, lit.lights[0], {&idle, 1}, scene.ambient_lx, mapped);
  EXPECT_EQ(traced.begin, mapped.begin);
  EXPECT_EQ(traced.ambient_cd_per_m2, mapped.ambient_cd_per_m2);
  ASSERT_EQ(traced.entries.size(), mapped.entries.size());
  ASSERT_GT(traced.entries.size(), 1000u);
  for (std::size_t e = 0; e < traced.entries.size(); ++e) {
    EXPECT_EQ(traced.entries[e].u_px, mapped.entries[e].u_px);
    EXPECT_EQ(traced.entries[e].v_px, mapped.entries[e].v_px);
    EXPECT_EQ(traced.entries[e].weight, mapped.entries[e].weight);
  }
}

TEST(TraceRows, AnIdleProjectorAddsItsBlackAndNothingElse) {
  const Scene scene = two_projectors();
  ASSERT_EQ(idle_projectors(scene, 0).size(), 1u);
  EXPECT_EQ(idle_projectors(scene, 0)[0].projector, 1);
  EXPECT_TRUE(idle_projectors(scene, 1).empty());  // the first has no black level
  Scene alone = scene;
  alone.projectors.pop_back();
  const testing::Lit lit(scene);
  const CameraRays directions(scene.cameras[0].device);
  LightRows both, one;
  both.region = one.region = {0, 0, 130, 90};
  trace_rows(lit.rays, scene, 0, directions, 0)(both);
  trace_rows(lit.rays, alone, 0, directions, 0)(one);
  EXPECT_EQ(both.begin, one.begin);
  int lit_by_second = 0;
  for (std::size_t p = 0; p < both.region.size(); ++p) {
    const double added = both.ambient_cd_per_m2[p] - one.ambient_cd_per_m2[p];
    const double expected =
        lit.lights[1].lit(p)
            ? luminance_cd_per_m2(lit.surface.albedo.values[p], 0.02 * lit.lights[1].white_lx.values[p], 0)
            : 0;
    EXPECT_NEAR(added, expected, 1e-12 * both.ambient_cd_per_m2[p]);  // one rounding of the sum
    lit_by_second += expected > 0;
  }
  EXPECT_GT(lit_by_second, 500);
}

TEST(Show, ATimelineMixesFrames) {
  const Scene scene = testing::facing_plane();
  const testing::Lit lit(scene);
  PatternStack frames = testing::constant_pattern({100, 80}, 3, 0);
  for (std::size_t i = 0; i < frames.values.size(); ++i) frames.values[i] = std::uint8_t(i % 3 * 100);
  const ImageRows image{{60, 40},
                        [&](LightRows& rows) { direct_rows(lit.surface, lit.light(), {}, 9, rows); }};
  // Picture 0 is frame 2; picture 1 is frame 1 above row 20, below it one quarter of frame 0.
  const Timeline timeline{2, [](int row, int) {
                            return row < 20 ? std::vector<PictureFrames>{{{2, 1}}, {{1, 1}}}
                                            : std::vector<PictureFrames>{{{2, 1}}, {{0, 0.25f}, {1, 0.75f}}};
                          }};
  const auto mixed = play_luminance(image, Lookup::nearest, Show({AnyPatterns(frames)}, timeline));
  const auto plain = play_luminance(image, Lookup::nearest, frames);
  ASSERT_EQ(mixed.count, 2);
  for (std::size_t p = 0; p < mixed.picture_size(); ++p) {
    EXPECT_EQ(mixed.picture(0)[p], plain.picture(2)[p]);
    const float expected =
        p / 60 < 20 ? plain.picture(1)[p] : 0.25f * plain.picture(0)[p] + 0.75f * plain.picture(1)[p];
    EXPECT_NEAR(mixed.picture(1)[p], expected, 1e-6f * expected);  // single precision
  }
}

TEST(Show, RefusesStacksThatDoNotGoTogether) {
  const PatternStack three = testing::constant_pattern({4, 4}, 3, 0),
                     two = testing::constant_pattern({4, 4}, 2, 0);
  EXPECT_EQ(testing::input_error([&] {
              Show({AnyPatterns(three), AnyPatterns(two)});
            }),
            "show: stacks of 3 and 2 patterns, expected one number of patterns");
  EXPECT_EQ(testing::input_error([&] { Show(std::vector<AnyPatterns>()); }),
            "show: no patterns, expected at least one stack");
}

}  // namespace
}  // namespace laterna
