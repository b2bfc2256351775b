// A small drawing board for the pictures that Laterna leaves: panels, maps in colour, lines and words.
#pragma once

#include "sim/image.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace laterna {

using Rgb = std::array<std::uint8_t, 3>;

/// An RGB picture, 8 bits a channel, row by row from the top.
struct Canvas {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;

  Canvas(int width_px, int height_px, Rgb fill);
  void set(int x, int y, Rgb colour);  ///< ignored outside the canvas
};

/// A colour of the viridis map (readable by the colour-blind and in grey) at `fraction`, clamped to [0, 1].
Rgb viridis(double fraction);

/// Words; `top_left` is the corner of the text's box, `height_px` that of a capital letter.
void draw_text(Canvas& canvas, glm::ivec2 top_left, const std::string& text, int height_px, Rgb colour);

/// A straight line, antialiased. Ends may lie outside the canvas.
void draw_line(Canvas& canvas, glm::dvec2 from, glm::dvec2 to, Rgb colour, int thickness_px = 1);

void fill_rectangle(Canvas& canvas, glm::ivec2 top_left, glm::ivec2 size, Rgb colour);

/// Fills a panel with colour(x, y) of a source of `source_size` pixels, fitted into `size` with its aspect
/// kept; by the mean colour of the source pixels under each canvas pixel where it shrinks.
void draw_panel(Canvas& canvas, glm::ivec2 top_left, glm::ivec2 size, glm::ivec2 source_size,
                const std::function<Rgb(int x, int y)>& colour);

/// A horizontal viridis bar with a word at each end.
void draw_colour_bar(Canvas& canvas, glm::ivec2 top_left, glm::ivec2 size, const std::string& low,
                     const std::string& high, Rgb text_colour);

/// PNG.
void write_canvas(const std::filesystem::path& path, const Canvas& canvas);

}  // namespace laterna
