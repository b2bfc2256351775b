// Linear light and layers, made of read_picture and write_picture.
#include "sim/error.h"
#include "sim/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const fs::path& path, const std::string& reason) {
  throw InputError(fmt::format("{}: {}", path.string(), reason));
}

/// 1 or 3: how many of the channels are light and not alpha.
std::size_t colours_of(const fs::path& path, std::size_t channels) {
  if (channels < 1 || channels > 4)
    refuse(path,
           fmt::format("has {} channels, expected 1 to 4 (grey or RGB, with or without alpha)", channels));
  return channels < 3 ? 1 : 3;
}

float linear_from_srgb(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

/// Integers to [0, 1] by the encoding, floats as they are.
std::vector<float> linear_values(const Picture& picture, Encoding encoding) {
  const auto convert = [encoding](const auto& values, float full_scale) {
    std::vector<float> linear(values.begin(), values.end());
    for (float& v : linear)
      v = encoding == Encoding::srgb ? linear_from_srgb(v / full_scale) : v / full_scale;
    return linear;
  };
  if (const auto* bytes = std::get_if<std::vector<std::uint8_t>>(&picture.values))
    return convert(*bytes, 255.0f);
  if (const auto* words = std::get_if<std::vector<std::uint16_t>>(&picture.values))
    return convert(*words, 65535.0f);
  return std::get<std::vector<float>>(picture.values);
}

}  // namespace

Image<glm::vec3> read_rgb_float(const fs::path& path, Encoding encoding) {
  const Picture picture = read_picture(path);
  const std::size_t channels = picture.channel_names.size(), colours = colours_of(path, channels);
  const std::vector<float> values = linear_values(picture, encoding);
  Image<glm::vec3> rgb(picture.width, picture.height);
  for (std::size_t i = 0; i < rgb.values.size(); ++i) {
    const float* v = values.data() + i * channels;
    rgb.values[i] = colours == 3 ? glm::vec3(v[0], v[1], v[2]) : glm::vec3(v[0]);
    if (!std::isfinite(rgb.values[i].x + rgb.values[i].y + rgb.values[i].z))
      refuse(path, fmt::format("pixel ({}, {}) holds a value that is not finite, expected finite numbers",
                               i % rgb.width, i / rgb.width));
  }
  return rgb;
}

Image<float> read_grey_float(const fs::path& path, Encoding encoding) {
  const Image<glm::vec3> rgb = read_rgb_float(path, encoding);
  Image<float> grey(rgb.width, rgb.height);
  std::transform(rgb.values.begin(), rgb.values.end(), grey.values.begin(), [](const glm::vec3& v) {
    return v.x == v.y && v.y == v.z ? v.x : (v.x + v.y + v.z) / 3;  // equal channels keep their very bits
  });
  return grey;
}

void write_exr_layers(const fs::path& path, const ExrLayers& layers) {
  if (layers.planes.empty() || layers.names.size() != layers.planes.size())
    refuse(path, fmt::format("{} names for {} planes, expected one each", layers.names.size(),
                             layers.planes.size()));
  const int width = layers.planes[0].width, height = layers.planes[0].height;
  const std::size_t count = layers.planes.size();
  std::vector<float> interleaved(std::size_t(width) * height * count);
  for (std::size_t c = 0; c < count; ++c) {
    const Image<float>& plane = layers.planes[c];
    if (plane.width != width || plane.height != height)
      refuse(path, fmt::format("plane {} is {}×{} pixels, expected {}×{} as the first", layers.names[c],
                               plane.width, plane.height, width, height));
    for (std::size_t i = 0; i < plane.values.size(); ++i) interleaved[i * count + c] = plane.values[i];
  }
  write_picture(path,
                {interleaved.data(), width, height, int(count), PixelType::f32, layers.names, layers.camera});
}

ExrLayers read_exr_layers(const fs::path& path) {
  const Picture picture = read_picture(path);
  const auto* values = std::get_if<std::vector<float>>(&picture.values);
  if (values == nullptr) refuse(path, "holds integers, expected an EXR file of floats");
  ExrLayers layers{picture.channel_names, {}, picture.camera};
  const std::size_t count = layers.names.size();
  for (std::size_t c = 0; c < count; ++c) {
    Image<float>& plane = layers.planes.emplace_back(picture.width, picture.height);
    for (std::size_t i = 0; i < plane.values.size(); ++i) plane.values[i] = (*values)[i * count + c];
  }
  return layers;
}

}  // namespace laterna
