#include "render/image_rows.h"

#include "sim/error.h"
#include "sim/parallel.h"

#include <fmt/format.h>

namespace laterna {

namespace {

void check(const ImageRows& image) {
  const glm::ivec2 r = image.region_px;
  if (r.x < tile_edge || r.y < tile_edge || r.x % tile_edge != 0 || r.y % tile_edge != 0)
    throw InputError(
        fmt::format("replay: regions of {}x{} pixels, expected multiples of {}", r.x, r.y, tile_edge));
}

glm::ivec2 regions_of(const ImageRows& image) { return (image.size + image.region_px - 1) / image.region_px; }

PixelRegion region_of(const ImageRows& image, std::size_t index) {
  const auto columns = std::size_t(regions_of(image).x);
  const glm::ivec2 first = glm::ivec2(index % columns, index / columns) * image.region_px;
  const glm::ivec2 size = glm::min(image.region_px, image.size - first);
  return {first.x, first.y, size.x, size.y};
}

}  // namespace

std::size_t region_count(const ImageRows& image) {
  check(image);
  const glm::ivec2 regions = regions_of(image);
  return std::size_t(regions.x) * regions.y;
}

void for_each_region(const ImageRows& image, std::size_t first, std::size_t count,
                     const std::function<void(LightRows&, std::size_t)>& work) {
  check(image);
  parallel_for(count, [&](std::size_t i) {
    LightRows rows;
    rows.region = region_of(image, first + i);
    image.rows(rows);
    work(rows, first + i);
  });
}

void for_each_region(const ImageRows& image, const std::function<void(LightRows&, std::size_t)>& work) {
  for_each_region(image, 0, region_count(image), work);
}

}  // namespace laterna
