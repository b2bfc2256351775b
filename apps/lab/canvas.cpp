#include "apps/lab/canvas.h"

#include "sim/image_file.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

cv::Mat mat_of(Canvas& canvas) { return {canvas.height, canvas.width, CV_8UC3, canvas.rgb.data()}; }

cv::Scalar scalar_of(Rgb c) { return {double(c[0]), double(c[1]), double(c[2])}; }

// Subpixel position in OpenCV's fixed point.
constexpr int subpixel_bits = 4;
cv::Point fixed_point(glm::dvec2 p) {
  const double limit = 1e6;  // far outside any canvas, still inside an int
  return {int(std::lround(std::clamp(p.x, -limit, limit) * (1 << subpixel_bits))),
          int(std::lround(std::clamp(p.y, -limit, limit) * (1 << subpixel_bits)))};
}

std::array<Rgb, 256> make_viridis() {
  cv::Mat grey(1, 256, CV_8UC1), colour;
  for (int i = 0; i < 256; ++i) grey.at<std::uint8_t>(0, i) = std::uint8_t(i);
  cv::applyColorMap(grey, colour, cv::COLORMAP_VIRIDIS);
  std::array<Rgb, 256> table{};
  for (int i = 0; i < 256; ++i) {
    const auto& bgr = colour.at<cv::Vec3b>(0, i);
    table[i] = {bgr[2], bgr[1], bgr[0]};
  }
  return table;
}

}  // namespace

Canvas::Canvas(int width_px, int height_px, Rgb fill)
    : width(width_px), height(height_px), rgb(std::size_t(3) * width_px * height_px) {
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = fill[i % 3];
}

void Canvas::set(int x, int y, Rgb colour) {
  if (x < 0 || y < 0 || x >= width || y >= height) return;
  std::copy(colour.begin(), colour.end(), rgb.begin() + 3 * (std::ptrdiff_t(y) * width + x));
}

Rgb viridis(double fraction) {
  static const std::array<Rgb, 256> table = make_viridis();
  return table[std::size_t(std::lround(255 * std::clamp(fraction, 0.0, 1.0)))];
}

void draw_text(Canvas& canvas, glm::ivec2 top_left, const std::string& text, int height_px, Rgb colour) {
  cv::Mat mat = mat_of(canvas);
  const double scale = height_px / 21.0;  // Hershey capitals are 21 px high at scale 1
  cv::putText(mat, text, {top_left.x, top_left.y + height_px}, cv::FONT_HERSHEY_SIMPLEX, scale,
              scalar_of(colour), 1, cv::LINE_AA);
}

void draw_line(Canvas& canvas, glm::dvec2 from, glm::dvec2 to, Rgb colour, int thickness_px) {
  cv::Mat mat = mat_of(canvas);
  cv::line(mat, fixed_point(from), fixed_point(to), scalar_of(colour), thickness_px, cv::LINE_AA,
           subpixel_bits);
}

void fill_rectangle(Canvas& canvas, glm::ivec2 top_left, glm::ivec2 size, Rgb colour) {
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) canvas.set(top_left.x + x, top_left.y + y, colour);
  }
}

void draw_panel(Canvas& canvas, glm::ivec2 top_left, glm::ivec2 size, glm::ivec2 source_size,
                const std::function<Rgb(int x, int y)>& colour) {
  cv::Mat source(source_size.y, source_size.x, CV_8UC3), fitted;
  for (int y = 0; y < source_size.y; ++y) {
    for (int x = 0; x < source_size.x; ++x) {
      const Rgb c = colour(x, y);
      source.at<cv::Vec3b>(y, x) = {c[0], c[1], c[2]};
    }
  }
  const double scale = std::min(double(size.x) / source_size.x, double(size.y) / source_size.y);
  const cv::Size to(std::max(1, int(source_size.x * scale)), std::max(1, int(source_size.y * scale)));
  cv::resize(source, fitted, to, 0, 0, scale < 1 ? cv::INTER_AREA : cv::INTER_NEAREST);
  const glm::ivec2 corner = top_left + (size - glm::ivec2(to.width, to.height)) / 2;
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      const auto& c = fitted.at<cv::Vec3b>(y, x);
      canvas.set(corner.x + x, corner.y + y, {c[0], c[1], c[2]});
    }
  }
}

void draw_colour_bar(Canvas& canvas, glm::ivec2 top_left, glm::ivec2 size, const std::string& low,
                     const std::string& high, Rgb text_colour) {
  for (int x = 0; x < size.x; ++x)
    fill_rectangle(canvas, {top_left.x + x, top_left.y}, {1, size.y}, viridis(double(x) / (size.x - 1)));
  draw_text(canvas, {top_left.x, top_left.y + size.y + 4}, low, 10, text_colour);
  draw_text(canvas, {top_left.x + size.x - int(7.5 * double(high.size())), top_left.y + size.y + 4}, high, 10,
            text_colour);
}

void write_canvas(const std::filesystem::path& path, const Canvas& canvas) {
  write_picture(path, {canvas.rgb.data(), canvas.width, canvas.height, 3, PixelType::u8, {}});
}

}  // namespace laterna
