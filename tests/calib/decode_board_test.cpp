#include "calib/decode_board.h"

#include "calib/decode.h"
#include "tests/calib/pictures.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cmath>

namespace laterna {
namespace {

using ::testing::HasSubstr;

struct Found {
  int corners = 0;
  double rms_px = 0;
};

Found found(const DecodedMap& map, const std::function<glm::dvec2(glm::dvec2)>& place) {
  Found f;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      if (!map.valid(x, y)) continue;
      const glm::dvec2 d = glm::dvec2(map.u_px(x, y), map.v_px(x, y)) - place({x, y});
      ++f.corners, f.rms_px += glm::dot(d, d);
    }
  }
  f.rms_px = std::sqrt(f.rms_px / std::max(f.corners, 1));
  return f;
}

// A picture turned by `turn_rad` about the middle, 1.6 camera pixels per projector pixel.
Found seen_turned(PatternKind kind, double turn_rad, bool mirrored, std::mt19937_64& random) {
  const PatternSequence sequence{{.kind = kind, .square_px = 40}, {320, 240}};
  const auto place = [&](glm::dvec2 p) {
    const glm::dvec2 q = (p - glm::dvec2(300, 280)) / 1.6;
    const glm::dvec2 r(std::cos(turn_rad) * q.x - std::sin(turn_rad) * q.y,
                       std::sin(turn_rad) * q.x + std::cos(turn_rad) * q.y);
    return glm::dvec2(160 + (mirrored ? -r.x : r.x), 120 + r.y);
  };
  return found(decode_board(seen(sequence, {600, 560}, 3, place, 1, random), sequence), place);
}

TEST(DecodeBoard, CornersAreFoundAndNamed) {
  auto random = testing::generator();
  for (const double turn : {0.0, 0.2, 3.1}) {
    for (const PatternKind kind : {PatternKind::chessboard, PatternKind::charuco}) {
      const Found f = seen_turned(kind, turn, false, random);
      EXPECT_EQ(f.corners, 5 * 4) << turn;  // 6×5 squares
      // A tenth of a camera pixel is 0.06; markers beside a corner pull it by half a pixel; a wrong name
      // costs 40.
      EXPECT_LT(f.rms_px, kind == PatternKind::chessboard ? 0.1 : 0.6) << turn;
    }
  }
}

TEST(DecodeBoard, MarkersAreNotFoundInAMirror) {
  auto random = testing::generator();
  EXPECT_EQ(seen_turned(PatternKind::charuco, 0.1, true, random).corners, 0);
}

TEST(DecodeBoard, NoBoardNoPixels) {
  const PatternSequence sequence{{.kind = PatternKind::chessboard, .square_px = 40}, {320, 240}};
  ImageStack<std::uint8_t> dark(64, 48, 3);
  std::fill(dark.values.begin(), dark.values.end(), std::uint8_t{7});
  EXPECT_EQ(found(decode(dark, sequence), [](glm::dvec2 p) { return p; }).corners, 0);
  EXPECT_THAT(testing::input_error([&] { decode(ImageStack<std::uint8_t>(64, 48, 2), sequence); }),
              HasSubstr("2 pictures"));
}

}  // namespace
}  // namespace laterna
