#include "sim/scene_build.h"

#include "sim/believed.h"
#include "sim/device_spec.h"
#include "sim/effect_checks.h"
#include "sim/error.h"
#include "sim/image_file.h"
#include "sim/mesh_file.h"
#include "sim/plain_name.h"
#include "sim/printed_board.h"
#include "sim/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <set>
#include <utility>

namespace laterna {

namespace {

std::string heading(const char* kind, const std::string& name) {
  return name.empty() ? fmt::format("[[{}]]", kind) : fmt::format("[[{}]] \"{}\"", kind, name);
}

/// Runs `action`; an InputError gets `what` in front.
template <class Action>
auto about(const std::string& what, Action&& action) {
  try {
    return action();
  } catch (const InputError& error) {
    throw InputError(what + ": " + error.what());
  }
}

void check_device(const DeviceSpec& device, const char* kind) {
  const std::string what = heading(kind, device.name);
  if (device.cameramodel.empty())
    device_of(device, {}, what);
  else
    check_ways(device, what);
}

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

/// Albedo maps by file and encoding, so that meshes share them.
using Maps = std::map<std::pair<std::filesystem::path, Encoding>, std::shared_ptr<const Image<float>>>;

Image<float> read_fractions(const std::filesystem::path& path, Encoding encoding) {
  Image<float> map = read_grey_float(path, encoding);
  for (const float value : map.values) {
    if (!(value >= 0 && value <= 1))
      throw InputError(fmt::format("{}: a pixel is {}, expected 0 to 1", path.string(), value));
  }
  return map;
}

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

/// Whether each projector can show the sequence; behind a scaler, another size is asked for when it does.
void check_patterns(const Scene& scene) {
  if (scene.effects.scaler) return;
  for (const Projector& projector : scene.projectors)
    about(heading("projector", projector.device.name), [&] {
      validate(PatternSequence{scene.patterns, projector.device.intrinsics.size});
    });
}

std::shared_ptr<const Image<float>> vignetting_map(const Vignetting& vignetting,
                                                   const std::filesystem::path& folder) {
  if (vignetting.model != VignettingModel::map) return {};
  return std::make_shared<const Image<float>>(read_fractions(folder / vignetting.map, Encoding::linear));
}

std::shared_ptr<const Image<glm::vec3>> read_normal_map(const std::filesystem::path& path) {
  auto map = std::make_shared<const Image<glm::vec3>>(read_rgb_float(path, Encoding::linear));
  for (const glm::vec3& value : map->values) {
    // A normal along or below the surface is none.
    if (value.x >= 0 && value.x <= 1 && value.y >= 0 && value.y <= 1 && value.z > 0.5f && value.z <= 1)
      continue;
    throw InputError(fmt::format("{}: a pixel is ({}, {}, {}), expected 0 to 1 and blue above 0.5",
                                 path.string(), value.x, value.y, value.z));
  }
  return map;
}

void add_normal_map(Object& object, const std::filesystem::path& folder) {
  if (object.effects.normal_map.empty()) return;
  if (object.mesh.texture_coordinates.empty())
    throw InputError("normal_map is given, but the mesh has no texture coordinates");
  object.normal_map = read_normal_map(folder / object.effects.normal_map);
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

Object build_object(const MeshSpec& spec, const std::filesystem::path& folder, Maps& maps) {
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

template <class Spec>
int index_of(const std::vector<Spec>& devices, const std::string& name) {
  return int(
      std::find_if(devices.begin(), devices.end(), [&](const Spec& d) { return d.device.name == name; }) -
      devices.begin());
}

ColourMixing build_mixing(const ColourSpec& spec, const SceneSpec& named) {
  ColourMixing mixing{index_of(named.projectors, spec.projector), index_of(named.cameras, spec.camera), {}};
  for (int i = 0; i < 9; ++i) mixing.channels[i / 3][i % 3] = spec.mixing[i];
  return mixing;
}

template <class Spec>
void name_devices(std::vector<Spec>& devices, const char* kind) {
  for (std::size_t i = 0; i < devices.size(); ++i) {
    std::string& name = devices[i].device.name;
    if (name.empty()) name = devices.size() == 1 ? kind : fmt::format("{}{}", kind, i + 1);
  }
}

void switch_off_lenses(Scene& scene) {
  if (!scene.effects.projector_lens)
    for (Projector& projector : scene.projectors) projector.device.lens = {};
  if (!scene.effects.camera_lens)
    for (Camera& camera : scene.cameras) camera.device.lens = {};
}

std::string mesh_name(const MeshSpec& mesh) {
  if (!mesh.board.empty()) return "board";
  if (mesh.file.empty()) return mesh.shape;
  std::filesystem::path stem = std::filesystem::path(mesh.file).filename();
  if (stem.extension() == ".gz") stem = stem.stem();
  return stem.stem().string();
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

void check(const MeshSpec& mesh) {
  about(heading("mesh", mesh.name), [&] {
    const int given = int(!mesh.file.empty()) + int(!mesh.shape.empty()) + int(!mesh.board.empty());
    if (given != 1)
      throw InputError(fmt::format("{} of file, shape and board are given, expected one", given));
    if (!mesh.board.empty()) {
      parse_board(mesh.board);
      if (!mesh.albedo_map.empty()) throw InputError("albedo_map is given for a board, which has a print");
    }
    world_from_file(mesh);
    check(mesh.effects, mesh.albedo);
  });
}

void check(const ProjectorSpec& projector) {
  check_device(projector.device, "projector");
  about(heading("projector", projector.device.name), [&] { check(projector.effects); });
}

void check(const CameraSpec& camera) {
  check_device(camera.device, "camera");
  about(heading("camera", camera.device.name), [&] { check(camera.vignetting); });
}

void check(const ColourSpec& colour) {
  if (colour.projector.empty() || colour.camera.empty())
    throw InputError("[[colour]]: the key projector or camera is missing, expected the names of both");
  if (colour.mixing.size() != 9)
    throw InputError(fmt::format("[[colour]]: mixing has {} numbers, expected 9", colour.mixing.size()));
}

void check(const SceneSpec& scene) {
  if (scene.meshes.empty()) throw InputError("there is no [[mesh]], expected at least one");
  check_effects(scene);
  const SceneSpec named = with_names(scene);
  std::set<std::string> names;
  for (const MeshSpec& mesh : named.meshes) check_plain_name(mesh.name, heading("mesh", ""));
  const auto add = [&](const char* kind, const std::string& name) {
    check_plain_name(name, heading(kind, ""));
    if (!names.insert(name).second)
      throw InputError(fmt::format("{}: the name is taken by another device, expected one of its own",
                                   heading(kind, name)));
  };
  for (const ProjectorSpec& projector : named.projectors) add("projector", projector.device.name);
  for (const CameraSpec& camera : named.cameras) add("camera", camera.device.name);
  check_references(named);
}

SceneSpec with_names(SceneSpec spec) {
  for (MeshSpec& mesh : spec.meshes)
    if (mesh.name.empty()) mesh.name = mesh_name(mesh);
  name_devices(spec.projectors, "projector");
  name_devices(spec.cameras, "camera");
  return spec;
}

Scene build_scene(const SceneSpec& spec, const std::filesystem::path& folder) {
  check(spec);
  Scene scene{.objects = {},
              .projectors = {},
              .cameras = {},
              .ambient_lx = spec.ambient_lx,
              .patterns = spec.patterns.parameters,
              .effects = spec.effects,
              .inter_reflection = spec.inter_reflection,
              .slide = {},
              .pictures = {},
              .pattern_colour = spec.patterns.colour,
              .mixings = {},
              .timing = spec.timing,
              .believe_truth = spec.believe_truth};
  const SceneSpec named = with_names(spec);
  Maps maps;
  for (const MeshSpec& mesh : named.meshes) {
    check(mesh);
    scene.objects.push_back(
        about(heading("mesh", mesh.name), [&] { return build_object(mesh, folder, maps); }));
  }
  for (const ProjectorSpec& p : named.projectors) {
    const std::string what = heading("projector", p.device.name);
    check(p);
    scene.projectors.push_back({device_of(p.device, folder, what), p.flux_lm, p.lookup, p.border, p.effects,
                                about(what, [&] { return vignetting_map(p.effects.vignetting, folder); })});
  }
  for (const CameraSpec& c : named.cameras) {
    const std::string what = heading("camera", c.device.name);
    check(c);
    scene.cameras.push_back({device_of(c.device, folder, what), c.sensor, c.vignetting,
                             about(what, [&] { return vignetting_map(c.vignetting, folder); }),
                             c.samples_per_pixel, c.optics, c.colour_filter, c.veiling_glare, c.believed});
    about(what + ": believed", [&] { believed_device(scene.cameras.back()); });
  }
  switch_off_lenses(scene);
  if (spec.effects.slide)
    scene.slide = std::make_shared<const Slide>(read_slide(spec.patterns, folder / spec.patterns.file));
  if (spec.patterns.parameters.kind == PatternKind::pictures)
    scene.pictures = std::make_shared<const std::vector<Slide>>(read_slides(spec.patterns, folder));
  check_patterns(scene);
  for (const ColourSpec& c : named.colours) scene.mixings.push_back(build_mixing(c, named));
  return scene;
}

}  // namespace laterna
