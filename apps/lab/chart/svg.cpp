#include "apps/lab/chart/svg.h"

#include <fmt/format.h>

namespace laterna {

std::string xml_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if ((static_cast<unsigned char>(c) >= 0x20 && c != 0x7f) || c == '\n')
      out += c;
  }
  return out;
}

namespace {

std::string points_text(const std::vector<std::pair<double, double>>& points) {
  std::string text;
  for (const auto& [x, y] : points) text += fmt::format("{}{:.1f},{:.1f}", text.empty() ? "" : " ", x, y);
  return text;
}

std::string stroke_text(const Svg::Stroke& s) {
  std::string text = fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"", s.colour, s.width);
  if (!s.dashes.empty()) text += fmt::format(" stroke-dasharray=\"{}\"", s.dashes);
  if (s.opacity != 1) text += fmt::format(" stroke-opacity=\"{}\"", s.opacity);
  return text;
}

}  // namespace

Svg::Svg(double width, double height, std::string_view title) {
  body_ = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "role=\"img\" font-family=\"sans-serif\" fill=\"{3}\">\n<title>{2}</title>\n",
      width, height, xml_text(title), neutral_grey);
}

void Svg::line(const std::vector<std::pair<double, double>>& points, const Stroke& stroke) {
  if (points.size() > 1)
    body_ += fmt::format("<polyline points=\"{}\" {}/>\n", points_text(points), stroke_text(stroke));
}

void Svg::text(double x, double y, std::string_view words, double size, Anchor anchor, bool turned) {
  const char* where = anchor == Anchor::start ? "start" : anchor == Anchor::middle ? "middle" : "end";
  const std::string turn = turned ? fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"", x, y) : "";
  body_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{}\" text-anchor=\"{}\"{}>{}</text>\n", x,
                       y, size, where, turn, xml_text(words));
}

void Svg::hinted_text(double x, double y, std::string_view words, double size, const std::string& colour,
                      std::string_view hint) {
  body_ += fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{}\" text-anchor=\"middle\" "
      "fill=\"{}\"><title>{}</title>{}</text>\n",
      x, y, size, colour, xml_text(hint), xml_text(words));
}

void Svg::marker(double x, double y, int shape, const std::string& colour, std::string_view hint) {
  const std::string style = fmt::format("fill=\"{}\" stroke=\"{}\" stroke-width=\"1\"", colour, neutral_grey);
  const std::string title = hint.empty() ? "" : fmt::format("<title>{}</title>", xml_text(hint));
  if (shape == 0) {
    body_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" {}>{}</circle>\n", x, y, style, title);
    return;
  }
  std::vector<std::pair<double, double>> corners{
      {x - 4.4, y - 4.4}, {x + 4.4, y - 4.4}, {x + 4.4, y + 4.4}, {x - 4.4, y + 4.4}};
  if (shape == 2) corners = {{x, y - 6.3}, {x + 6.3, y}, {x, y + 6.3}, {x - 6.3, y}};
  if (shape == 3) corners = {{x, y - 6.5}, {x + 6.5, y + 4.8}, {x - 6.5, y + 4.8}};
  if (shape == 4) corners = {{x, y + 6.5}, {x - 6.5, y - 4.8}, {x + 6.5, y - 4.8}};
  body_ += fmt::format("<polygon points=\"{}\" {}>{}</polygon>\n", points_text(corners), style, title);
}

void Svg::ring(double x, double y, double radius, const Stroke& stroke) {
  body_ +=
      fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" {}/>\n", x, y, radius, stroke_text(stroke));
}

void Svg::rect(double x, double y, double width, double height, const std::string& colour, double opacity) {
  const std::string faint = opacity == 1 ? "" : fmt::format(" fill-opacity=\"{}\"", opacity);
  body_ += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"{}/>\n",
                       x, y, width, height, colour, faint);
}

void Svg::strokes(const std::vector<std::array<double, 4>>& lines, const Stroke& stroke) {
  if (lines.empty()) return;
  std::string path;
  for (const auto& [x0, y0, x1, y1] : lines)
    path += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", x0, y0, x1, y1);
  body_ += fmt::format("<path d=\"{}\" stroke-linecap=\"round\" {}/>\n", path, stroke_text(stroke));
}

}  // namespace laterna
