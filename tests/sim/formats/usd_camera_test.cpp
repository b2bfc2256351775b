#include "sim/formats/usd_camera.h"

#include "sim/formats/rig_file.h"
#include "tests/sim/formats/rigs.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using testing::rig_pixel;

const char* const by_hand = R"(#usda 1.0
(
    metersPerUnit = 0.01
    upAxis = "Y"
)

def Xform "rig" (
    kind = "group"
)
{
    matrix4d xformOp:transform = ( (1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1) )
    uniform token[] xformOpOrder = ["xformOp:transform"]

    def Camera "eye"  # a note
    {
        float2 clippingRange = (0.1, 1000)
        float focalLength = 50
        float horizontalAperture = 25
        float verticalAperture = 20
        float horizontalApertureOffset = 5
        float verticalApertureOffset = 2
        matrix4d xformOp:transform = ( (1, 0, 0, 0), (0, 1, 0, 0),
                                       (0, 0, 1, 0), (0, 0, 200, 1) )
        uniform token[] xformOpOrder = ["xformOp:transform"]
    }
}
)";

TEST(UsdCamera, ReadsAStageByHand) {
  const testing::ScratchFolder folder;
  const Rig rig = read_rig(testing::write_text(folder / "c.usda", by_hand), {"", 1, {640, 480}, {0, 0}});
  // As in glTF's test the camera stands at the world's (0, -2, 0), looks along +y, up is +z: (0.1, -1, 0.2)
  // is 1 m ahead, 0.1 right, 0.2 up. The window goes from 5 - 12.5 to 5 + 12.5 of 50 in x, from 2 - 10 to 2 +
  // 10 in y: x = 0.1·50 = 5 is its middle, y = 0.2·50 = 10 is 2 below its upper edge at 12, of 20.
  EXPECT_PIXEL(rig_pixel(rig, "eye", {0.1, -1, 0.2}), 319.5, 2 / 20.0 * 480 - 0.5);
}

// As other tools write: operations one by one.
const char* const by_operations = R"(#usda 1.0
(
    metersPerUnit = 0.001
    upAxis = "Z"
)
def Camera "eye"
{
    float focalLength = 50
    float horizontalAperture = 25
    float verticalAperture = 20
    double3 xformOp:translate = (1000, 2000, 3000)
    double3 xformOp:translate:pivot = (0, 0, 500)
    float3 xformOp:rotateXYZ = (90, 0, 90)
    float3 xformOp:scale = (1, 1, 1)
    quatf xformOp:orient = (0, 1, 0, 0)
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:translate:pivot", "xformOp:rotateXYZ", "xformOp:scale", "!invert!xformOp:translate:pivot"]
}
)";

TEST(UsdCamera, OperationsActFromTheLastToTheFirst) {
  const Rig rig = parse_usd_cameras(by_operations, {640, 480}, "c.usda");
  // Rx(90) takes the camera's right, up and back (x, y, z) to x, z, -y; Rz(90) on to y, z, x. So it looks
  // along the world's -x, right is +y, up is +z. The pivot (0, 0, 0.5) m: it is taken off, turned to
  // (-0.5)·x, and put on along z: the camera stands at (1, 2, 3) + (0, 0, 0.5) - (0.5, 0, 0) = (0.5, 2, 3.5).
  // orient is not in the list.
  const Device eye = testing::device_called(rig, "eye");
  EXPECT_LT(glm::distance(center_in_world(eye.device_from_world), glm::dvec3(0.5, 2, 3.5)), 1e-12);
  // 1 m ahead, 0.1 right, 0.2 up: fx = 50/25·640, fy = 50/20·480.
  EXPECT_PIXEL(rig_pixel(rig, "eye", {-0.5, 2.1, 3.7}), 319.5 + 1280 * 0.1, 239.5 - 1200 * 0.2);
  std::string scaled = by_operations;
  scaled.replace(scaled.find("(1, 1, 1)"), 9, "(2, 2, 2)");
  EXPECT_THAT(testing::input_error([&] {
                parse_usd_cameras(scaled, {640, 480}, "c.usda");
              }),
              HasSubstr("c.usda: eye: xformOp:scale: expected a translation"));
  std::string turned = by_operations;
  turned.replace(turned.find("[\"xformOp:translate\""), 20, "[\"xformOp:orient\"");
  // Half a turn about x as a quaternion instead of the translation: (x, y, z) to (x, -y, -z).
  const Device other = testing::device_called(parse_usd_cameras(turned, {640, 480}, "c.usda"), "eye");
  EXPECT_LT(glm::distance(center_in_world(other.device_from_world), glm::dvec3(-0.5, 0, -0.5)), 1e-12);
}

TEST(UsdCamera, SurvivesARoundTrip) {
  auto random = testing::generator();
  const Rig rig = testing::random_pair(random, "LENSMODEL_OPENCV8", 8);
  Notes notes;
  // Apertures are ratios, and a motion is turned round twice: some roundings of a thousand pixels.
  testing::expect_same(parse_usd_cameras(usd_camera_text(rig, notes), {0, 0}, "x"), rig, 1e-14);
  EXPECT_EQ(notes.size(), 2u);
}

TEST(UsdCamera, BadFiles) {
  const auto error_of = [](const std::string& from, const std::string& to) {
    std::string text = by_hand;
    text.replace(text.find(from), from.size(), to);
    return testing::input_error([&] { parse_usd_cameras(text, {640, 480}, "c.usda"); });
  };
  EXPECT_THAT(error_of("#usda", "#usdc"), HasSubstr("c.usda:1: found no #usda"));
  EXPECT_THAT(error_of("(0, 0, 200, 1)", "(0, 0, 200, 2)"), HasSubstr("last column"));
  EXPECT_THAT(error_of("(0, 0, 1, 0), (0, 0, 200", "(0, 0, 3, 0), (0, 0, 200"),
              HasSubstr("expected a rotation"));
  EXPECT_THAT(error_of("xformOp:transform", "xformOp:rotateXYZ"),
              HasSubstr("c.usda: rig: xformOp:transform is in xformOpOrder and missing"));
  EXPECT_THAT(error_of("xformOpOrder", "xformOpOder"),
              HasSubstr("xformOp:transform without an xformOpOrder"));
  EXPECT_THAT(error_of("[\"xformOp:transform\"]", "[\"!resetXformStack!\"]"), HasSubstr("!resetXformStack!"));
  EXPECT_THAT(error_of("focalLength = 50", "focalLength = -1"), HasSubstr("above 0"));
  EXPECT_THAT(error_of("focalLength = 50", "focalLength = wide"), HasSubstr("found \"wide\""));
  EXPECT_THAT(error_of("    }\n}", "    }\n"), HasSubstr("ends inside a prim"));
  EXPECT_THAT(error_of("(0, 0, 200, 1) )", "(0, 0, 200, 1) "), HasSubstr("unclosed bracket"));
}

}  // namespace
}  // namespace laterna
