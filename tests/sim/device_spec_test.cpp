#include "sim/device_spec.h"

#include "tests/sim/scene_text.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::AllOf;
using testing::device_lines;
using testing::error_of;
using ::testing::HasSubstr;
using testing::replaced;
using ::testing::StartsWith;
using testing::with_device;
using testing::with_mesh;

TEST(DeviceSpec, IntrinsicsInExactlyOneWay) {
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

TEST(DeviceSpec, PlacementInExactlyOneWay) {
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

TEST(DeviceSpec, PlacementsThatAreNone) {
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

TEST(DeviceSpec, UnusableDevices) {
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

TEST(DeviceSpec, NamesOfDevicesAreUnique) {
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

TEST(DeviceSpec, WaysToSayTheSameDevice) {
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

}  // namespace
}  // namespace laterna
