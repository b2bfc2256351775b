#include "apps/lab/report/thumbnails.h"

#include "apps/lab/canvas.h"
#include "sim/error.h"
#include "sim/image_file.h"
#include "sim/text_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>

namespace laterna {

namespace {

constexpr std::string_view base64_letters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

int box_side(int width, int most) { return std::max(1, (width + most - 1) / most); }

template <class T>
Image<std::uint8_t> shrink(std::span<const T> picture, int width, int height, int full_scale, int side) {
  Image<std::uint8_t> small((width + side - 1) / side, (height + side - 1) / side);
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      std::uint64_t sum = 0, count = 0;
      for (int v = y * side; v < std::min((y + 1) * side, height); ++v)
        for (int u = x * side; u < std::min((x + 1) * side, width); ++u, ++count)
          sum += picture[std::size_t(v) * width + u];
      const double mean = double(sum) / double(count) / full_scale;
      small(x, y) = std::uint8_t(std::lround(255 * std::clamp(mean, 0.0, 1.0)));
    }
  }
  return small;
}

// The one function that writes pictures writes files: through one that is removed again.
template <class T>
std::string png_bytes(const Image<T>& picture) {
  static std::atomic<unsigned> next{0};
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / fmt::format("laterna-{}-{}.png", ::getpid(), next++);
  write_picture(file, picture);
  std::string bytes = read_text(file, std::size_t(64) << 20);
  std::filesystem::remove(file);
  return bytes;
}

}  // namespace

std::vector<Image<std::uint8_t>> thumbnails(const CapturedStack& stack, int full_scale, int width_px) {
  std::vector<Image<std::uint8_t>> small;
  std::visit(
      [&](const auto& s) {
        for (int k = 0; k < s.count; ++k)
          small.push_back(shrink(s.picture(k), s.width, s.height, full_scale, box_side(s.width, width_px)));
      },
      stack);
  return small;
}

std::vector<std::string> frame_labels(const PatternSequence& sequence, int count) {
  std::vector<std::string> labels;
  const bool named = !comes_from_files(sequence.parameters.kind) && picture_count(sequence) == count;
  for (int k = 0; k < count; ++k)
    labels.push_back(named ? picture_name(sequence, k) : fmt::format("picture {}", k));
  return labels;
}

Image<glm::u8vec3> map_picture(const Image<double>& map, double low, double high, int width_px) {
  const int side = box_side(map.width, width_px);
  Image<glm::u8vec3> small(map.width / side, map.height / side);
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      const double value = map(x * side + side / 2, y * side + side / 2);
      const Rgb c = std::isfinite(value) ? viridis((value - low) / (high - low)) : Rgb{136, 136, 136};
      small(x, y) = {c[0], c[1], c[2]};
    }
  }
  return small;
}

std::string data_uri(const Image<std::uint8_t>& picture) {
  return "data:image/png;base64," + base64(png_bytes(picture));
}

std::string data_uri(const Image<glm::u8vec3>& picture) {
  return "data:image/png;base64," + base64(png_bytes(picture));
}

std::string data_uri_of_file(const std::string& path) {
  return "data:image/png;base64," + base64(read_text(path, std::size_t(64) << 20));
}

std::string bytes_of_data_uri(std::string_view uri) {
  const std::size_t comma = uri.find(";base64,");
  if (comma == std::string_view::npos) throw InputError("a picture that is no data URI");
  std::string bytes;
  std::uint32_t word = 0;
  int bits = 0;
  for (const char c : uri.substr(comma + 8)) {
    const std::size_t value = base64_letters.find(c);
    if (c == '=') break;
    if (value == std::string_view::npos) throw InputError("a picture whose data URI is damaged");
    word = word << 6 | std::uint32_t(value), bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += char(word >> bits & 255);
  }
  return bytes;
}

std::string base64(std::string_view bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : base64_letters[word >> (18 - 6 * k) & 63];
  }
  return text;
}

}  // namespace laterna
