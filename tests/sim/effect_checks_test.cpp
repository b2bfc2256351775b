#include "sim/effect_checks.h"

#include "sim/scene_build.h"
#include "sim/scene_file.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <set>

namespace laterna {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string mesh = "[[mesh]]\nshape = \"plane\"\n";
const std::string device =
    "size = [640, 480]\nfx = 500\nposition = [0, 0, 2]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\n";
const std::string projector = "[[projector]]\n" + device, camera = "[[camera]]\n" + device;
const std::string slide = "[patterns]\nkind = \"slide\"\n";

std::string error_of(const std::string& text) {
  return testing::input_error([&] { parse_scene(text, "s"); });
}
std::string switch_on(const std::string& name) { return "[effects]\n" + name + " = true\n"; }

TEST(EffectChecks, ASwitchWithoutItsParametersNamesTheMissingKey) {
  const std::string scene = mesh + projector + camera;
  const auto expect = [&](const std::string& name, const std::string& noun, const std::string& key) {
    EXPECT_THAT(error_of(scene + switch_on(name)),
                AllOf(HasSubstr("[effects]: " + name + " is on"), HasSubstr("[[" + noun + "]]"),
                      HasSubstr("the key " + key)));
  };
  expect("projector_vignetting", "projector", "vignetting");
  expect("camera_vignetting", "camera", "vignetting");
  expect("veiling_glare", "projector", "veiling_glare");
  expect("scaler", "projector", "scaler");
  expect("spotlight", "projector", "spotlight");
  expect("attenuation", "projector", "attenuation");
  expect("gloss", "mesh", "gloss");
  expect("normal_map", "mesh", "normal_map");
  expect("displacement", "mesh", "displacement_map");
  expect("solid_albedo", "mesh", "solid");
  expect("response", "projector", "response_exponent");
  expect("black_level", "projector", "black_level");
  expect("camera_defocus", "camera", "aperture_m (with focus_m)");
  expect("projector_defocus", "projector", "aperture_m (with focus_m)");
  expect("camera_glare", "camera", "veiling_glare");
  EXPECT_THAT(error_of(scene + switch_on("colour")), HasSubstr("nothing has a colour"));
  EXPECT_THAT(error_of(scene + switch_on("timing")), HasSubstr("[timing] has no key"));
}

TEST(EffectChecks, ColourAndTimingNameDevicesOfTheScene) {
  const std::string scene = mesh + projector + camera;
  const auto pair = [](const std::string& p, const std::string& c, const std::string& numbers) {
    return "[[colour]]\nprojector = \"" + p + "\"\ncamera = \"" + c + "\"\nmixing = [" + numbers + "]\n";
  };
  const std::string nine = "1, 0, 0, 0, 1, 0, 0, 0, 1", good = pair("projector", "camera", nine);
  EXPECT_THAT(error_of(scene + pair("projector", "camera", "1, 0, 0")), HasSubstr("3 numbers, expected 9"));
  EXPECT_THAT(error_of(scene + pair("", "camera", nine)), HasSubstr("projector or camera is missing"));
  EXPECT_THAT(error_of(scene + pair("camera", "camera", nine)),
              HasSubstr("no projector is called \"camera\""));
  EXPECT_THAT(error_of(scene + pair("projector", "eye", nine)), HasSubstr("no camera is called \"eye\""));
  EXPECT_THAT(error_of(scene + good + good), HasSubstr("two mixings"));
  EXPECT_THAT(error_of(scene + "[timing]\nmoved = { device = \"x\" }\n"),
              HasSubstr("no projector or camera is called \"x\""));
  EXPECT_THAT(error_of(scene + "[timing]\ncolour_wheel = true\n" + switch_on("timing")),
              HasSubstr("colour of [effects] is off"));
  const Scene built =
      build_scene(parse_scene(scene + pair("projector", "camera", "1, 2, 3, 4, 5, 6, 7, 8, 9"), "s"), {});
  ASSERT_EQ(built.mixings.size(), 1u);
  EXPECT_EQ(built.mixings[0].channels[1], glm::dvec3(4, 5, 6));
}

TEST(EffectChecks, BlurNeedsItsOpticsAndRays) {
  const std::string scene = mesh + projector + camera, lens = "aperture_m = 0.007\nfocus_m = 0.5\n";
  EXPECT_THAT(error_of(scene + switch_on("diffraction")), HasSubstr("no device has the key aperture_m"));
  EXPECT_THAT(error_of(scene + switch_on("fill_factor")), HasSubstr("no device has one below 1"));
  EXPECT_THAT(error_of(scene + lens + switch_on("camera_defocus")), HasSubstr("samples_per_pixel"));
  EXPECT_THAT(error_of(scene + lens + switch_on("diffraction")), HasSubstr("samples_per_pixel"));
  EXPECT_THAT(error_of(scene + "fill_factor = 0.5\n" + switch_on("fill_factor")),
              HasSubstr("antialiasing is off"));
  parse_scene(scene + lens + "samples_per_pixel = 4\nfill_factor = 0.5\n" + switch_on("camera_defocus") +
                  "diffraction = true\nantialiasing = true\nfill_factor = true\n",
              "s");
}

TEST(EffectChecks, ALensThatIsSwitchedOffIsAPinhole) {
  const std::string lens = "lens = { model = \"LENSMODEL_OPENCV4\", parameters = [-0.1, 0, 0, 0] }\n";
  const std::string text = mesh + projector + lens + camera + lens;
  const auto load = [&](const std::string& effects) {
    return build_scene(parse_scene(text + effects, "s"), {});
  };
  for (const Scene& scene :
       {load(""), load("[effects]\ncamera_lens = false\n"), load("[effects]\nprojector_lens = false\n")}) {
    EXPECT_EQ(is_pinhole(scene.cameras[0].device.lens), !scene.effects.camera_lens);
    EXPECT_EQ(is_pinhole(scene.projectors[0].device.lens), !scene.effects.projector_lens);
  }
}

TEST(EffectChecks, ASlidesThreeKeysGoTogether) {
  EXPECT_THAT(error_of(mesh + switch_on("slide")), HasSubstr("kind of [patterns] is \"gray\""));
  EXPECT_THAT(error_of(mesh + slide), HasSubstr("slide of [effects] is off"));
  EXPECT_THAT(error_of(mesh + slide + switch_on("slide")), HasSubstr("[patterns] has no key file"));
}

TEST(EffectChecks, InterReflectionHasBouncesAndRowsThatFitInMemory) {
  const auto error = [&](const std::string& numbers) {
    return error_of(mesh + camera + switch_on("inter_reflection") + "[inter_reflection]\n" + numbers);
  };
  EXPECT_THAT(error("paths = 8\n"), HasSubstr("[inter_reflection] has no bounces, expected at least 1"));
  EXPECT_THAT(error("bounces = 65\n"), HasSubstr("bounces"));
  EXPECT_THAT(error("bounces = 1\npaths = 0\n"), HasSubstr("paths"));
  EXPECT_THAT(error("bounces = 64\npaths = 4097\n"), HasSubstr("paths"));
  EXPECT_EQ(parse_scene(mesh + camera + switch_on("inter_reflection") +
                            "[inter_reflection]\nbounces = 64\npaths = 4096\n",
                        "s")
                .inter_reflection,
            (InterReflection{64, 4096}));
  const std::string sampled = camera + "samples_per_pixel = 2\n";
  EXPECT_THAT(error_of(mesh + sampled + switch_on("inter_reflection") +
                       "antialiasing = true\n[inter_reflection]\nbounces = 64\npaths = 4096\n"),
              HasSubstr("2 samples per pixel × 4096 paths × 64 bounces = 524288, expected at most 262144"));
}

TEST(EffectChecks, ParametersThatMakeNoSense) {
  const auto projector_error = [&](const std::string& line) { return error_of(mesh + projector + line); };
  EXPECT_THAT(projector_error("vignetting = { model = \"polynomial\" }\n"),
              HasSubstr("coefficients are missing"));
  EXPECT_THAT(projector_error("vignetting = { model = \"map\" }\n"), HasSubstr("map is missing"));
  EXPECT_THAT(projector_error("attenuation = [0, 0, 0]\n"), HasSubstr("all three numbers are 0"));
  EXPECT_THAT(projector_error("scaler = { keystone = [0, 0, 1, 0] }\n"),
              HasSubstr("has 4 numbers, expected 8"));
  EXPECT_THAT(projector_error("scaler = { keystone = [0, 0, 1, 1, 1, 0, 0, 1] }\n"), HasSubstr("no convex"));
  EXPECT_THAT(projector_error("response_table = [0.5]\n"), HasSubstr("at least 2"));
  EXPECT_THAT(projector_error("response_table = [0, 1]\nresponse_exponent = 2\n"), HasSubstr("both given"));
  EXPECT_THAT(error_of(mesh + "gloss = { model = \"phong\" }\n"), HasSubstr("exponent is missing"));
  EXPECT_THAT(error_of(mesh + "gloss = { model = \"ggx\" }\n"), HasSubstr("roughness is missing"));
  EXPECT_THAT(error_of(mesh + "displacement = 0.1\n"), HasSubstr("displacement_map is missing"));
  EXPECT_THAT(error_of(mesh + "displacement_map = \"h.png\"\n"), HasSubstr("displacement is missing or 0"));
  EXPECT_THAT(error_of(mesh + "displacement_map = \"h.png\"\ndisplacement = 1e7\n"),
              HasSubstr("displacement"));
  EXPECT_THAT(error_of(mesh + "gloss = { model = \"ggx\", roughness = 0.1, strength = 0.3 }\n"),
              HasSubstr("more than all light"));
}

TEST(EffectChecks, EveryKeySurvivesWritingAndReading) {
  SceneSpec scene = parse_scene(mesh + projector + camera, "s");
  int defaults_on = 0;
  std::set<std::string> names;
  for (const EffectSwitch& effect : all_effects) {
    names.insert(effect.name);
    defaults_on += scene.effects.*effect.on;
    scene.effects.*effect.on = !(scene.effects.*effect.on);
  }
  EXPECT_EQ(names.size(), all_effects.size());
  EXPECT_EQ(defaults_on, 7);
  scene.inter_reflection = {3, 20};
  scene.patterns.parameters.kind = PatternKind::slide;
  scene.patterns.file = "slide.png";
  scene.patterns.encoding = Encoding::linear;
  scene.patterns.colour = {1, 0.5, 0.25};
  scene.colours = {{"projector", "camera", {1, 0.1, 0, 0.2, 1, 0.2, 0, 0.1, 1}}};
  scene.timing = {3, 5, 2, 1.3, 0.2, 0.5, true, true, {"camera", 7, {0, 0.01, 0}, {0.001, 0, 0}}};
  scene.meshes[0].albedo = 0.5;
  scene.meshes[0].effects = {
      {GlossModel::ggx, 0.25, {}, 0.3}, {SolidKind::noise, 0.7, 0.1}, "n.png", "h.png", -0.5, 2.5};
  scene.cameras[0].vignetting = {VignettingModel::map, {}, "v.exr"};
  scene.cameras[0].samples_per_pixel = 9;
  scene.cameras[0].colour_filter = ColourFilter::bayer_gbrg;
  scene.cameras[0].veiling_glare = 0.02;
  scene.projectors[0].effects = {
      .vignetting = {VignettingModel::polynomial, {-0.1, 0.01}, ""},
      .spotlight = {20.0, 3, 0.5},
      .attenuation = glm::dvec3(1, 0.5, 0.25),
      .scaler = {glm::ivec2(800, 600), 0.05, {0.1, 0, 0.9, 0, 1, 1, 0, 1}, Lookup::nearest},
      .response_exponent = 1.707,
      .response_table = {},
      .black_level = 0.0005,
      .veiling_glare = 0.03,
      .optics = {0.007, 0.5, 6e-7, 0.9}};
  scene.cameras[0].optics = {0.004, 1.5, 5e-7, 0.5};
  const std::string text = scene_toml(scene);
  EXPECT_EQ(parse_scene(text, "s"), scene) << text;
}

TEST(EffectChecks, PicturesAreReadAndChecked) {
  const testing::ScratchFolder folder;
  const auto load = [&](const std::string& text) {
    return load_scene(testing::write_text(folder / "s.toml", text));
  };
  write_picture(folder / "up.exr", Image<glm::vec3>(4, 2, glm::vec3(0.5f, 0.5f, 1)));
  write_picture(folder / "down.exr", Image<glm::vec3>(4, 2, glm::vec3(0.5f, 0.5f, 0.2f)));
  write_picture(folder / "half.exr", Image<float>(640, 480, 0.5f));
  write_picture(folder / "red.exr", Image<glm::vec3>(640, 480, glm::vec3(0.75f, 0, 0)));
  const Scene scene = load(mesh + "normal_map = \"up.exr\"\n" + projector +
                           "vignetting = { model = \"map\", map = \"half.exr\" }\n" + slide +
                           "file = \"half.exr\"\n" + switch_on("slide"));
  EXPECT_EQ((*scene.objects[0].normal_map)(3, 1), glm::vec3(0.5f, 0.5f, 1));
  EXPECT_EQ((*scene.projectors[0].vignetting_map)(3, 1), 0.5f);
  EXPECT_EQ(scene.slide->light.width, 640);
  EXPECT_TRUE(scene.slide->primaries.empty());
  const Scene red = load(mesh + slide + "file = \"red.exr\"\n" + switch_on("slide"));
  EXPECT_EQ(red.slide->light(3, 1), 0.25f);
  ASSERT_EQ(red.slide->primaries.size(), 3u);
  EXPECT_EQ(red.slide->primaries[0](3, 1), 0.75f);
  EXPECT_EQ(red.slide->primaries[2](3, 1), 0);
  EXPECT_THAT(testing::input_error([&] { load(mesh + "normal_map = \"down.exr\"\n"); }),
              HasSubstr("blue above 0.5"));
  write_picture(folder / "high.exr", Image<float>(4, 2, 1.5f));
  EXPECT_THAT(
      testing::input_error([&] { load(mesh + "displacement_map = \"high.exr\"\ndisplacement = 0.1\n"); }),
      AllOf(HasSubstr("high.exr"), HasSubstr("a pixel is 1.5, expected 0 to 1")));
  EXPECT_THAT(
      testing::input_error([&] { load(mesh + "displacement_map = \"none.png\"\ndisplacement = 0.1\n"); }),
      HasSubstr("none.png"));
  EXPECT_THAT(testing::input_error([&] { load(mesh + "normal_map = \"none.png\"\n"); }),
              HasSubstr("none.png"));
}

}  // namespace
}  // namespace laterna
