#include "sim/object_build.h"

#include "sim/error.h"
#include "sim/map_files.h"
#include "sim/mesh_file.h"
#include "sim/printed_board.h"
#include "sim/scene_build.h"
#include "sim/scene_heading.h"
#include "sim/shapes.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace laterna {

namespace {

glm::dmat4 affine(const Matrix3x4& rows) {
  glm::dmat4 m(1.0);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) m[j][i] = rows[i][j];
  return m;
}

/// |det A| over the product of the columns' lengths: 1 for orthogonal columns, 0 for a singular map.
double conditioning(const glm::dmat3& a) {
  return std::abs(glm::determinant(a)) / (glm::length(a[0]) * glm::length(a[1]) * glm::length(a[2]));
}

glm::dmat4 placement_of(const MeshSpec& mesh) {
  const MeshSpec unplaced;
  if (!mesh.world_from_object) {
    const glm::dvec3 turn = glm::radians(mesh.rotate_deg);
    glm::dmat4 m = glm::translate(glm::dmat4(1.0), mesh.translate);
    m = glm::rotate(m, turn.z, glm::dvec3(0, 0, 1));
    m = glm::rotate(m, turn.y, glm::dvec3(0, 1, 0));
    m = glm::rotate(m, turn.x, glm::dvec3(1, 0, 0));
    return glm::scale(m, glm::dvec3(mesh.scale));
  }
  if (mesh.scale != unplaced.scale || mesh.rotate_deg != unplaced.rotate_deg ||
      mesh.translate != unplaced.translate) {
    throw InputError(
        "world_from_object is given beside scale, rotate_deg or translate, expected one of the two");
  }
  return affine(*mesh.world_from_object);
}

void expect_near(const Mesh& mesh, const glm::dmat4& world_from_object) {
  for (const glm::dvec3& position : mesh.positions) {
    const glm::dvec3 p(world_from_object * glm::dvec4(position, 1.0));
    if (std::abs(p.x) <= farthest_m && std::abs(p.y) <= farthest_m && std::abs(p.z) <= farthest_m) continue;
    throw InputError(
        fmt::format("a vertex comes to lie at ({}, {}, {}) m, expected within {} m of the origin", p.x, p.y,
                    p.z, farthest_m));
  }
}

void add_normal_map(Object& object, const std::filesystem::path& folder) {
  if (object.effects.normal_map.empty()) return;
  if (object.mesh.texture_coordinates.empty())
    throw InputError("normal_map is given, but the mesh has no texture coordinates");
  object.normal_map =
      std::make_shared<const Image<glm::vec3>>(read_normals(folder / object.effects.normal_map));
}

void add_displacement_map(Object& object, const std::filesystem::path& folder) {
  const std::string& file = object.effects.displacement_map;
  if (file.empty()) return;
  if (object.mesh.texture_coordinates.empty())
    throw InputError("displacement_map is given, but the mesh has no texture coordinates");
  object.displacement_map =
      std::make_shared<const Image<float>>(read_fractions(folder / file, Encoding::linear));
}

Mesh build_mesh(const MeshSpec& spec, const std::filesystem::path& folder) {
  if (!spec.file.empty()) return read_mesh(folder / spec.file);
  if (spec.board.empty()) return make_shape({spec.shape, spec.shape_size, spec.detail, spec.seed});
  const glm::dvec2 size = board_size_m(parse_board(spec.board));
  return plane(size.x, size.y, spec.detail, spec.detail);
}

/// What a print reflects of what its paper does.
std::shared_ptr<const Image<float>> print_of(const std::string& board) {
  constexpr float ink = 0.05f;
  Image<float> print = board_print(parse_board(board));
  for (float& value : print.values) value = ink + (1 - ink) * value;
  return std::make_shared<const Image<float>>(std::move(print));
}

void add_believed_mesh(Object& object, const std::filesystem::path& folder) {
  if (object.belief.file.empty()) return;
  about("believed", [&] {
    const Mesh mesh = read_mesh(folder / object.belief.file);
    expect_near(mesh, object.world_from_object);
    object.believed_mesh = std::make_shared<const Mesh>(mesh);
  });
}

}  // namespace

glm::dmat4 world_from_file(const MeshSpec& mesh) {
  const double metres = metres_per_unit(mesh.unit);
  const glm::dmat4 z_up_from_y_up(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 0, 1, 0), glm::dvec4(0, -1, 0, 0),
                                  glm::dvec4(0, 0, 0, 1));
  const glm::dmat4 turn = mesh.up == UpAxis::y ? z_up_from_y_up : glm::dmat4(1.0);
  const glm::dmat4 m = placement_of(mesh) * turn * glm::scale(glm::dmat4(1.0), glm::dvec3(metres));
  // 1e-9: a map that flattens the mesh to less than that leaves no digits for its surface.
  const double kept = conditioning(glm::dmat3(m));
  if (!(kept > 1e-9)) {
    throw InputError(fmt::format(
        "world_from_object is singular (it keeps {:.3g} of a volume), expected an invertible map", kept));
  }
  return m;
}

Object build_object(const MeshSpec& spec, const std::filesystem::path& folder, AlbedoMaps& maps) {
  Object object{.name = spec.name,
                .mesh = {},
                .world_from_object = world_from_file(spec),
                .albedo = spec.albedo,
                .albedo_map = {},
                .effects = spec.effects,
                .seed = spec.seed,
                .normal_map = {},
                .displacement_map = {},
                .belief = spec.believed,
                .believed_mesh = {}};
  object.mesh = build_mesh(spec, folder);
  if (!spec.board.empty()) object.albedo_map = print_of(spec.board);
  validate(object.mesh, spec.file.empty() ? spec.shape + spec.board : spec.file);
  expect_near(object.mesh, object.world_from_object);
  add_believed_mesh(object, folder);
  add_normal_map(object, folder);
  add_displacement_map(object, folder);
  if (spec.albedo_map.empty()) return object;
  if (object.mesh.texture_coordinates.empty())
    throw InputError("albedo_map is given, but the mesh has no texture coordinates");
  auto& map = maps[{folder / spec.albedo_map, spec.albedo_map_encoding}];
  if (!map) {
    map = std::make_shared<const Image<float>>(
        read_fractions(folder / spec.albedo_map, spec.albedo_map_encoding));
  }
  object.albedo_map = map;
  return object;
}

}  // namespace laterna
