// Scene, Device and Mesh.
#include "apps/python/arrays.h"
#include "apps/python/long_call.h"
#include "apps/python/module.h"
#include "apps/python/scene_fields.h"
#include "sim/error.h"
#include "sim/new_scene.h"
#include "sim/scene_file.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <limits>

namespace laterna::python {

namespace {

SceneAndSpec load(const std::filesystem::path& file, const py::object& overrides) {
  const std::vector<std::string> texts = overrides_of(overrides);
  return without_lock([&] {
    return SceneAndSpec{with_names(read_scene_spec(file, texts)), file.parent_path(),
                        std::make_shared<const Scene>(load_scene(file, texts))};
  });
}

SceneAndSpec built(SceneSpec spec, const std::filesystem::path& folder) {
  auto scene = std::make_shared<const Scene>(build_scene(spec, folder));
  return {with_names(std::move(spec)), folder, std::move(scene)};
}

SceneAndSpec parse(const std::string& text, const std::filesystem::path& folder,
                   const py::object& overrides) {
  const std::vector<std::string> texts = overrides_of(overrides);
  return without_lock([&] { return built(parse_scene(text, "scene", texts), folder); });
}

SceneAndSpec changed(const SceneAndSpec& from, const py::object& overrides) {
  const std::vector<std::string> texts = overrides_of(overrides);
  return without_lock([&] { return built(parse_scene(scene_toml(from.spec), "scene", texts), from.folder); });
}

Device make_device(std::array<int, 2> size, double fx, double fy, double cx, double cy,
                   const py::object& device_from_world, const std::string& lens_model,
                   const std::vector<double>& lens_parameters, const std::string& name) {
  Device device{name, {{size[0], size[1]}, fx, fy, cx, cy}, {}, {lens_model, lens_parameters}, {}};
  if (!device_from_world.is_none()) {
    const py::array rows =
        expect(device_from_world, {"device_from_world", {"float64"}, {3, 4}, "(3, 4): [R | t]"});
    Matrix3x4 numbers{};
    std::copy_n(static_cast<const double*>(rows.data()), 12, numbers[0].data());
    device.device_from_world = rigid_from_rows(numbers, "device_from_world");
  }
  validate(device);
  return device;
}

py::array placement(const Device& device) {
  py::array_t<double> rows({3, 4});
  const Matrix3x4 from = rows_of(device.device_from_world);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) rows.mutable_at(i, j) = from[i][j];
  return rows;
}

py::array camera_matrix(const Device& device) {
  const Intrinsics& k = device.intrinsics;
  return matrix_of(glm::transpose(glm::dmat3(k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1)));
}

py::array project(const Device& device, const py::object& points_world) {
  const py::array array = expect(points_world, {"points_world", {"float64"}, {-1, 3}, "(N, 3)"});
  const auto points = points_in(array);
  return array_of(without_lock([&] {
                    const WorldProjection projection(device);
                    std::vector<glm::dvec3> pixels(points.size());
                    std::transform(points.begin(), points.end(), pixels.begin(),
                                   [&](const glm::dvec3& x) { return projection.project(x); });
                    return pixels;
                  }),
                  {py::ssize_t(points.size())});
}

py::array unproject(const Device& device, const py::object& pixels, const py::object& depths_m) {
  const py::array pixel_array = expect(pixels, {"pixels", {"float64"}, {-1, 2}, "(N, 2)"});
  const py::array depth_array = expect(
      depths_m, {"depths_m", {"float64"}, {pixel_array.shape(0)}, "(N,), a depth for each of the pixels"});
  const auto at = pixels_in(pixel_array);
  const auto* depth = static_cast<const double*>(depth_array.data());
  return array_of(without_lock([&] {
                    const WorldProjection projection(device);
                    const glm::dvec3 nowhere(std::numeric_limits<double>::quiet_NaN());
                    std::vector<glm::dvec3> points(at.size());
                    for (std::size_t i = 0; i < at.size(); ++i)
                      points[i] = projection.unproject(at[i], depth[i]).value_or(nowhere);
                    return points;
                  }),
                  {py::ssize_t(at.size())});
}

// A mesh is a part of its scene, and keeps it.
struct MeshOf {
  std::shared_ptr<const Scene> scene;
  const Object* object;
};

void bind_mesh(py::module_& module) {
  py::class_<MeshOf>(module, "Mesh",
                     "A triangle mesh of a scene; arrays are the scene's own memory, read-only.")
      .def_property_readonly(
          "name", [](const MeshOf& m) { return m.object->name; }, "Its name.")
      .def_property_readonly(
          "positions",
          [](const py::object& self) {
            const Mesh& mesh = self.cast<const MeshOf&>().object->mesh;
            return read_only(array_in(self, mesh.positions.data(), {py::ssize_t(mesh.positions.size())}));
          },
          "Vertices, float64 (N, 3), metres, in the object's frame.")
      .def_property_readonly(
          "triangles",
          [](const py::object& self) {
            const Mesh& mesh = self.cast<const MeshOf&>().object->mesh;
            return read_only(array_in(self, reinterpret_cast<const std::uint32_t*>(mesh.triangles.data()),
                                      {py::ssize_t(mesh.triangles.size()), 3}));
          },
          "Indices of vertices, uint32 (M, 3), counter-clockwise as seen from the front.")
      .def_property_readonly(
          "world_from_object", [](const MeshOf& m) { return matrix_of(m.object->world_from_object); },
          "float64 (4, 4), affine.");
}

void bind_device(py::module_& module) {
  py::class_<Device>(module, "Device",
                     "A projector or a camera: pinhole, lens and place. Frame: x right, y down, z forward; "
                     "pixels have integer coordinates at their centres.")
      .def(py::init(&make_device), py::arg("size"), py::arg("fx"), py::arg("fy"), py::arg("cx"),
           py::arg("cy"), py::arg("device_from_world") = py::none(), py::arg("lens_model") = Lens{}.model,
           py::arg("lens_parameters") = std::vector<double>{}, py::arg("name") = "",
           "size: (width, height) in px. fx, fy, cx, cy: px. device_from_world: float64 (3, 4), [R | t], m; "
           "None: the identity. lens_model: mrcal's, its parameters as those that follow fx, fy, cx, cy.")
      .def_readonly("name", &Device::name, "Its name in the scene.")
      .def_property_readonly(
          "size", [](const Device& d) { return py::make_tuple(d.intrinsics.size.x, d.intrinsics.size.y); },
          "(width, height) in px.")
      .def_property_readonly("K", &camera_matrix,
                             "float64 (3, 3): [[fx, 0, cx], [0, fy, cy], [0, 0, 1]], px.")
      .def_property_readonly("device_from_world", &placement, "float64 (3, 4): [R | t], m.")
      .def_property_readonly(
          "lens_model", [](const Device& d) { return d.lens.model; }, "mrcal's name.")
      .def_property_readonly(
          "lens_parameters", [](const Device& d) { return d.lens.parameters; },
          "Those that follow fx, fy, cx, cy, in mrcal's order.")
      .def_property_readonly(
          "T", [](const Device& d) { return matrix_of(texture_from_world(d)); },
          "texture_from_world = B·P·V, float64 (4, 4): (s, t, r, q) = T·(x, y, z, 1).")
      .def_property_readonly(
          "B", [](const Device&) { return matrix_of(texture_from_clip()); },
          "texture_from_clip, float64 (4, 4).")
      .def_property_readonly(
          "P", [](const Device& d) { return matrix_of(clip_from_projector(d.intrinsics, d.planes)); },
          "clip_from_projector, float64 (4, 4).")
      .def_property_readonly(
          "V", [](const Device& d) { return matrix_of(projector_from_world(d.device_from_world)); },
          "projector_from_world, float64 (4, 4): x right, y up, looking along -z.")
      .def("project", &project, py::arg("points_world"),
           "points_world: float64 (N, 3), m. Returns float64 (N, 3): pixel u and v, axial depth q in m; u "
           "and v "
           "are NaN where q <= 0 or the lens fails.")
      .def("unproject", &unproject, py::arg("pixels"), py::arg("depths_m"),
           "pixels: float64 (N, 2). depths_m: float64 (N,), axial, m. Returns world points, float64 (N, 3), "
           "m; "
           "NaN where the lens fails.");
}

std::vector<MeshOf> meshes(const SceneAndSpec& s) {
  std::vector<MeshOf> all;
  for (const Object& object : s.scene->objects) all.push_back({s.scene, &object});
  return all;
}

}  // namespace

int index_of(const std::vector<std::string>& names, const std::string& name, const char* kind) {
  if (name.empty() && names.size() == 1) return 0;
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw InputError(
        fmt::format("the scene has no {} \"{}\", expected one of: {}", kind, name, fmt::join(names, ", ")));
  return int(found - names.begin());
}

std::vector<std::string> camera_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Camera& camera : scene.cameras) names.push_back(camera.device.name);
  return names;
}

std::vector<std::string> projector_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Projector& projector : scene.projectors) names.push_back(projector.device.name);
  return names;
}

void bind_scene(py::module_& module) {
  bind_mesh(module);
  bind_device(module);
  py::class_<SceneAndSpec>(module, "Scene",
                           "Meshes, projectors, cameras and patterns: what a scene file says.")
      .def_property_readonly(
          "toml", [](const SceneAndSpec& s) { return scene_toml(s.spec); },
          "The scene as a scene file's text.")
      .def_property_readonly(
          "fields", [](const SceneAndSpec& s) { return fields_of(s.spec); },
          "Every field as nested dictionaries and lists, keys as in the file; a copy.")
      .def(
          "__getitem__",
          [](const SceneAndSpec& s, const std::string& path) { return field_at(s.spec, path); },
          py::arg("path"), "The field at a path such as \"projector.0.fx\" or \"camera.sensor.bit_depth\".")
      .def(
          "changed", &changed, py::arg("overrides"),
          "Another scene with some fields changed: {\"camera.sensor.bit_depth\": 12}, or [\"ambient_lx=3\"].")
      .def_property_readonly("meshes", &meshes, "Its meshes.")
      .def_property_readonly(
          "projectors",
          [](const SceneAndSpec& s) {
            std::vector<Device> devices;
            for (const Projector& projector : s.scene->projectors) devices.push_back(projector.device);
            return devices;
          },
          "The true projectors, as devices.")
      .def_property_readonly(
          "cameras",
          [](const SceneAndSpec& s) {
            std::vector<Device> devices;
            for (const Camera& camera : s.scene->cameras) devices.push_back(camera.device);
            return devices;
          },
          "The true cameras, as devices.");
  module.def("load", &load, py::arg("path"), py::arg("overrides") = py::none(),
             "Reads a scene file with the files it names. overrides: as of Scene.changed.");
  module.def("parse", &parse, py::arg("text"), py::arg_v("folder", std::filesystem::path("."), "'.'"),
             py::arg("overrides") = py::none(),
             "A scene from a scene file's text; files are looked for in `folder`.");
  module.def("new_scene", &new_scene_text, "The text of a commented scene that needs no other file.");
}

}  // namespace laterna::python
