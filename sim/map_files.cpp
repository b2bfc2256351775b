#include "sim/map_files.h"

#include "sim/error.h"
#include "sim/scene_heading.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace laterna {

namespace {

bool is_grey(const glm::vec3& rgb) { return rgb.x == rgb.y && rgb.y == rgb.z; }

// Red, green and blue; none where all pixels are grey.
std::vector<Image<float>> read_primaries(const std::filesystem::path& path, Encoding encoding) {
  const Image<glm::vec3> rgb = read_rgb_float(path, encoding);
  if (std::all_of(rgb.values.begin(), rgb.values.end(), is_grey)) return {};
  std::vector<Image<float>> primaries(3, Image<float>(rgb.width, rgb.height));
  for (std::size_t i = 0; i < 3 * rgb.values.size(); ++i) {
    const float value = rgb.values[i / 3][int(i % 3)];
    if (!(value >= 0 && value <= 1))
      throw InputError(fmt::format("{}: a channel of a pixel is {}, expected 0 to 1", path.string(), value));
    primaries[i % 3].values[i / 3] = value;
  }
  return primaries;
}

}  // namespace

Image<float> read_fractions(const std::filesystem::path& path, Encoding encoding) {
  Image<float> map = read_grey_float(path, encoding);
  for (const float value : map.values) {
    if (!(value >= 0 && value <= 1))
      throw InputError(fmt::format("{}: a pixel is {}, expected 0 to 1", path.string(), value));
  }
  return map;
}

Image<glm::vec3> read_normals(const std::filesystem::path& path) {
  Image<glm::vec3> map = read_rgb_float(path, Encoding::linear);
  for (const glm::vec3& value : map.values) {
    if (value.x >= 0 && value.x <= 1 && value.y >= 0 && value.y <= 1 && value.z > 0.5f && value.z <= 1)
      continue;
    throw InputError(fmt::format("{}: a pixel is ({}, {}, {}), expected 0 to 1 and blue above 0.5",
                                 path.string(), value.x, value.y, value.z));
  }
  return map;
}

Slide read_slide(const PatternsSpec& patterns, const std::filesystem::path& path) {
  return about("[patterns]", [&] {
    return Slide{read_fractions(path, patterns.encoding), patterns.encoding == Encoding::linear,
                 read_primaries(path, patterns.encoding)};
  });
}

std::vector<Slide> read_slides(const PatternsSpec& patterns, const std::filesystem::path& folder) {
  std::vector<Slide> slides;
  for (const std::string& file : patterns.files) slides.push_back(read_slide(patterns, folder / file));
  return slides;
}

std::shared_ptr<const Image<float>> vignetting_map(const Vignetting& vignetting,
                                                   const std::filesystem::path& folder) {
  if (vignetting.model != VignettingModel::map) return {};
  return std::make_shared<const Image<float>>(read_fractions(folder / vignetting.map, Encoding::linear));
}

}  // namespace laterna
