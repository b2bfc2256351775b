#include "sim/scene_file.h"

#include "sim/device_spec.h"
#include "sim/error.h"
#include "sim/field_text.h"
#include "sim/ply.h"
#include "sim/self_contained.h"
#include "sim/shapes.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <numbers>

namespace laterna {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

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

const char* const mesh_line = "[[mesh]]\nshape = \"plane\"\n";
const char* const device_lines =
    "size = [640, 480]\nfx = 500\nposition = [0, 0, 2]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\n";

std::string with_mesh(const std::string& lines) { return "[[mesh]]\nshape = \"plane\"\n" + lines; }
std::string with_device(const std::string& lines) { return std::string(mesh_line) + "[[camera]]\n" + lines; }
std::string error_of(const std::string& text) {
  return testing::input_error([&] { parse_scene(text, "scene.toml"); });
}
/// The text with `from`, which must be there, replaced.
std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

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

TEST(SceneFile, IntrinsicsInExactlyOneWay) {
  const std::string lines = device_lines;
  EXPECT_THAT(
      error_of(with_device(lines + "throw_ratio = 1\n")),
      StartsWith("scene.toml:3: [[camera]]: intrinsics are given in two ways, by fx and by throw_ratio"));
  EXPECT_THAT(error_of(with_device(lines + "cameramodel = \"c\"\n")), HasSubstr("by fx and by cameramodel"));
  EXPECT_THAT(error_of(with_device(replaced(lines, "fx = 500", "fov_y_deg = 30\nfov_x_deg = 30"))),
              HasSubstr("by fov_y_deg and by fov_x_deg"));
  EXPECT_THAT(error_of(with_device(replaced(lines, "fx = 500\n", ""))), HasSubstr("intrinsics are missing"));
  EXPECT_THAT(error_of(with_device(replaced(lines, "fx = 500", "cx = 500"))),
              HasSubstr("cx is given without fx"));
  EXPECT_THAT(error_of(with_device(replaced(lines, "fx = 500", "lens_shift = [0, 1]"))),
              HasSubstr("lens_shift is given without throw_ratio"));
  EXPECT_THAT(error_of(with_device(lines + "aspect = 2\n")), HasSubstr("aspect is given without"));
  EXPECT_THAT(error_of(with_device(replaced(lines, "size = [640, 480]\n", ""))),
              HasSubstr("size is missing"));
  EXPECT_THAT(error_of(with_device("cameramodel = \"c\"\nsize = [1, 1]\n")),
              HasSubstr("size is given beside"));
  EXPECT_THAT(error_of(with_device("cameramodel = \"c\"\nlens = { parameters = [1] }\n")),
              HasSubstr("lens is given beside"));
}

TEST(SceneFile, PlacementInExactlyOneWay) {
  const std::string k = "size = [640, 480]\nfx = 500\n";
  EXPECT_THAT(error_of(with_device(k)), StartsWith("scene.toml:3: [[camera]]: placement is missing"));
  EXPECT_THAT(error_of(with_device(k + "position = [0, 0, 1]\n")),
              HasSubstr("position is given without look_at"));
  EXPECT_THAT(error_of(with_device(k + "look_at = [0, 0, 1]\n")),
              HasSubstr("look_at is given without position"));
  EXPECT_THAT(error_of(with_device(k + "quaternion_wxyz = [1, 0, 0, 0]\n")),
              HasSubstr("without translation"));
  EXPECT_THAT(error_of(with_device(std::string(device_lines) + "translation = [1, 0, 0]\n")),
              HasSubstr("translation is given without"));
  EXPECT_THAT(error_of(with_device(std::string(device_lines) + "rotation_vector_rad = [1, 0, 0]\n")),
              HasSubstr("placement is given in two ways, by position and by rotation_vector_rad"));
  EXPECT_THAT(error_of(with_device("cameramodel = \"c\"\nposition = [1, 0, 0]\nlook_at = [0, 0, 0]\n")),
              HasSubstr("by position and by cameramodel"));
}

TEST(SceneFile, PlacementsThatAreNone) {
  const std::string k = "size = [640, 480]\nfx = 500\n", camera = "scene.toml:3: [[camera]]: ";
  EXPECT_THAT(error_of(with_device(k + "device_from_world = [[1,0,0,0],[0,1,0,0],[0,0,1.1,0]]\n")),
              AllOf(StartsWith(camera), HasSubstr("device_from_world"), HasSubstr("no rotation")));
  EXPECT_THAT(error_of(with_device(k + "device_from_world = [[1,0,0,0],[0,1,0,0],[0,0,-1,0]]\n")),
              AllOf(StartsWith(camera), HasSubstr("reflection")));
  EXPECT_THAT(error_of(with_device(k + "position = [0,0,1]\nlook_at = [0,0,1]\n")),
              AllOf(StartsWith(camera), HasSubstr("look_at")));
  EXPECT_THAT(error_of(with_device(k + "position = [0,0,1]\nlook_at = [0,0,0]\n")), HasSubstr("parallel"));
  EXPECT_THAT(error_of(with_device(k + "position = [0,0,1]\nlook_at = [0,1,0]\nup = [0,0,0]\n")),
              HasSubstr("parallel"));
  for (const char* q : {"[0, 0, 0, 0]", "[1e-170, 0, 0, 0]"})
    EXPECT_THAT(error_of(with_device(k + "translation = [0,0,1]\nquaternion_wxyz = " + q + "\n")),
                StartsWith(camera));
}

TEST(SceneFile, UnusableDevices) {
  const std::string lines = device_lines, camera = "scene.toml:3: [[camera]]: ";
  EXPECT_EQ(error_of(with_device(lines + "near = 5\nfar = 1\n")),
            camera + "light planes: near is 5 and far is 1, expected near < far");
  EXPECT_THAT(error_of(with_device(lines + "near = 0\n")),
              StartsWith("scene.toml:9: near in [[camera]] is 0"));
  EXPECT_THAT(error_of(with_device(replaced(lines, "fx = 500", "fx = 0"))),
              StartsWith("scene.toml:5: fx in"));
  EXPECT_THAT(error_of(with_device(replaced(lines, "fx = 500", "fx = 1e-5"))),
              AllOf(StartsWith(camera), HasSubstr("singular")));
  EXPECT_THAT(error_of(with_device(replaced(lines, "fx = 500", "fov_x_deg = 180"))),
              HasSubstr("fov_x_deg in"));
  EXPECT_THAT(error_of(with_device(lines + "lens = { model = \"FISH\" }\n")),
              AllOf(StartsWith(camera), HasSubstr("\"FISH\"")));
  EXPECT_THAT(error_of(with_device(lines + "lens = { model = \"LENSMODEL_OPENCV4\", parameters = [1] }\n")),
              AllOf(StartsWith(camera), HasSubstr("found 1 parameters, expected 4")));
  // mrcal itself would abort on this one.
  EXPECT_THAT(
      error_of(with_device(
          lines +
          "lens = { model = \"LENSMODEL_SPLINED_STEREOGRAPHIC_order=5_Nx=4_Ny=4_fov_x_deg=100\" }\n")),
      AllOf(StartsWith(camera), HasSubstr("expected order 2 or 3")));
  EXPECT_THAT(error_of(with_device(lines + "sensor = { bit_depth = 17 }\n")),
              StartsWith("scene.toml:9: bit_depth in sensor of [[camera]] is 17"));
}

TEST(SceneFile, NamesOfDevicesAreUnique) {
  const std::string camera = std::string("[[camera]]\n") + device_lines;
  const SceneSpec two = with_names(parse_scene(with_mesh(camera + camera), "s"));
  EXPECT_EQ(two.cameras[0].device.name, "camera1");
  EXPECT_EQ(two.cameras[1].device.name, "camera2");
  EXPECT_EQ(with_names(parse_scene(with_mesh(camera), "s")).cameras[0].device.name, "camera");
  const std::string named = camera + "name = \"a\"\n";
  EXPECT_EQ(error_of(with_mesh(named + named)),
            "scene.toml: [[camera]] \"a\": the name is taken by another device, expected one of its own");
  EXPECT_THAT(error_of(with_mesh(named + replaced(named, "camera", "projector"))), HasSubstr("taken"));
  EXPECT_THAT(error_of(with_mesh(camera + camera + "name = \"camera1\"\n")), HasSubstr("taken"));
}

TEST(SceneFile, WaysToSayTheSameDevice) {
  const auto device = [](const std::string& intrinsics, const std::string& placement) {
    const std::string text = with_device("size = [641, 481]\n" + intrinsics + placement);
    return device_of(parse_scene(text, "s").cameras[0].device, {}, "camera");
  };
  const std::string looking = "position = [0, -2, 0]\nlook_at = [0, 0, 0]\n";
  // tan 45° = 1: fx = W/2. The world's z is up, so that y of the device is -z.
  const Device reference =
      device("fx = 320.5\ncx = 320\ncy = 240\n", "device_from_world = [[1,0,0,0],[0,0,-1,0],[0,1,0,2]]\n");
  const std::string rotation_by_hand =
      "rotation_vector_rad = [1.5707963267948966, 0, 0]\ntranslation = [0, 0, 2]\n";
  for (const Device& other :
       {device("fx = 320.5\n", looking), device("throw_ratio = 0.5\n", looking),
        device("fov_x_deg = 90\n", looking),
        device("fov_y_deg = 73.7683931346247\naspect = 1.3326403326403327\n", rotation_by_hand),
        device("fx = 320.5\n", "quaternion_wxyz = [3, 3, 0, 0]\ntranslation = [0, 0, 2]\n")}) {
    // 1e-8: the vertical angle above is given to 12 digits.
    EXPECT_NEAR(other.intrinsics.fx, reference.intrinsics.fx, 1e-8);
    EXPECT_NEAR(other.intrinsics.fy, reference.intrinsics.fy, 1e-8);
    EXPECT_NEAR(other.intrinsics.cx, 320, 1e-12);
    EXPECT_NEAR(other.intrinsics.cy, 240, 1e-12);
    for (int i = 0; i < 3; ++i) {
      // 1e-15: a few roundings of numbers near 1.
      EXPECT_NEAR(glm::distance(other.device_from_world.rotation[i], reference.device_from_world.rotation[i]),
                  0, 1e-15);
    }
    EXPECT_NEAR(glm::distance(other.device_from_world.translation, glm::dvec3(0, 0, 2)), 0, 1e-15);
  }
}

TEST(SceneFile, FileToWorldByHand) {
  MeshSpec mesh{.file = "x.ply"};
  const auto moved = [&](const glm::dvec3& p) {
    return glm::dvec3(world_from_file(mesh) * glm::dvec4(p, 1));
  };
  EXPECT_EQ(moved({1, 2, 3}), glm::dvec3(1, 2, 3));
  mesh.up = UpAxis::y;
  EXPECT_EQ(moved({1, 2, 3}), glm::dvec3(1, -3, 2));
  mesh.unit = "mm";
  mesh.scale = 2000;
  EXPECT_NEAR(glm::distance(moved({1, 2, 3}), glm::dvec3(2, -6, 4)), 0, 1e-14);  // rounding
  mesh.translate = {10, 20, 30};
  EXPECT_NEAR(glm::distance(moved({1, 2, 3}), glm::dvec3(12, 14, 34)), 0, 1e-14);
  mesh = {.file = "x.ply", .rotate_deg = {90, 0, 90}};  // x → y; y → z; z → x: x first, z last
  EXPECT_NEAR(glm::distance(moved({1, 0, 0}), glm::dvec3(0, 1, 0)), 0, 1e-15);
  EXPECT_NEAR(glm::distance(moved({0, 1, 0}), glm::dvec3(0, 0, 1)), 0, 1e-15);
  EXPECT_NEAR(glm::distance(moved({0, 0, 1}), glm::dvec3(1, 0, 0)), 0, 1e-15);
  mesh = {.file = "x.ply",
          .unit = "mm",
          .world_from_object = Matrix3x4{{{0, 2, 0, 5}, {1, 0, 0, 6}, {0, 0, 1, 7}}}};
  EXPECT_NEAR(glm::distance(moved({1000, 2000, 3000}), glm::dvec3(9, 7, 10)), 0, 1e-14);
}

TEST(SceneFile, BytesThatNoParserShouldSee) {
  EXPECT_THAT(error_of(std::string("ambient_lx = 1\nname = \"a\0b\"", 27)),
              AllOf(StartsWith("scene.toml:2: "), HasSubstr("0x00")));
  EXPECT_THAT(error_of("name = \"\xff\"\n"), AllOf(StartsWith("scene.toml:1: "), HasSubstr("UTF-8")));
  EXPECT_THAT(error_of("name = \"\xc0\xaf\"\n"), HasSubstr("UTF-8"));  // overlong
  for (const char* deep : {"[", "{a=", "[{a="}) {
    std::string text = "\nmesh = ";
    for (int i = 0; i < 100000; ++i) text += deep;
    EXPECT_THAT(error_of(text), AllOf(StartsWith("scene.toml:2: "), HasSubstr("nest deeper than 64")));
  }
  std::string dotted = "a";
  for (int i = 0; i < 100000; ++i) dotted += ".a";
  for (const std::string& text : {dotted + " = 1\n", "[" + dotted + "]\n", "a = { " + dotted + " = 1 }\n"})
    EXPECT_THAT(error_of(text), HasSubstr("nest deeper than 64"));
  EXPECT_THAT(error_of(std::string(17 << 20, ' ')), HasSubstr("expected at most"));
}

TEST(SceneFile, BracketsAndDotsInTextAreOnlyText) {
  const std::string many = std::string(200, '[') + std::string(200, '.');
  const std::string text = "# " + many + "\nname = \"" + many + "\" # " + many + "\n" +
                           with_mesh("name = '''" + many.substr(170, 60) + "'''\n");
  EXPECT_EQ(parse_scene(text, "s").name, many);
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

TEST(SceneFile, BuildLoadsMeshesBesideTheScene) {
  const testing::ScratchFolder folder;
  const Mesh plane = make_shape({.shape = "plane", .detail = 2});
  testing::write_text(folder / "scene.ply", ply_bytes(plane));
  const Scene scene = load_scene(testing::write_text(folder / "scene.toml", fixed_keys));
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.objects[0].name, "scene");
  EXPECT_EQ(scene.objects[0].mesh.positions, plane.positions);
  EXPECT_EQ(scene.objects[0].world_from_object, glm::dmat4(1.0));
  EXPECT_EQ(scene.projectors.at(0).device.name, "left");
  EXPECT_TRUE(scene.cameras.empty());
}

TEST(SceneFile, BuildRefusesBadFiles) {
  const testing::ScratchFolder folder;
  const auto load_error = [&](const std::string& text) {
    const auto path = testing::write_text(folder / "scene.toml", text);
    return testing::input_error([&] { load_scene(path); });
  };
  EXPECT_THAT(load_error("[[mesh]]\nfile = \"none.ply\"\n"),
              AllOf(StartsWith((folder / "scene.toml").string()), HasSubstr("[[mesh]] \"none\""),
                    HasSubstr("none.ply")));
  testing::write_text(folder / "broken.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
  EXPECT_THAT(load_error("[[mesh]]\nfile = \"broken.ply\"\n"), HasSubstr("broken.ply"));
  EXPECT_THAT(load_error("[[mesh]]\nfile = \".\"\n"), HasSubstr("[[mesh]]"));
  EXPECT_THAT(load_error("[[mesh]]\nshape = \"torus\"\n"), HasSubstr("torus"));
  EXPECT_THAT(load_error(with_mesh("albedo_map = \"none.png\"\n")), HasSubstr("none.png"));
  EXPECT_THAT(load_error(with_mesh("translate = [1e9, 0, 0]\n")), HasSubstr("a vertex comes to lie"));
  EXPECT_THAT(load_error(with_device("cameramodel = \"none.cameramodel\"\n")),
              AllOf(HasSubstr("[[camera]] \"camera\""), HasSubstr("none.cameramodel")));
  EXPECT_THAT(testing::input_error([&] { load_scene(folder / "none.toml"); }),
              StartsWith((folder / "none.toml").string() + ": cannot be opened: No such file"));
  EXPECT_THAT(testing::input_error([&] { load_scene(folder.path()); }), HasSubstr("it is a folder"));
}

TEST(SceneFile, AlbedoMapsAreLinearAndShared) {
  const testing::ScratchFolder folder;
  write_picture(folder / "map.png", Image<std::uint8_t>(4, 2, 188));
  const std::string mapped = with_mesh("albedo_map = \"map.png\"\n");
  const auto path = testing::write_text(folder / "scene.toml",
                                        mapped + mapped + mapped + "albedo_map_encoding = \"linear\"\n");
  const Scene scene = load_scene(path);
  const auto value = [&](int i) { return (*scene.objects.at(i).albedo_map)(3, 1); };
  // ((188/255 + 0.055)/1.055)^2.4 by hand; 1e-6: floats.
  EXPECT_NEAR(value(0), 0.502886, 1e-6);
  EXPECT_NEAR(value(2), 188 / 255.0, 1e-6);
  EXPECT_EQ(scene.objects[0].albedo_map, scene.objects[1].albedo_map);
  write_picture(folder / "map.exr", Image<float>(4, 2, 1.5f));
  const auto bright = testing::write_text(folder / "b.toml", with_mesh("albedo_map = \"map.exr\"\n"));
  EXPECT_THAT(testing::input_error([&] { load_scene(bright); }),
              HasSubstr("a pixel is 1.5, expected 0 to 1"));
}

TEST(SceneFile, AlbedoMapsNeedTextureCoordinates) {
  const testing::ScratchFolder folder;
  write_picture(folder / "map.png", Image<std::uint8_t>(4, 2, 188));
  Mesh plane = make_shape({.shape = "plane", .size = {1, 1, 1}, .detail = 2});
  plane.texture_coordinates.clear();
  testing::write_text(folder / "a.ply", ply_bytes(plane));
  const auto path =
      testing::write_text(folder / "s.toml", "[[mesh]]\nfile = \"a.ply\"\nalbedo_map = \"map.png\"\n");
  EXPECT_THAT(testing::input_error([&] { load_scene(path); }), HasSubstr("has no texture coordinates"));
}

TEST(SceneFile, BuildChecksASpecificationMadeInCode) {
  SceneSpec spec;
  spec.meshes.push_back({.shape = "plane"});
  spec.cameras.push_back({.device = {.size = glm::ivec2(10, 10),
                                     .fx = std::nan(""),
                                     .position = glm::dvec3(1),
                                     .look_at = glm::dvec3(0)},
                          .sensor = {}});
  EXPECT_THAT(testing::input_error([&] { build_scene(spec, {}); }),
              StartsWith("[[camera]] \"camera\": intrinsics"));
}

TEST(SceneFile, ASelfContainedCopyCanBeMoved) {
  const testing::ScratchFolder folder;
  std::filesystem::create_directories(folder / "from/sub");
  std::filesystem::create_directories(folder / "to");
  testing::write_text(folder / "from/sub/a.ply", ply_bytes(make_shape({.shape = "sphere", .detail = 3})));
  testing::write_text(folder / "from/c.cameramodel",
                      "{ 'lensmodel': 'LENSMODEL_PINHOLE', 'intrinsics': [500, 510, 320.25, 240.125],\n"
                      "'extrinsics': [0.1, 0.2, 0.3, 1, 2, 3], 'imagersize': [640, 480] }\n");
  const auto path = testing::write_text(folder / "from/scene.toml",
                                        "[[mesh]]\nfile = \"sub/a.ply\"\nunit = \"cm\"\nup = \"y\"\n" +
                                            with_device("cameramodel = \"c.cameramodel\"\n"));
  const Scene original = load_scene(path);
  const SceneSpec spec = read_scene_spec(path);
  const SceneSpec copied = write_self_contained(spec, original, path.parent_path(), folder / "to");
  EXPECT_EQ(read_scene_spec(folder / "to/scene.toml"), copied);
  std::filesystem::remove_all(folder / "from");
  std::filesystem::rename(folder / "to", folder / "moved");
  const Scene moved = load_scene(folder / "moved/scene.toml");
  ASSERT_EQ(moved.objects.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(moved.objects[i].name, original.objects[i].name);
    EXPECT_EQ(moved.objects[i].mesh.positions, original.objects[i].mesh.positions);
    EXPECT_EQ(moved.objects[i].mesh.triangles, original.objects[i].mesh.triangles);
    EXPECT_EQ(moved.objects[i].world_from_object, original.objects[i].world_from_object);
  }
  EXPECT_EQ(moved.cameras.at(0).device.device_from_world.rotation,
            original.cameras.at(0).device.device_from_world.rotation);
  EXPECT_EQ(moved.cameras[0].device.intrinsics.cy, 240.125);
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
