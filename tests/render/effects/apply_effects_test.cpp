#include "render/effects/apply_effects.h"

#include "tests/render/effects/lit_scene.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using testing::Lit;

// Everything has parameters; nothing is switched on.
Scene rich_scene() {
  Scene scene = testing::scene_of(
      {testing::object_of(relief(2, 2, 0.4, 30, 30)), testing::object_of(sphere(0.3, 12), {0, 0, 0.6})},
      testing::device_at({0.5, 0.3, 3}, {0, 0, 0}, {61, 45}, 60),
      testing::device_at({-0.5, 0.3, 3}, {0, 0, 0}, {50, 40}, 60));
  scene.objects[0].effects = {
      .gloss = {GlossModel::ggx, 0.2, {}, 0.3}, .solid = {SolidKind::noise, 0.1, 0.2}, .normal_map = "n.png"};
  scene.objects[0].normal_map = std::make_shared<const Image<glm::vec3>>(2, 2, glm::vec3(0.7f, 0.4f, 0.9f));
  scene.cameras[0].vignetting.model = VignettingModel::cos4;
  scene.projectors[0].effects = {.vignetting = {VignettingModel::cos4},
                                 .spotlight = {.exponent = 2},
                                 .attenuation = glm::dvec3(1, 1, 1),
                                 .scaler = {.overscan = 0.1},
                                 .response_exponent = 2.2,
                                 .black_level = 0.01,
                                 .veiling_glare = 0.05};
  return scene;
}

Scene bare(Scene scene) {
  for (Object& object : scene.objects) object.effects = {}, object.normal_map = {};
  scene.cameras[0].vignetting = {};
  scene.projectors[0].effects = {};
  return scene;
}

TEST(ApplyEffects, SwitchedOffTheyLeaveNoTrace) {
  const Scene scene = rich_scene();
  const testing::Traced plain(bare(scene));
  const Lit off(scene);
  EXPECT_TRUE(testing::same_bits(off.surface.albedo, plain.surface.albedo));
  EXPECT_TRUE(testing::same_bits(off.light().white_lx, plain.light.white_lx));
  EXPECT_TRUE(testing::same_bits(off.light().u_px, plain.light.u_px));
  EXPECT_TRUE(testing::same_bits(off.light().why, plain.light.why));
  const PatternStack patterns = make_patterns(scene, scene.projectors[0]);
  EXPECT_EQ(patterns.values, make_pattern_stack({{50, 40}}).values);
  EXPECT_TRUE(patterns.is_linear());
}

// Each switch that edits weights, albedo or patterns changes what it names and nothing else.
TEST(ApplyEffects, EachSwitchChangesItsOwnStage) {
  const Lit off(rich_scene());
  const PatternStack off_patterns = make_patterns(rich_scene(), rich_scene().projectors[0]);
  for (const EffectSwitch& effect : all_effects) {
    Scene scene = rich_scene();
    if (scene.effects.*effect.on || effect.on == &Effects::slide) continue;
    scene.effects.*effect.on = true;
    const Lit on(scene);
    const std::string stage = effect.stage, name = effect.name;
    const bool light_changes = !testing::same_bits(on.light().white_lx, off.light().white_lx);
    const bool albedo_changes = !testing::same_bits(on.surface.albedo, off.surface.albedo);
    EXPECT_EQ(light_changes, stage == "weight" && name != "camera_vignetting" && name != "colour") << name;
    EXPECT_EQ(albedo_changes, (stage == "surface" && name != "displacement") || name == "camera_vignetting")
        << name;
    const PatternStack patterns = make_patterns(scene, scene.projectors[0]);
    const bool patterns_change = !patterns.is_linear() || patterns.values != off_patterns.values;
    EXPECT_EQ(patterns_change, stage == "pattern") << name;
    EXPECT_TRUE(testing::same_bits(on.light().u_px, off.light().u_px)) << name;
  }
}

TEST(ApplyEffects, SameBitsForAnyThreads) {
  Scene scene = rich_scene();
  for (const EffectSwitch& effect : all_effects)
    if (effect.on != &Effects::slide) scene.effects.*effect.on = true;
  set_thread_count(1);
  const Lit one(scene);
  const PatternStack one_stack = make_patterns(scene, scene.projectors[0]);
  for (const int threads : {2, 7}) {
    set_thread_count(threads);
    const Lit many(scene);
    const PatternStack many_stack = make_patterns(scene, scene.projectors[0]);
    EXPECT_TRUE(testing::same_bits(many.light().white_lx, one.light().white_lx));
    EXPECT_TRUE(testing::same_bits(many.surface.albedo, one.surface.albedo));
    EXPECT_EQ(many_stack.values, one_stack.values);
    EXPECT_EQ(many_stack.added_light, one_stack.added_light);
  }
  set_thread_count(0);
}

TEST(ApplyEffects, OneLightPerProjector) {
  const Scene scene = testing::facing_plane();
  const RayScene rays(scene);
  SurfaceMap surface = trace_surface(rays, scene, scene.cameras[0]);
  EXPECT_THAT(testing::input_error([&] { apply_effects(surface, {}, rays, scene, scene.cameras[0]); }),
              ::testing::HasSubstr("light of 0 projectors, expected the scene's 1"));
}

TEST(ApplyEffects, ASlideStandsInPlaceOfTheCode) {
  Scene scene = testing::facing_plane();
  scene.effects.slide = true;
  scene.slide = std::make_shared<const Slide>(Slide{Image<float>(100, 80, 0.2f), true});
  const PatternStack patterns = make_patterns(scene, scene.projectors[0]);
  EXPECT_EQ(patterns.count, 1);
  EXPECT_EQ(patterns.values[17], 51);
}

}  // namespace
}  // namespace laterna
