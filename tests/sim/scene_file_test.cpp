#include "sim/scene_file.h"

#include "sim/device_spec.h"
#include "sim/error.h"
#include "sim/field_text.h"
#include "tests/sim/scene_text.h"

#include <gmock/gmock.h>

#include <cmath>

namespace laterna {
namespace {

using ::testing::AllOf;
using testing::device_lines;
using testing::error_of;
using ::testing::HasSubstr;
using testing::mesh_line;
using testing::replaced;
using ::testing::StartsWith;
using testing::with_device;
using testing::with_mesh;

// The issue's own example: its keys are fixed. The `file` is on line 2.
const char* const fixed_keys = R"([[mesh]]
file = "scene.ply"
world_from_object = [[1,0,0,0],[0,1,0,0],[0,0,1,0]]
albedo = 0.8
[[projector]]
name = "left"
size = [1920, 1080]
fx = 2842.98
fy = 2844.47
cx = 958.83
cy = 1096.37
device_from_world = [[1,0,0,0],[0,-1,0,0],[0,0,-1,1.2]]
lens = { model = "LENSMODEL_OPENCV4", parameters = [0.0, 0.0, 0.0, 0.0] }
near = 0.1
far = 20.0
[patterns]
kind = "gray"
)";

TEST(SceneFile, FixedKeysAreReadAsTheyStand) {
  const SceneSpec scene = parse_scene(fixed_keys, "scene.toml");
  ASSERT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.meshes[0].file, "scene.ply");
  EXPECT_EQ(scene.meshes[0].albedo, 0.8);
  EXPECT_EQ(scene.meshes[0].world_from_object.value_or(Matrix3x4{})[2], (std::array<double, 4>{0, 0, 1, 0}));
  ASSERT_EQ(scene.projectors.size(), 1u);
  const Device device = device_of(scene.projectors[0].device, {}, "projector");
  EXPECT_EQ(device.name, "left");
  EXPECT_EQ(device.intrinsics.size, glm::ivec2(1920, 1080));
  EXPECT_EQ(device.intrinsics.fx, 2842.98);
  EXPECT_EQ(device.intrinsics.fy, 2844.47);
  EXPECT_EQ(device.intrinsics.cx, 958.83);
  EXPECT_EQ(device.intrinsics.cy, 1096.37);
  EXPECT_EQ(device.device_from_world.rotation[1], glm::dvec3(0, -1, 0));
  EXPECT_EQ(device.device_from_world.translation, glm::dvec3(0, 0, 1.2));
  EXPECT_EQ(device.lens.model, "LENSMODEL_OPENCV4");
  EXPECT_EQ(device.lens.parameters.size(), 4u);
  EXPECT_EQ(device.planes.near_m, 0.1);
  EXPECT_EQ(device.planes.far_m, 20.0);
  EXPECT_EQ(scene.patterns.parameters.kind, PatternKind::gray);
}

TEST(SceneFile, AMeshAloneIsAScene) {
  const SceneSpec scene = parse_scene(mesh_line, "scene.toml");
  EXPECT_EQ(scene.meshes[0], (MeshSpec{.shape = "plane"}));
  EXPECT_TRUE(scene.projectors.empty());
}

TEST(SceneFile, IntegersStandForNumbers) {
  const SceneSpec scene =
      parse_scene("ambient_lx = 3\n" + with_mesh("translate = [1, 2, 3.5]\nalbedo = 1\n"), "s");
  EXPECT_EQ(scene.ambient_lx, 3.0);
  EXPECT_EQ(scene.meshes[0].translate, glm::dvec3(1, 2, 3.5));
  EXPECT_EQ(scene.meshes[0].albedo, 1.0);
}

TEST(SceneFile, EveryFieldSurvivesWritingAndReading) {
  auto random = testing::generator();
  std::uniform_real_distribution<double> uniform(0.1, 0.9);
  const auto number = [&] { return uniform(random); };
  for (int i = 0; i < 20; ++i) {
    SceneSpec scene;
    scene.name = "quotes \" back\\slash and ünïcode";
    scene.ambient_lx = number();
    scene.meshes.push_back({.name = "a",
                            .file = "dir/x.ply",
                            .unit = "mm",
                            .up = UpAxis::y,
                            .scale = number(),
                            .rotate_deg = {number(), -number(), number()},
                            .translate = {number(), 1e9, -number()},
                            .albedo = number(),
                            .albedo_map = "m.png"});
    scene.meshes.push_back(
        {.shape = "relief",
         .shape_size = {number(), number(), number()},
         .detail = 3,
         .seed = random() >> 1,
         .world_from_object = Matrix3x4{{{number(), 0, 0, -0.0}, {0, number(), 0, 1}, {0, 0, 2, 3}}}});
    ProjectorSpec projector{.device = {.name = "p",
                                       .size = glm::ivec2(3, 4),
                                       .throw_ratio = number(),
                                       .lens_shift = glm::dvec2(number(), -number()),
                                       .rotation_vector_rad = glm::dvec3(number(), number(), number()),
                                       .translation = glm::dvec3(number()),
                                       .near_m = number(),
                                       .far_m = 1 + number()},
                            .flux_lm = number(),
                            .lookup = Lookup::bilinear,
                            .border = Border::clamp};
    scene.projectors.push_back(projector);
    projector.device.name = "q";
    projector.device.throw_ratio.reset();
    projector.device.lens_shift.reset();
    projector.device.fx = 100 + number();
    projector.device.lens = {"LENSMODEL_OPENCV4", {number() / 100, 0.0, -0.0, 1e-300}};
    projector.device.rotation_vector_rad.reset();
    projector.device.quaternion_wxyz = glm::dvec4(number(), number(), number(), number());
    scene.projectors.push_back(projector);
    CameraSpec camera{
        .device = {.size = glm::ivec2(5, 6),
                   .fov_x_deg = 50 * number(),
                   .aspect = number(),
                   .position = glm::dvec3(number()),
                   .look_at = glm::dvec3(-number(), 0, 0),
                   .up = glm::dvec3(0, number(), 0)},
        .sensor = {.bit_depth = 12, .noise_sigma_dn = number(), .saturation_cd_per_m2 = number()}};
    scene.cameras.push_back(camera);
    scene.cameras.push_back({.device = {.cameramodel = "x.cameramodel"}, .sensor = {}});
    const std::string text = scene_toml(scene);
    const SceneSpec read = parse_scene(text, "scene.toml");
    EXPECT_EQ(read, scene) << text;
    EXPECT_EQ(scene_toml(read), text);  // tells 0.0 and -0.0 apart, which == does not
  }
}

TEST(SceneFile, DefaultsAreLeftOut) {
  const std::string text = scene_toml(parse_scene(with_device(device_lines), "s"));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("albedo")));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("sensor")));
  EXPECT_THAT(text, HasSubstr("[[camera]]\nsize = [640, 480]\nfx = 500.0\n"));
}

TEST(SceneFile, UnknownKeysNameTheNearestKnownOne) {
  EXPECT_EQ(error_of(with_mesh("albdo = 0.5\n")),
            "scene.toml:3: unknown key \"albdo\" in [[mesh]], did you mean \"albedo\"?");
  EXPECT_EQ(error_of("[[meshes]]\nshape = \"plane\"\n"),
            "scene.toml:1: unknown key \"meshes\" at the top level, did you mean \"mesh\"?");
  EXPECT_EQ(error_of(with_device(std::string(device_lines) + "lens = { modell = \"x\" }\n")),
            "scene.toml:9: unknown key \"modell\" in lens of [[camera]], did you mean \"model\"?");
  EXPECT_EQ(error_of("[patterns]\nknd = 1\n"),
            "scene.toml:2: unknown key \"knd\" in [patterns], did you mean \"kind\"?");
}

TEST(SceneFile, WrongTypesNameWhatWasFoundAndExpected) {
  EXPECT_EQ(error_of(with_mesh("albedo = \"white\"\n")),
            "scene.toml:3: albedo in [[mesh]] is the string \"white\", expected a number (0 to 1)");
  EXPECT_EQ(error_of(with_mesh("file = 3\n")), "scene.toml:3: file in [[mesh]] is 3, expected a string");
  EXPECT_EQ(error_of(with_mesh("detail = 8.5\n")),
            "scene.toml:3: detail in [[mesh]] is 8.5, expected an integer (1 to 4096)");
  EXPECT_EQ(error_of(with_mesh("up = \"x\"\n")),
            "scene.toml:3: up in [[mesh]] is the string \"x\", expected one of \"y\", \"z\"");
  EXPECT_EQ(error_of(with_mesh("translate = [1, 2]\n")),
            "scene.toml:3: translate in [[mesh]] is [1, 2], expected 3 numbers (-1e+09 to 1e+09)");
  EXPECT_EQ(error_of(with_mesh("world_from_object = [[1,0,0,0],[0,1,0,0],[0,0,1]]\n")),
            "scene.toml:3: world_from_object in [[mesh]] is an array of 3, expected 3 rows of 4 numbers "
            "(-1e+09 to 1e+09)");
  EXPECT_EQ(error_of(with_mesh("name = 1979-05-27\n")),
            "scene.toml:3: name in [[mesh]] is a date or time, expected a string");
  EXPECT_EQ(error_of("[mesh]\nshape = \"plane\"\n"), "scene.toml:1: [mesh] is one table, expected [[mesh]]");
  EXPECT_EQ(error_of("mesh = 3\n"), "scene.toml:1: mesh at the top level is 3, expected an array of tables");
  EXPECT_EQ(error_of("patterns = \"gray\"\n"),
            "scene.toml:1: patterns at the top level is the string \"gray\", expected a table");
  EXPECT_EQ(error_of("[patterns]\nkind = \"grey\"\n"),
            "scene.toml:2: kind in [patterns] is the string \"grey\", expected one of \"gray\", \"slide\", "
            "\"gray_phase\", \"phase\", \"multi_frequency\", \"micro_phase\", \"xor_gray\", \"chessboard\", "
            "\"charuco\", \"pictures\"");
}

TEST(SceneFile, NumbersOutOfRangeOrNotFinite) {
  EXPECT_EQ(error_of(with_mesh("albedo = 1.5\n")),
            "scene.toml:3: albedo in [[mesh]] is 1.5, expected a number (0 to 1)");
  for (const char* number : {"nan", "inf", "-inf", "+nan", "1e300"}) {
    EXPECT_THAT(error_of(with_mesh(std::string("translate = [0, 0, ") + number + "]\n")),
                StartsWith("scene.toml:3: translate in [[mesh]] is [0, 0, "));
    EXPECT_THAT(error_of(with_mesh(std::string("scale = ") + number + "\n")),
                StartsWith("scene.toml:3: scale in [[mesh]] is "));
  }
  EXPECT_THAT(error_of(with_mesh("seed = -1\n")),
              StartsWith("scene.toml:3: seed in [[mesh]] is -1, expected"));
  for (const char* number : {"99999999999999999999", "1e999", "4294967297"})
    EXPECT_THAT(error_of(with_mesh(std::string("detail = ") + number + "\n")), StartsWith("scene.toml:3: "));
  for (const char* number : {"0", "-5", "16385", "1000000000000"}) {
    EXPECT_THAT(error_of(with_device(replaced(device_lines, "640", number))),
                AllOf(StartsWith("scene.toml:4: size in [[camera]] is ["), HasSubstr("1 to 16384")));
  }
}

TEST(SceneFile, MeshesNeedOneSource) {
  EXPECT_EQ(error_of(""), "scene.toml: there is no [[mesh]], expected at least one");
  EXPECT_EQ(error_of("[[mesh]]\nname = \"a\"\n"),
            "scene.toml:1: [[mesh]] \"a\": 0 of file, shape and board are given, expected one");
  EXPECT_THAT(error_of(with_mesh("file = \"a.ply\"\n")), HasSubstr("2 of file, shape and board"));
  EXPECT_THAT(error_of(with_mesh("unit = \"yard\"\n")),
              AllOf(StartsWith("scene.toml:1: "), HasSubstr("yard")));
}

TEST(SceneFile, MeshPlacementInOneWay) {
  const std::string identity = "world_from_object = [[1,0,0,0],[0,1,0,0],[0,0,1,0]]\n";
  EXPECT_THAT(error_of(with_mesh(identity + "scale = 2\n")),
              HasSubstr("beside scale, rotate_deg or translate"));
  EXPECT_THAT(error_of(with_mesh("world_from_object = [[1,0,0,0],[0,1,0,0],[1,1,0,0]]\n")),
              AllOf(StartsWith("scene.toml:1: [[mesh]]"), HasSubstr("singular")));
  EXPECT_THAT(error_of(with_mesh("world_from_object = [[0,0,0,0],[0,0,0,0],[0,0,0,0]]\n")),
              HasSubstr("singular"));
}

TEST(SceneFile, SyntaxErrorsHaveALine) {
  EXPECT_THAT(error_of("ambient_lx = 1\nname = \n"), StartsWith("scene.toml:2: "));
  EXPECT_THAT(error_of("name = \"a\"\nname = \"b\"\n"), StartsWith("scene.toml:2: "));
  EXPECT_THAT(error_of("name = \"a\n"), StartsWith("scene.toml:1: "));
}

TEST(SceneFile, BytesFlippedAtRandomAreReadOrRefused) {
  auto random = testing::generator();
  // A pinhole: searching where a lens folds over would take most of the time.
  const std::string pinhole =
      replaced(replaced(fixed_keys, "OPENCV4", "PINHOLE"), "[0.0, 0.0, 0.0, 0.0]", "[]");
  const std::string whole = pinhole + "[[camera]]\n" + device_lines + "sensor = { bit_depth = 8 }\n";
  int read = 0, refused = 0;
  for (int i = 0; i < 4000; ++i) {
    std::string text = whole;
    for (int flips = 1 + int(random() % 3); flips > 0; --flips) {
      const std::size_t at = random() % text.size();
      switch (random() % 5) {
        case 0:
          text[at] = char(random());
          break;
        case 1:
          text[at] = char(32 + random() % 95);
          break;
        case 2:
          text.erase(at, 1 + random() % 8);
          break;
        case 3:
          if (text[at] >= '0' && text[at] <= '9') text[at] = char('0' + random() % 10);
          break;
        default:
          text.insert(at, text.substr(random() % text.size(), random() % 12));
      }
    }
    try {
      parse_scene(text, "scene.toml");
      ++read;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), StartsWith("scene.toml"));
      ++refused;
    }
  }
  EXPECT_GT(read, 100);  // digits and names may change
  EXPECT_GT(refused, 1000);
}

TEST(SceneFile, OverridesSetKeysByPath) {
  const std::string text =
      "[[mesh]]\nshape = \"plane\"\n[[mesh]]\nshape = \"box\"\n[[camera]]\nsize = [8, 6]\nfx = 9\nposition = "
      "[0, 0, 1]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\n";
  const auto with = [&](const std::vector<std::string>& overrides) {
    return parse_scene(text, "s.toml", overrides);
  };
  EXPECT_EQ(with({"ambient_lx=3"}).ambient_lx, 3);
  EXPECT_EQ(with({"mesh.albedo=0.25"}).meshes[0].albedo, 0.25);
  EXPECT_EQ(with({"mesh.1.albedo=0.25"}).meshes[1].albedo, 0.25);
  EXPECT_EQ(with({"mesh.1.albedo=0.25", "mesh.1.albedo=0.5"}).meshes[1].albedo, 0.5);
  EXPECT_EQ(with({"camera.sensor.bit_depth=12"}).cameras[0].sensor.bit_depth, 12);
  EXPECT_EQ(with({"patterns.kind=\"gray_phase\""}).patterns.parameters.kind, PatternKind::gray_phase);
  EXPECT_EQ(with({"mesh.translate=[1,2,3]"}).meshes[0].translate, glm::dvec3(1, 2, 3));
  EXPECT_EQ(with({}), parse_scene(text, "s.toml"));
}

TEST(SceneFile, BadOverridesAreNamed) {
  const std::string text = "[[mesh]]\nshape = \"plane\"\n";
  const auto says = [&](const std::string& override) {
    return testing::input_error([&] { parse_scene(text, "s.toml", {override}); });
  };
  EXPECT_THAT(says("ambient_lx"), ::testing::HasSubstr("expected KEY=VALUE"));
  EXPECT_THAT(says("ambient_lx="), ::testing::StartsWith("--set ambient_lx: \"\" is no TOML value: "));
  EXPECT_THAT(says("mesh..albedo=1"), ::testing::HasSubstr("single dots"));
  EXPECT_THAT(says("mesh.1.albedo=1"), ::testing::HasSubstr("mesh has 1 entries"));
  EXPECT_THAT(says("mesh.shape.x=1"), ::testing::HasSubstr("shape is no table"));
  EXPECT_EQ(says("mesh.albdo=1"),
            "--set mesh.albdo: unknown key \"albdo\" in [[mesh]], did you mean \"albedo\"?");
  EXPECT_THAT(says("mesh.albedo=7"), ::testing::StartsWith("--set mesh.albedo: albedo in [[mesh]] is 7, "));
  EXPECT_THAT(says("mesh.albedo=seven"),
              ::testing::StartsWith("--set mesh.albedo: \"seven\" is no TOML value: "));
  EXPECT_THAT(says("mesh={ shape = \"plane\", albedo = 7 }"), ::testing::StartsWith("--set mesh: "));
  EXPECT_THAT(says("timming.fps=60"), ::testing::StartsWith("--set timming.fps: unknown key \"timming\""));
  EXPECT_FALSE(says("a=" + std::string(5000, '[')).empty());
}

}  // namespace
}  // namespace laterna
