#include "apps/lab/plan/choices.h"

#include "apps/lab/plan/answer.h"
#include "sim/device_spec.h"
#include "sim/scene_build.h"
#include "sim/scene_file.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::ElementsAre;
using testing::ScratchFolder;
using testing::write_text;

const std::string rich = R"(
[effects]
antialiasing = true
fill_factor = true
inter_reflection = true
[inter_reflection]
bounces = 3
paths = 20
[patterns]
kind = "gray_phase"
steps = 8
repeat_first = true
[[mesh]]
shape = "v_groove"
[[projector]]
size = [640, 400]
throw_ratio = 1.5
position = [0, 0, 3]
look_at = [0, 0, 0]
up = [0, 1, 0]
lens = { model = "LENSMODEL_OPENCV5", parameters = [-0.05, 0.01, 0.001, 0.002, 0.003] }
[[camera]]
size = [641, 400]
fx = 900.0
cx = 330.0
position = [0, 0.5, 3]
look_at = [0, 0, 0]
up = [0, 1, 0]
samples_per_pixel = 9
fill_factor = 0.5
)";

struct Given {
  SceneSpec spec = parse_scene(rich, "rich.toml");
  std::vector<Choice> choices = choices_of(spec, build_scene(spec, {}), {});

  std::size_t index(const std::string& name) const {
    for (std::size_t k = 0; k < choices.size(); ++k)
      if (choices[k].name == name) return k;
    ADD_FAILURE() << "no choice " << name;
    return 0;
  }
  std::vector<std::string> values(const std::string& name) const {
    std::vector<std::string> values{choices[index(name)].full};
    for (const Level& level : choices[index(name)].levels) values.push_back(level.value);
    return values;
  }
  SceneSpec with(const std::string& name, int level) const {
    Levels levels(choices.size(), 0);
    levels[index(name)] = level;
    return at_levels(spec, choices, levels);
  }
};

// Light planes are on by default, but no projector has them; the camera has no lens.
TEST(Choices, AreWhatTheSceneHas) {
  std::vector<std::string> names;
  for (const Choice& choice : Given{}.choices) names.push_back(choice.name);
  EXPECT_THAT(names,
              ElementsAre("shadow", "back_face", "border", "irradiance", "projector_lens", "antialiasing",
                          "fill_factor", "inter_reflection", "samples_per_pixel", "paths", "bounces",
                          "resolution", "patterns", "projector_lens_terms", "exposure"));
}

// Blurred rows cost as much for the exposure as for the pictures. With one projector nothing changes.
TEST(Choices, AFixedExposureIsTheAutomaticOne) {
  const std::filesystem::path folder = testing::data_folder() / "scenes";
  const SceneSpec spec = read_scene_spec(folder / "near_focus.toml");
  const std::vector<Choice> choices = choices_of(spec, build_scene(spec, folder), folder);
  ASSERT_EQ(choices.back().name, "exposure");
  Levels levels(choices.size(), 0);
  levels.back() = 1;
  const SceneSpec fixed = at_levels(spec, choices, levels);
  EXPECT_GT(fixed.cameras[0].sensor.saturation_cd_per_m2, 0.0);
  const auto answers = [&](const SceneSpec& of) {
    return round_trip_json(round_trip(of, folder, testing::seed())).at("answers");
  };
  EXPECT_EQ(answers(fixed), answers(spec));
  for (std::size_t k = 0; k + 1 < choices.size(); ++k) levels[k] = int(choices[k].name == "irradiance");
  const SceneSpec brighter = at_levels(spec, choices, levels);  // without the light's falling off
  EXPECT_NE(brighter.cameras[0].sensor.saturation_cd_per_m2, fixed.cameras[0].sensor.saturation_cd_per_m2);
}

TEST(Choices, AnExposureThatTakesNoRaysIsNone) {
  SceneSpec plain = Given{}.spec;
  plain.effects.antialiasing = plain.effects.fill_factor = plain.effects.inter_reflection = false;
  for (const Choice& choice : choices_of(plain, build_scene(plain, {}), {}))
    EXPECT_NE(choice.name, "exposure");
  SceneSpec told = Given{}.spec;
  told.cameras[0].sensor.saturation_cd_per_m2 = 100;
  for (const Choice& choice : choices_of(told, build_scene(told, {}), {})) EXPECT_NE(choice.name, "exposure");
}

TEST(Choices, LevelsAreCheaperAndCheaper) {
  const Given given;
  EXPECT_THAT(given.values("samples_per_pixel"), ElementsAre("9", "3", "2"));
  EXPECT_THAT(given.values("paths"), ElementsAre("20", "5", "2", "1"));
  EXPECT_THAT(given.values("bounces"), ElementsAre("3", "2", "1"));
  EXPECT_THAT(given.values("resolution"), ElementsAre("641x400", "320x200", "160x100"));
  EXPECT_THAT(given.values("projector_lens_terms"), ElementsAre("5", "4"));
  EXPECT_THAT(given.values("patterns"),
              ElementsAre("gray_phase, 8 steps, first repeated", "gray_phase, 8 steps", "gray_phase, 6 steps",
                          "gray_phase, 5 steps", "gray_phase, 4 steps", "gray_phase, 3 steps"));
}

TEST(Choices, EditOneThingEach) {
  const Given given;
  EXPECT_FALSE(given.with("shadow", 1).effects.shadow);
  EXPECT_EQ(given.with("samples_per_pixel", 1).cameras[0].samples_per_pixel, 3);
  EXPECT_EQ(given.with("paths", 2).inter_reflection.paths, 2);
  EXPECT_EQ(given.with("bounces", 2).inter_reflection.bounces, 1);
  EXPECT_EQ(given.with("patterns", 5).patterns.parameters.steps, 3);
  const Lens lens = given.with("projector_lens_terms", 1).projectors[0].device.lens;
  EXPECT_EQ(lens.model, "LENSMODEL_OPENCV4");
  EXPECT_THAT(lens.parameters, ElementsAre(-0.05, 0.01, 0.001, 0.002));
  EXPECT_EQ(at_levels(given.spec, given.choices, Levels(given.choices.size(), 0)), given.spec);
}

// A camera's fill factor is its samples' doing: without antialiasing it has none to act on.
TEST(Choices, FillFactorGoesWithAntialiasing) {
  const SceneSpec spec = Given{}.with("antialiasing", 1);
  EXPECT_FALSE(spec.effects.antialiasing);
  EXPECT_FALSE(spec.effects.fill_factor);
  EXPECT_NO_THROW(check(spec));
}

// Every level of every choice, alone, is a scene that can be built.
TEST(Choices, EveryLevelIsSound) {
  const Given given;
  for (const Choice& choice : given.choices)
    for (int level = 1; level <= int(choice.levels.size()); ++level)
      EXPECT_NO_THROW(build_scene(given.with(choice.name, level), {})) << choice.name << level;
}

// A world point moves with the centre of the pixels: twice halved, 4·(u' + 1/2) = u + 1/2.
TEST(CamerasHalved, LookTheSameWay) {
  const ScratchFolder folder;
  write_text(
      folder / "c.cameramodel",
      "{ 'lensmodel': 'LENSMODEL_OPENCV4', 'intrinsics': [500, 510, 320.25, 240.125, -0.1, 0.01, 0.001, "
      "0.002],\n'extrinsics': [0.1, 0.2, 0.3, 1, 2, 3], 'imagersize': [640, 481] }\n");
  for (const std::string& text :
       {std::string("size = [641, 401]\nfx = 900.0\nposition = [0, 0.5, 3]\nlook_at = [0, 0, 0]\n"),
        std::string("size = [640, 480]\nfov_x_deg = 40\nposition = [0, 0.5, 3]\nlook_at = [0, 0, 0]\n"),
        std::string("cameramodel = \"c.cameramodel\"\n")}) {
    const SceneSpec full = parse_scene("[[mesh]]\nshape = \"box\"\n[[camera]]\n" + text, "s.toml");
    const SceneSpec less = with_cameras_halved(full, 2, folder.path());
    const Device a = device_of(full.cameras[0].device, folder.path(), "full"),
                 b = device_of(less.cameras[0].device, folder.path(), "less");
    EXPECT_EQ(b.intrinsics.size, a.intrinsics.size / 4);
    const glm::dvec3 x = center_in_world(a.device_from_world) +
                         glm::transpose(a.device_from_world.rotation) * glm::dvec3(0.1, -0.2, 2);
    const glm::dvec3 p = WorldProjection(a).project(x), q = WorldProjection(b).project(x);
    // 1e-9: some roundings of a few hundred pixels, and of the file's numbers.
    EXPECT_NEAR(4 * (q.x + 0.5), p.x + 0.5, 1e-9) << text;
    EXPECT_NEAR(4 * (q.y + 0.5), p.y + 0.5, 1e-9) << text;
  }
}

TEST(CamerasHalved, BeliefsInPixelsAreHalvedToo) {
  const SceneSpec full = parse_scene(
      "[[mesh]]\nshape = \"box\"\n[[camera]]\nsize = [640, 400]\nfx = 900.0\nposition = [0, 0.5, 3]\nlook_at "
      "= "
      "[0, 0, 0]\nbelieved = { focal_px = [2, 4], sigma_center_px = [1, 3] }\n",
      "s.toml");
  const CameraBelief believed = with_cameras_halved(full, 1, {}).cameras[0].believed;
  EXPECT_EQ(believed.focal_px, glm::dvec2(1, 2));
  EXPECT_EQ(believed.sigma_center_px, glm::dvec2(0.5, 1.5));
}

}  // namespace
}  // namespace laterna
