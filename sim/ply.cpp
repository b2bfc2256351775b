#include "sim/ply.h"

#include "sim/error.h"
#include "sim/ply_body.h"
#include "sim/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace laterna {

namespace {

using ply::Element;
using ply::find_property;
using ply::list_count;
using ply::Property;
using ply::skip;
using ply::skip_element;

/// Which property goes where: slots 0 to 2 take x, y, z, slots 3 and 4 the texture coordinates, -1 nothing.
struct VertexLayout {
  std::vector<int> slot_of_property;
  bool has_texture = false;
};

VertexLayout layout_of(const Element& element, const std::string& name) {
  VertexLayout layout{std::vector<int>(element.properties.size(), -1), false};
  const auto place = [&](std::string_view property, int slot) {
    const int index = find_property(element, property);
    if (index < 0 || element.properties[std::size_t(index)].count_type) return false;
    layout.slot_of_property[std::size_t(index)] = slot;
    return true;
  };
  if (!place("x", 0) || !place("y", 1) || !place("z", 2))
    throw InputError(name + ": element `vertex` lacks one of the properties x, y and z");
  constexpr std::string_view pairs[][2] = {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}};
  for (const auto& [s, t] : pairs) {
    if (find_property(element, s) < 0 || find_property(element, t) < 0) continue;
    layout.has_texture = place(s, 3) && place(t, 4);
    break;
  }
  return layout;
}

template <class Body>
void read_vertices(Body& body, const Element& element, const std::string& name, Mesh& mesh) {
  const VertexLayout layout = layout_of(element, name);
  mesh.positions.reserve(element.count);
  if (layout.has_texture) mesh.texture_coordinates.reserve(element.count);
  for (std::uint64_t i = 0; i < element.count; ++i) {
    body.begin_record(element, i);
    std::array<double, 5> values{};
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const Property& property = element.properties[p];
      const int slot = layout.slot_of_property[p];
      if (slot < 0) {
        skip(body, property);
        continue;
      }
      const double value = body.number(property.type);
      if (!std::isfinite(value))
        body.fail(fmt::format("`{}` is {}, expected a finite number", property.name, value));
      values[std::size_t(slot)] = value;
    }
    body.end_record();
    mesh.positions.emplace_back(values[0], values[1], values[2]);
    if (layout.has_texture) mesh.texture_coordinates.emplace_back(values[3], values[4]);
  }
}

/// Reads one list of corners and adds the fan of triangles around its first.
template <class Body>
void read_polygon(Body& body, const Property& list, std::uint64_t vertex_count, Mesh& mesh) {
  const std::uint64_t corners = list_count(body, list);
  if (corners < 3) body.fail(fmt::format("a face with {} corners, expected at least 3", corners));
  glm::uvec3 triangle(0U);
  for (std::uint64_t k = 0; k < corners; ++k) {
    const std::int64_t index = body.integer(list.type);
    if (index < 0 || std::uint64_t(index) >= vertex_count)
      body.fail(fmt::format("a corner at vertex {}, but there are {} vertices, counted from 0", index,
                            vertex_count));
    triangle[int(std::min<std::uint64_t>(k, 2))] = unsigned(index);
    if (k < 2) continue;
    mesh.triangles.push_back(triangle);
    triangle[1] = triangle[2];
  }
}

template <class Body>
void read_faces(Body& body, const Element& element, const std::string& name, std::uint64_t vertex_count,
                Mesh& mesh) {
  const int index =
      std::max(find_property(element, "vertex_indices"), find_property(element, "vertex_index"));
  const Property* list = index < 0 ? nullptr : &element.properties[std::size_t(index)];
  if (!list || !list->count_type || !ply::is_integer(list->type))
    throw InputError(name + ": element `face` has no list of integers named vertex_indices or vertex_index");
  mesh.triangles.reserve(element.count);
  for (std::uint64_t i = 0; i < element.count; ++i) {
    body.begin_record(element, i);
    for (const Property& property : element.properties) {
      if (&property == list) {
        read_polygon(body, property, vertex_count, mesh);
      } else {
        skip(body, property);
      }
    }
    body.end_record();
  }
}

const Element& element_named(const ply::Header& header, std::string_view wanted, const std::string& name) {
  for (const Element& element : header.elements)
    if (element.name == wanted) return element;
  throw InputError(fmt::format("{}: the header has no element `{}`, expected vertex and face", name, wanted));
}

template <class Body>
Mesh read_body(Body body, const ply::Header& header, const std::string& name) {
  const Element& vertices = element_named(header, "vertex", name);
  const Element& faces = element_named(header, "face", name);
  if (vertices.count > std::numeric_limits<std::uint32_t>::max())
    throw InputError(fmt::format("{}: {} vertices, expected at most 4294967295", name, vertices.count));
  Mesh mesh;
  for (const Element& element : header.elements) {
    if (&element == &vertices) {
      read_vertices(body, element, name, mesh);
    } else if (&element == &faces) {
      read_faces(body, element, name, vertices.count, mesh);
    } else {
      skip_element(body, element);
    }
  }
  body.end_body();
  return mesh;
}

template <class T>
void append_little_endian(std::string& bytes, T value) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

}  // namespace

Mesh read_ply(std::string_view bytes, const std::string& name) {
  const ply::Header header = ply::read_header(bytes, name);
  if (header.encoding == ply::Encoding::ascii)
    return read_body(ply::TextBody(bytes, header, name), header, name);
  return read_body(ply::BinaryBody(bytes, header, name), header, name);
}

std::string ply_bytes(const Mesh& mesh) {
  const bool has_texture = !mesh.texture_coordinates.empty();
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
      "property double x\nproperty double y\nproperty double z\n{}"
      "element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
      mesh.positions.size(), has_texture ? "property double s\nproperty double t\n" : "",
      mesh.triangles.size());
  bytes.reserve(bytes.size() + mesh.positions.size() * (has_texture ? 40 : 24) + mesh.triangles.size() * 13);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) append_little_endian(bytes, mesh.positions[i][axis]);
    if (!has_texture) continue;
    for (int axis = 0; axis < 2; ++axis) append_little_endian(bytes, mesh.texture_coordinates[i][axis]);
  }
  for (const glm::uvec3& triangle : mesh.triangles) {
    append_little_endian(bytes, std::uint8_t(3));
    for (int corner = 0; corner < 3; ++corner) append_little_endian(bytes, std::uint32_t(triangle[corner]));
  }
  return bytes;
}

}  // namespace laterna
