#include "calib/orientation.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace laterna {

namespace {

constexpr int step_px = 8;
constexpr std::size_t fewest = 20;

/// Pixels of one handedness, and the sum of the unit vectors in which u grows in the camera's picture; of a
/// mirrored map -u.
struct Side {
  std::size_t count = 0;
  double x = 0, y = 0;
};

}  // namespace

Orientation orientation_of(const DecodedMap& map) {
  Side plain, mirrored;
  for (int y = 0; y + step_px < map.height; y += 2) {
    for (int x = 0; x + step_px < map.width; x += 2) {
      if (!map.valid(x, y) || !map.valid(x + step_px, y) || !map.valid(x, y + step_px)) continue;
      const double ux = map.u_px(x + step_px, y) - map.u_px(x, y),
                   vx = map.v_px(x + step_px, y) - map.v_px(x, y);
      const double uy = map.u_px(x, y + step_px) - map.u_px(x, y),
                   vy = map.v_px(x, y + step_px) - map.v_px(x, y);
      const double determinant = ux * vy - uy * vx, length = std::hypot(vx, vy);
      if (determinant == 0 || length == 0) continue;
      // (dx/du, dy/du) is (vy, -vx)/determinant; the sign of -u turns it once more.
      Side& side = determinant > 0 ? plain : mirrored;
      ++side.count;
      side.x += vy / length, side.y -= vx / length;
    }
  }
  Orientation o;
  o.mirrored = mirrored.count > plain.count;
  const Side& side = o.mirrored ? mirrored : plain;
  const std::size_t count = plain.count + mirrored.count;
  if (count == 0) return o;
  o.agreement = double(side.count) / double(count);
  o.known = side.count >= fewest && o.agreement >= 0.9;
  o.quarter_turns = (int(std::lround(std::atan2(side.y, side.x) / (std::numbers::pi / 2))) + 4) % 4;
  return o;
}

std::string orientation_words(const Orientation& o) {
  if (!o.known) return fmt::format("not to be told ({:.0f} % of the pixels agree)", 100 * o.agreement);
  if (!o.mirrored) {
    return o.quarter_turns == 0 ? "upright" : fmt::format("turned by {}° clockwise", 90 * o.quarter_turns);
  }
  if (o.quarter_turns == 0) return "mirrored: columns run backwards";
  if (o.quarter_turns == 2) return "mirrored: rows run backwards";
  return "mirrored: columns and rows are exchanged";
}

}  // namespace laterna
