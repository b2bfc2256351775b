#include "sim/formats/bop.h"

#include "sim/formats/rig_file.h"
#include "tests/sim/formats/rigs.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using testing::rig_pixel;

// Half a turn about x and half a metre further, in millimetres.
const char* const by_hand = R"({
  "3": {"cam_K": [500.0, 0.0, 320.0, 0.0, 600.0, 240.0, 0.0, 0.0, 1.0],
        "cam_R_w2c": [1, 0, 0, 0, -1, 0, 0, 0, -1], "cam_t_w2c": [0.0, 0.0, 1500.0], "depth_scale": 0.1}
})";

TEST(Bop, ReadsAFileByHand) {
  const testing::ScratchFolder folder;
  const Rig rig =
      read_rig(testing::write_text(folder / "scene_camera.json", by_hand), {"", 1, {640, 480}, {0, 0}});
  // (0.1, 0.2, 0.5) m becomes (0.1, -0.2, 1).
  EXPECT_PIXEL(rig_pixel(rig, "3", {0.1, 0.2, 0.5}), 320 + 500 * 0.1, 240 - 600 * 0.2);
}

TEST(Bop, SurvivesARoundTrip) {
  auto random = testing::generator();
  const Rig rig = testing::random_pair(random, "LENSMODEL_PINHOLE", 0);
  Notes notes;
  testing::expect_same(parse_bop(bop_text(rig, notes), "x"), rig, 1e-15);  // metres to millimetres and back
  EXPECT_EQ(notes.size(), 1u);
}

TEST(Bop, BadFilesAndLenses) {
  auto random = testing::generator();
  Notes notes;
  EXPECT_THAT(
      testing::input_error([&] { bop_text(testing::random_pair(random, "LENSMODEL_OPENCV4", 4), notes); }),
      HasSubstr("BOP holds no lens"));
  EXPECT_THAT(testing::input_error([] { parse_bop("{\"0\": {\"cam_K\": [1, 2]}}", "s.json"); }),
              HasSubstr("s.json: 0.cam_K: found 2 numbers, expected 9"));
  EXPECT_THAT(testing::input_error([] { parse_bop("{\"0\": ", "s.json"); }), HasSubstr("s.json: no JSON"));
  const std::string deep = std::string(100, '[') + std::string(100, ']');
  EXPECT_THAT(testing::input_error([&] { parse_bop(deep, "s.json"); }), HasSubstr("nests deeper"));
}

}  // namespace
}  // namespace laterna
