#include "apps/lab/classics/panels.h"

#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

constexpr int caption_px = 20, gap_px = 6;
constexpr Rgb paper{255, 255, 255}, ink{40, 40, 40};

std::uint8_t srgb_of_light(double share) {
  const double light = std::clamp(share, 0.0, 1.0);
  const double encoded = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
  return std::uint8_t(std::lround(255 * encoded));
}

// colour(i) of each pixel i.
template <class Colour>
Canvas canvas_of(int width, int height, const Colour& colour) {
  Canvas canvas(width, height, {0, 0, 0});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) canvas.set(x, y, colour(std::size_t(y) * width + x));
  return canvas;
}

void check_white(double white) {
  if (!(white > 0))
    throw InputError(fmt::format("the white of a picture: found {}, expected above 0", white));
}

void copy_into(Canvas& sheet, const Canvas& panel, glm::ivec2 corner) {
  for (int y = 0; y < panel.height; ++y)
    std::copy_n(panel.rgb.begin() + std::ptrdiff_t(3) * y * panel.width, 3 * panel.width,
                sheet.rgb.begin() + 3 * (std::ptrdiff_t(corner.y + y) * sheet.width + corner.x));
}

}  // namespace

Canvas grey_canvas(const Image<float>& light, double white) {
  check_white(white);
  return canvas_of(light.width, light.height, [&](std::size_t i) {
    const std::uint8_t grey = srgb_of_light(light.values[i] / white);
    return Rgb{grey, grey, grey};
  });
}

Canvas colour_canvas(const Image<glm::vec3>& light, double white) {
  check_white(white);
  return canvas_of(light.width, light.height, [&](std::size_t i) {
    const glm::dvec3 share = glm::dvec3(light.values[i]) / white;
    return Rgb{srgb_of_light(share.r), srgb_of_light(share.g), srgb_of_light(share.b)};
  });
}

Canvas map_canvas(const Image<float>& values, double least, double most) {
  return canvas_of(values.width, values.height, [&](std::size_t i) {
    const double value = values.values[i];
    return std::isfinite(value) ? viridis((value - least) / (most - least)) : Rgb{0, 0, 0};
  });
}

Canvas side_by_side(const std::vector<Panel>& panels, int columns) {
  if (panels.empty()) throw InputError("a sheet of no panels");
  const glm::ivec2 cell(panels[0].canvas.width + gap_px, panels[0].canvas.height + caption_px + gap_px);
  const int rows = (int(panels.size()) + columns - 1) / columns;
  Canvas sheet(columns * cell.x - gap_px, rows * cell.y - gap_px, paper);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const glm::ivec2 corner = cell * glm::ivec2(int(i) % columns, int(i) / columns);
    draw_text(sheet, corner + glm::ivec2(2, 5), panels[i].caption, 9, ink);
    if (panels[i].canvas.width != panels[0].canvas.width ||
        panels[i].canvas.height != panels[0].canvas.height)
      throw InputError("panels of different sizes on one sheet");
    copy_into(sheet, panels[i].canvas, corner + glm::ivec2(0, caption_px));
  }
  return sheet;
}

}  // namespace laterna
