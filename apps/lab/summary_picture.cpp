#include "apps/lab/summary_picture.h"

#include "apps/lab/percentile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

constexpr Rgb background{24, 26, 30}, ink{235, 235, 235}, quiet{170, 174, 182}, empty{52, 55, 62};

struct Panel {
  glm::ivec2 corner, size;
};

void caption(Canvas& canvas, const Panel& panel, const std::string& text) {
  draw_text(canvas, panel.corner - glm::ivec2(0, 22), text, 13, ink);
}

void draw_map(Canvas& canvas, const Panel& panel, const std::string& text, const Image<double>& map,
              int extent_px) {
  caption(canvas, panel, text);
  draw_panel(canvas, panel.corner, panel.size, {map.width, map.height}, [&](int x, int y) {
    const double value = map(x, y);
    return std::isfinite(value) ? viridis(value / extent_px) : empty;
  });
  draw_colour_bar(canvas, panel.corner + glm::ivec2(0, panel.size.y + 6), {220, 8}, "0",
                  fmt::format("{}", extent_px - 1), quiet);
}

}  // namespace

Canvas summary_picture(const SummaryPanels& in) {
  const glm::ivec2 source(in.white.width, in.white.height);
  const int width = 620, height = std::clamp(int(std::lround(double(width) * source.y / source.x)), 160, 760);
  const int top = 54 + 20 * int(in.lines.size()), gap = 66;
  Canvas canvas(2 * width + 60, top + 2 * (height + gap) + 24, background);
  draw_text(canvas, {20, 14}, in.title, 18, ink);
  for (std::size_t i = 0; i < in.lines.size(); ++i)
    draw_text(canvas, {20, 44 + 20 * int(i)}, in.lines[i], 12, quiet);
  const auto panel = [&](int column, int row) {
    return Panel{{20 + column * (width + 20), top + 24 + row * (height + gap)}, {width, height}};
  };
  caption(canvas, panel(0, 0), "White frame as captured");
  draw_panel(canvas, panel(0, 0).corner, panel(0, 0).size, source, [&](int x, int y) {
    const auto level = std::uint8_t(std::lround(255 * std::clamp(in.white(x, y), 0.0f, 1.0f)));
    return Rgb{level, level, level};
  });
  draw_map(canvas, panel(1, 0), "Decoded projector column, px", in.decoded->u_px, in.projector_size.x);
  draw_map(canvas, panel(0, 1), "Decoded projector row, px", in.decoded->v_px, in.projector_size.y);
  if (in.error_px.values.empty()) {
    caption(canvas, panel(1, 1), "No estimate: nothing to compare");
    return canvas;
  }
  const double top_px = std::max(percentile_99(in.error_px), 1e-12);
  caption(canvas, panel(1, 1), "Error of the recovered texture matrix on the surface, px");
  draw_panel(canvas, panel(1, 1).corner, panel(1, 1).size, source, [&](int x, int y) {
    const float value = in.error_px(x, y);
    return std::isfinite(value) ? viridis(value / top_px) : empty;
  });
  draw_colour_bar(canvas, panel(1, 1).corner + glm::ivec2(0, height + 6), {220, 8}, "0",
                  fmt::format("{:.2g}", top_px), quiet);
  return canvas;
}

}  // namespace laterna
