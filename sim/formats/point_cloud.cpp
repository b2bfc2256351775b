#include "sim/formats/point_cloud.h"

#include "sim/error.h"
#include "sim/ply_body.h"
#include "sim/ply_header.h"
#include "sim/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fstream>

namespace laterna {

namespace {

static_assert(std::endian::native == std::endian::little);

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// What of a vertex is kept, in the order of the slots that values go to.
constexpr std::array<std::string_view, 7> kept = {"x",           "y",        "z",       "projector_u",
                                                  "projector_v", "camera_u", "camera_v"};

// The slot of each property; -1: passed over.
std::vector<int> slots_of(const ply::Element& element, const std::string& name) {
  std::vector<int> slots(element.properties.size(), -1);
  std::array<bool, kept.size()> has{};
  for (std::size_t slot = 0; slot < kept.size(); ++slot) {
    const int index = ply::find_property(element, kept[slot]);
    has[slot] = index >= 0 && !element.properties[std::size_t(index)].count_type;
    if (has[slot]) slots[std::size_t(index)] = int(slot);
  }
  if (!has[0] || !has[1] || !has[2])
    throw InputError(name + ": element `vertex` lacks one of the properties x, y and z");
  for (const int u : {3, 5})
    if (has[u] != has[u + 1])
      throw InputError(fmt::format("{}: element `vertex` has one of {} and {}, expected both or neither",
                                   name, kept[u], kept[u + 1]));
  return slots;
}

template <class Body>
CloudPoint read_point(Body& body, const ply::Element& element, const std::vector<int>& slots) {
  std::array<double, kept.size()> values{};
  for (std::size_t p = 0; p < slots.size(); ++p) {
    const ply::Property& property = element.properties[p];
    if (slots[p] < 0) {
      ply::skip(body, property);
      continue;
    }
    const double value = body.number(property.type);
    if (!std::isfinite(value))
      body.fail(fmt::format("`{}` is {}, expected a finite number", property.name, value));
    values[std::size_t(slots[p])] = value;
  }
  return {{values[0], values[1], values[2]}, {values[3], values[4]}, {values[5], values[6]}};
}

template <class Body>
PointCloud read_body(Body body, const ply::Header& header, const std::string& name) {
  PointCloud cloud;
  for (const ply::Element& element : header.elements) {
    if (element.name != "vertex") {
      ply::skip_element(body, element);
      continue;
    }
    const std::vector<int> slots = slots_of(element, name);
    const auto has = [&](int slot) { return std::find(slots.begin(), slots.end(), slot) != slots.end(); };
    cloud.has_projector_px = has(3), cloud.has_camera_px = has(5);
    cloud.points.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      body.begin_record(element, i);
      cloud.points.push_back(read_point(body, element, slots));
      body.end_record();
    }
  }
  body.end_body();
  if (cloud.points.empty())
    throw InputError(name + ": holds no points: element `vertex` is missing or empty");
  return cloud;
}

}  // namespace

PointCloud read_point_cloud(std::string_view bytes, const std::string& name) {
  const ply::Header header = ply::read_header(bytes, name);
  if (header.encoding == ply::Encoding::ascii)
    return read_body(ply::TextBody(bytes, header, name), header, name);
  return read_body(ply::BinaryBody(bytes, header, name), header, name);
}

PointCloud read_point_cloud(const std::filesystem::path& path) {
  return read_point_cloud(read_text(path, std::size_t{4} << 30), path.string());
}

bool is_ply_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 4> head{};
  file.read(head.data(), head.size());
  return file.gcount() == 4 && head[0] == 'p' && head[1] == 'l' && head[2] == 'y' &&
         (head[3] == '\n' || head[3] == '\r');
}

std::string point_cloud_ply(const std::vector<CloudPoint>& points) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty double y\n"
      "property double z\nproperty float projector_u\nproperty float projector_v\nproperty float camera_u\n"
      "property float camera_v\nend_header\n",
      points.size());
  for (const CloudPoint& p : points) {
    for (int i = 0; i < 3; ++i) append(bytes, p.x_world[i]);
    for (const glm::dvec2& pixel : {p.projector_px, p.camera_px})
      for (int i = 0; i < 2; ++i) append(bytes, float(pixel[i]));
  }
  return bytes;
}

}  // namespace laterna
