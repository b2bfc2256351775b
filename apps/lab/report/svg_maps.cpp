#include "apps/lab/report/svg_maps.h"

#include "apps/lab/canvas.h"
#include "apps/lab/json_number.h"
#include "apps/lab/report/svg_axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace laterna {

using Json = nlohmann::json;

namespace {

constexpr double pi = std::numbers::pi;

std::string hex(const glm::dvec3& c) {
  return fmt::format("#{:02x}{:02x}{:02x}", int(std::lround(c.x)), int(std::lround(c.y)),
                     int(std::lround(c.z)));
}

std::string viridis_hex(double fraction) {
  const Rgb c = viridis(fraction);
  return hex({c[0], c[1], c[2]});
}

double number(const Json& json) { return json.is_number() ? json.get<double>() : double(NAN); }

// The projector's image between two ends of a row, y down, with a margin in pixels.
struct ImageAxes {
  SvgAxis u, v;
};

ImageAxes image_axes(glm::ivec2 size, double left, double right, double top, double margin) {
  const double w = size.x, h = size.y, scale = (right - left) / (w * (1 + 2 * margin));
  return {{-0.5 - margin * w, w - 0.5 + margin * w, left, right, false},
          {-0.5 - margin * h, h - 0.5 + margin * h, top, top + scale * h * (1 + 2 * margin), false}};
}

// Strokes of one of 24 directions share a colour and an element.
void draw_vectors(Svg& svg, const Json& sample, const ImageAxes& axes, double rms) {
  constexpr int steps = 24;
  std::map<int, std::vector<std::array<double, 4>>> by_direction;
  for (const Json& row : sample) {
    const double du = row[2], dv = row[3], length = 14 * std::min(std::hypot(du, dv) / rms, 1.5);
    const double angle = std::atan2(dv, du), x = axes.u.at(row[0]), y = axes.v.at(row[1]);
    const int step = int(std::lround(angle / (2 * pi) * steps) + steps) % steps;
    by_direction[step].push_back({x, y, x + length * std::cos(angle), y + length * std::sin(angle)});
  }
  for (const auto& [step, strokes] : by_direction)
    svg.strokes(strokes, {direction_colour(2 * pi * step / steps), 1.5});
}

void draw_wheel(Svg& svg, double x, double y, double radius) {
  for (int step = 0; step < 24; ++step) {
    const double angle = 2 * pi * step / 24, c = std::cos(angle), s = std::sin(angle);
    svg.line({{x + radius / 3 * c, y + radius / 3 * s}, {x + radius * c, y + radius * s}},
             {direction_colour(angle), 3});
  }
  svg.text(x + radius + 4, y + 4, "+u", 11);
  svg.text(x, y + radius + 13, "+v", 11, Svg::Anchor::middle);
}

double quantity_of(const Json& cell, GridQuantity quantity) {
  return quantity == GridQuantity::sigma ? number_or_nan(cell, "sigma_px")
                                         : std::hypot(number_or_nan(cell, "du"), number_or_nan(cell, "dv"));
}

void draw_cells(Svg& svg, const Json& p, double depth, const ImageAxes& axes, glm::ivec2 size,
                GridQuantity quantity, double largest) {
  const double wide = std::abs(axes.u.at(size.x / 15.0) - axes.u.at(0));
  const double high = std::abs(axes.v.at(size.y / 11.0) - axes.v.at(0));
  std::vector<std::array<double, 4>> strokes, feet;
  for (const Json& cell : p["grid"]) {
    const double value = quantity_of(cell, quantity), x = axes.u.at(number(cell["u"])),
                 y = axes.v.at(number(cell["v"]));
    if (number(cell["depth_m"]) != depth || !std::isfinite(value + x + y)) continue;
    svg.rect(x - wide / 2, y - high / 2, wide + 0.2, high + 0.2, viridis_hex(value / largest));
    const double scale = 1.8 * std::min(wide, high) / largest;
    if (quantity == GridQuantity::difference)
      strokes.push_back({x, y, x + scale * number(cell["du"]), y + scale * number(cell["dv"])}),
          feet.push_back({x, y, x, y});
  }
  svg.strokes(strokes, {"#ffffff", 2.6});  // white under black: seen on every colour
  svg.strokes(feet, {"#ffffff", 4.4});
  svg.strokes(strokes, {"#000000", 1.1});
  svg.strokes(feet, {"#000000", 2.8});
}

void draw_colour_bar(Svg& svg, double x, double y, double largest, const std::string& words) {
  constexpr int steps = 48;
  constexpr double width = 240;
  for (int k = 0; k < steps; ++k)
    svg.rect(x + width * k / steps, y, width / steps + 0.3, 12, viridis_hex((k + 0.5) / steps));
  svg.text(x, y + 28, "0", 13);
  svg.text(x + width, y + 28, fmt::format("{:.4g} px", largest), 13, Svg::Anchor::end);
  svg.text(x + width + 14, y + 11, words, 13);
}

}  // namespace

std::string direction_colour(double angle) {
  static const std::array<glm::dvec3, 6> stops{
      {{217, 163, 31}, {217, 96, 31}, {176, 58, 99}, {115, 88, 184}, {47, 128, 207}, {69, 176, 184}}};
  const double turn = angle / (2 * pi) - std::floor(angle / (2 * pi)), at = turn * double(stops.size());
  const auto k = std::size_t(at) % stops.size();
  return hex(glm::mix(stops[k], stops[(k + 1) % stops.size()], at - std::floor(at)));
}

std::string residual_vectors_svg(const Json& r, glm::ivec2 size) {
  const std::string of = fmt::format("Residuals of \"{}\" seen by \"{}\"", r["projector"].get<std::string>(),
                                     r["camera"].get<std::string>());
  const double rms = std::max(number(r["rms_px"]), 1e-300);
  const ImageAxes axes = image_axes(size, 80, 740, 50, 0.02);
  Svg svg(840, axes.v.to + 60, of);
  svg.text(20, 22, fmt::format("{}; a stroke as long as the wheel's is {:.3g} px", of, rms * 18 / 14), 16);
  draw_axes(svg, axes.u, axes.v, "column, px", "row, px", ticks_on(axes.u), ticks_on(axes.v));
  draw_vectors(svg, r["sample"], axes, rms);
  draw_wheel(svg, 780, 80, 27);
  return svg.str();
}

std::string projection_map_svg(const Json& p, glm::ivec2 size, GridQuantity quantity) {
  const bool sigma = quantity == GridQuantity::sigma;
  const std::string title = fmt::format("{} of \"{}\"", sigma ? "Uncertainty" : "Recovered minus true",
                                        p["projector"].get<std::string>());
  double largest = 1e-12;
  for (const Json& cell : p["grid"]) {
    const double value = quantity_of(cell, quantity);
    if (std::isfinite(value)) largest = std::max(largest, value);
  }
  const ImageAxes first = image_axes(size, 70, 300, 64, 0.06);
  Svg svg(840, first.v.to + 110, title);
  svg.text(20, 22, title, 16);
  for (std::size_t k = 0; k < p["depths_m"].size(); ++k) {
    const double depth = p["depths_m"][k], left = 70 + 260.0 * double(k);
    const ImageAxes axes = image_axes(size, left, left + 230, 64, 0.06);
    svg.text(left + 115, 52, fmt::format("at {:.4g} m", depth), 13, Svg::Anchor::middle);
    draw_axes(svg, axes.u, axes.v, "column, px", k == 0 ? "row, px" : "", ticks_on(axes.u, 3),
              k == 0 ? ticks_on(axes.v, 4) : std::vector<SvgTick>{});
    draw_cells(svg, p, depth, axes, size, quantity, largest);
  }
  draw_colour_bar(svg, 70, first.v.to + 62, largest,
                  sigma ? "standard deviation by the estimate's own covariance"
                        : "difference; strokes from their dots along it");
  return svg.str();
}

}  // namespace laterna
