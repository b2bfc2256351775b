#include "sim/shapes.h"

#include "sim/error.h"
#include "sim/parallel.h"

#include <Random123/philox.h>
#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <tuple>
#include <vector>

namespace laterna {

namespace {

constexpr double pi = glm::pi<double>();
constexpr int max_detail = 4096;

void expect_length(const char* shape, const char* what, double metres) {
  if (std::isfinite(metres) && metres > 0) return;
  throw InputError(fmt::format("{}: {} is {}, expected a finite length above 0", shape, what, metres));
}

void expect_detail(const char* shape, const char* what, int number) {
  if (number >= 1 && number <= max_detail) return;
  throw InputError(fmt::format("{}: {} is {}, expected 1 to {}", shape, what, number, max_detail));
}

/// The triangles of a grid of (columns + 1) × (rows + 1) vertices, row by row, fronts where column × row
/// points.
std::vector<glm::uvec3> grid_triangles(int columns, int rows) {
  std::vector<glm::uvec3> triangles;
  triangles.reserve(std::size_t(2) * columns * rows);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const unsigned a = unsigned(row) * (columns + 1) + column, b = a + 1;
      const unsigned c = a + columns + 1, d = c + 1;
      triangles.emplace_back(a, b, d);
      triangles.emplace_back(a, d, c);
    }
  }
  return triangles;
}

/// Numbers in (0, 1), from the counter alone: Philox 4x32.
std::array<double, 4> uniform_numbers(std::uint64_t seed, std::uint32_t counter) {
  const auto words =
      r123::Philox4x32()({{counter, 0, 0, 0}}, {{std::uint32_t(seed), std::uint32_t(seed >> 32)}});
  std::array<double, 4> numbers{};
  for (std::size_t i = 0; i < 4; ++i) numbers[i] = (words[i] + 0.5) / 4294967296.0;
  return numbers;
}

using Phasors = std::array<std::complex<double>, 32>;  ///< one of each wave

/// Waves Re(amplitude · e^{i k·p}).
struct Waves {
  std::array<glm::dvec2, 32> radians_per_metre;
  Phasors amplitudes;
};

/// Four octaves and a bit of wavelengths, evenly in their logarithm.
Waves draw_waves(double longer_side, std::uint64_t seed) {
  Waves waves;
  constexpr std::size_t count = std::tuple_size_v<Phasors>;
  for (std::size_t i = 0; i < count; ++i) {
    const auto [a, b, c, unused] = uniform_numbers(seed, std::uint32_t(i));
    const double wavelength = longer_side * std::exp2(-4.0 * (double(i) + a) / double(count));
    const double direction = 2 * pi * b;
    waves.radians_per_metre[i] = 2 * pi / wavelength * glm::dvec2(std::cos(direction), std::sin(direction));
    waves.amplitudes[i] = std::polar(wavelength, 2 * pi * c);
  }
  return waves;
}

/// Each wave's e^{i k·p}. That of (x, y) is that of (x, 0) times that of (0, y): a grid takes cosines for its
/// columns and its rows alone.
Phasors phasors_at(const Waves& waves, const glm::dvec2& point) {
  Phasors phasors;
  for (std::size_t i = 0; i < phasors.size(); ++i)
    phasors[i] = std::polar(1.0, glm::dot(waves.radians_per_metre[i], point));
  return phasors;
}

Phasors product(const Phasors& a, const Phasors& b) {
  Phasors products;
  std::transform(a.begin(), a.end(), b.begin(), products.begin(), std::multiplies<>());
  return products;
}

double sum_of_real_products(const Phasors& a, const Phasors& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].real() * b[i].real() - a[i].imag() * b[i].imag();
  return sum;
}

/// Stretches z so that the lowest vertex stands at -depth/2 and the highest at depth/2.
void scale_to_depth(std::vector<glm::dvec3>& positions, double depth) {
  const auto below = [](const glm::dvec3& a, const glm::dvec3& b) { return a.z < b.z; };
  const auto [lowest, highest] = std::minmax_element(positions.begin(), positions.end(), below);
  const double low = lowest->z, range = highest->z - lowest->z;
  for (glm::dvec3& p : positions) p.z = depth * ((p.z - low) / range - 0.5);
}

}  // namespace

Mesh plane(double width, double height, int columns, int rows) {
  expect_length("plane", "the width", width);
  expect_length("plane", "the height", height);
  expect_detail("plane", "the number of columns", columns);
  expect_detail("plane", "the number of rows", rows);
  Mesh mesh;
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) {
      const glm::dvec2 st(double(column) / columns, double(row) / rows);
      mesh.positions.emplace_back(width * (st.x - 0.5), height * (st.y - 0.5), 0.0);
      mesh.texture_coordinates.push_back(st);
    }
  }
  mesh.triangles = grid_triangles(columns, rows);
  return mesh;
}

Mesh box(const glm::dvec3& size, bool inward) {
  for (int axis = 0; axis < 3; ++axis) expect_length("box", "a side", size[axis]);
  Mesh mesh;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const double side = face % 2 == 0 ? 0.5 : -0.5;
    // Seen from the front, right × up points to the viewer.
    const int right = (axis + 1) % 3, up = (axis + 2) % 3;
    const double right_sign = (side > 0) != inward ? 1.0 : -1.0;
    const unsigned first = unsigned(mesh.positions.size());
    for (const glm::dvec2 st : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(1, 1), glm::dvec2(0, 1)}) {
      glm::dvec3 corner(0.0);
      corner[axis] = side * size[axis];
      corner[right] = right_sign * (st.x - 0.5) * size[right];
      corner[up] = (st.y - 0.5) * size[up];
      mesh.positions.push_back(corner);
      mesh.texture_coordinates.push_back(st);
    }
    mesh.triangles.emplace_back(first, first + 1, first + 2);
    mesh.triangles.emplace_back(first, first + 2, first + 3);
  }
  return mesh;
}

Mesh sphere(double radius, int subdivisions) {
  expect_length("sphere", "the radius", radius);
  expect_detail("sphere", "the number of subdivisions", subdivisions);
  const int rows = subdivisions + 1, columns = 2 * rows;
  Mesh mesh;
  for (int row = 0; row <= rows; ++row) {
    const bool pole = row == 0 || row == rows;
    const double latitude = pi * (double(row) / rows - 0.5);
    const double ring = radius * std::cos(latitude);
    const double z = pole ? (row == 0 ? -radius : radius) : radius * std::sin(latitude);
    for (int column = 0; column <= columns; ++column) {
      const double longitude = 2 * pi * (column % columns) / columns;  // the seam: twice the same numbers
      const glm::dvec2 xy =
          pole ? glm::dvec2(0.0) : ring * glm::dvec2(std::cos(longitude), std::sin(longitude));
      mesh.positions.emplace_back(xy, z);
      mesh.texture_coordinates.emplace_back(double(column) / columns, double(row) / rows);
    }
  }
  mesh.triangles = grid_triangles(columns, rows);
  const auto at_pole = [&](const glm::uvec3& t) {  // two of its corners are the same pole
    const auto& p = mesh.positions;
    return p[t[0]] == p[t[1]] || p[t[1]] == p[t[2]] || p[t[2]] == p[t[0]];
  };
  std::erase_if(mesh.triangles, at_pole);
  return mesh;
}

Mesh relief(double width, double height, double depth, int columns, int rows, std::uint64_t seed) {
  expect_length("relief", "the depth", depth);
  Mesh mesh = plane(width, height, columns, rows);
  const Waves waves = draw_waves(std::max(width, height), seed);
  const std::size_t row_size = std::size_t(columns) + 1;
  std::vector<Phasors> of_columns;
  for (std::size_t i = 0; i < row_size; ++i)
    of_columns.push_back(phasors_at(waves, {mesh.positions[i].x, 0}));
  parallel_for(std::size_t(rows) + 1, [&](std::size_t row) {
    glm::dvec3* vertices = &mesh.positions[row * row_size];
    const Phasors of_row = product(waves.amplitudes, phasors_at(waves, {0, vertices->y}));
    for (std::size_t i = 0; i < row_size; ++i) vertices[i].z = sum_of_real_products(of_columns[i], of_row);
  });
  scale_to_depth(mesh.positions, depth);
  return mesh;
}

Mesh v_groove(double width, double height, double opening_deg) {
  expect_length("v_groove", "the width", width);
  if (!(opening_deg > 0 && opening_deg < 180))
    throw InputError(
        fmt::format("v_groove: the opening is {}°, expected above 0 and below 180", opening_deg));
  const double depth = width / 2 / std::tan(glm::radians(opening_deg) / 2);
  Mesh mesh = plane(width, height, 2, 1);
  for (glm::dvec3& p : mesh.positions) p.z = p.x == 0 ? -depth / 2 : depth / 2;
  return mesh;
}

Mesh make_shape(const ShapeSpec& spec) {
  const glm::dvec3& size = spec.size;
  expect_detail(spec.shape.c_str(), "the detail", spec.detail);
  if (spec.shape == "plane") return plane(size.x, size.y, spec.detail, spec.detail);
  if (spec.shape == "box") return box(size);
  if (spec.shape == "sphere") {
    if (size.x != size.y || size.y != size.z)
      throw InputError(fmt::format("sphere: the size is [{}, {}, {}], expected three equal diameters", size.x,
                                   size.y, size.z));
    return sphere(size.x / 2, spec.detail);
  }
  if (spec.shape == "relief") return relief(size.x, size.y, size.z, spec.detail, spec.detail, spec.seed);
  if (spec.shape == "v_groove") {
    expect_length("v_groove", "the depth", size.z);
    return v_groove(size.x, size.y, glm::degrees(2 * std::atan(size.x / 2 / size.z)));
  }
  throw InputError(
      fmt::format("shape \"{}\" is not known, expected one of \"plane\", \"box\", \"sphere\", "
                  "\"relief\", \"v_groove\"",
                  spec.shape));
}

}  // namespace laterna
