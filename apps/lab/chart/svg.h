// A small SVG writer: what a chart needs, in pixels from the upper left corner.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace laterna {

/// Text with what XML reserves escaped, and control characters but line feeds left out.
std::string xml_text(std::string_view text);

/// A mid grey with a contrast of 4.5 on white and on black alike: the picture's ground is left clear.
inline constexpr const char* neutral_grey = "#767676";

class Svg {
 public:
  Svg(double width, double height, std::string_view title);

  struct Stroke {
    std::string colour = neutral_grey;
    double width = 1;
    std::string dashes{};  ///< as "4 3"; empty: solid
    double opacity = 1;
  };
  void line(const std::vector<std::pair<double, double>>& points, const Stroke& stroke);

  enum class Anchor { start, middle, end };
  /// `turned`: a quarter turn to the left about its place.
  void text(double x, double y, std::string_view words, double size, Anchor anchor = Anchor::start,
            bool turned = false);

  /// In the middle over x, in a colour of its own; `hint` is shown when a pointer rests on it.
  void hinted_text(double x, double y, std::string_view words, double size, const std::string& colour,
                   std::string_view hint);

  /// One of marker_shapes shapes of one area, outlined in grey; `hint` is shown when a pointer rests on it.
  void marker(double x, double y, int shape, const std::string& colour, std::string_view hint);
  void ring(double x, double y, double radius, const Stroke& stroke);
  void rect(double x, double y, double width, double height, const std::string& colour, double opacity = 1);

  /// Lines that are not joined, each {x0, y0, x1, y1}, as one element; of no length and round ends: dots.
  void strokes(const std::vector<std::array<double, 4>>& lines, const Stroke& stroke);

  std::string str() const { return body_ + "</svg>\n"; }

 private:
  std::string body_;
};

inline constexpr int marker_shapes = 5;  ///< circle, square, diamond, triangle up, triangle down

}  // namespace laterna
