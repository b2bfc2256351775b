#include "sim/formats/bop_info.h"

#include <cmath>

namespace laterna {

namespace {

Tree box_of(const BopExtent& e) { return {e.low.x, e.low.y, e.high.x - e.low.x, e.high.y - e.low.y}; }

}  // namespace

BopExtent extent_of(const Image<std::uint8_t>& mask, glm::ivec2 first_px) {
  BopExtent extent;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      if (mask(x, y) != 0)
        extent = merged(extent, {1, first_px + glm::ivec2(x, y), first_px + glm::ivec2(x, y)});
  return extent;
}

BopExtent merged(const BopExtent& a, const BopExtent& b) {
  if (a.count == 0 || b.count == 0) return a.count == 0 ? b : a;
  return {a.count + b.count, glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

Tree bop_info(const BopExtent& whole, int valid, const BopExtent& visible) {
  const Tree none = {-1, -1, -1, -1};
  const bool seen = visible.count > 0;
  return {{"bbox_obj", seen ? box_of(whole) : none},
          {"bbox_visib", seen ? box_of(visible) : none},
          {"px_count_all", whole.count},
          {"px_count_valid", valid},
          {"px_count_visib", visible.count},
          {"visib_fract", whole.count > 0 ? double(visible.count) / whole.count : 0.0}};
}

BopExtent bop_whole(const Place& entry) {
  const Place count = entry.at("px_count_all");
  if (count.whole_number() < 0) fail_at(count, "a number of pixels");
  const Place list = entry.at("bbox_obj");
  const std::vector<double> box = list.numbers(4);
  for (const double value : box)
    if (std::abs(value) > 1e6 || value != std::floor(value))
      fail_at(list, "whole pixels: x, y, width, height");
  const glm::ivec2 low(box[0], box[1]);
  return {count.whole_number(), low, low + glm::ivec2(box[2], box[3])};
}

}  // namespace laterna
