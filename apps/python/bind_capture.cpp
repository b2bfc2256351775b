// Patterns, what cameras see, and the pictures they take.
#include "apps/python/arrays.h"
#include "apps/python/long_call.h"
#include "apps/python/module.h"
#include "render/effects/apply_effects.h"
#include "sim/error.h"
#include "sim/scene_fields.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

namespace laterna::python {

namespace {

PatternKind kind_of(const std::string& name) {
  const auto names = names_of(PatternKind{});
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw InputError(fmt::format("patterns: unknown kind \"{}\", did you mean \"{}\"?", name,
                                 nearest_key(name, std::vector<std::string>(names.begin(), names.end()))));
  return PatternKind(found - names.begin());
}

PatternSequence make_patterns(std::array<int, 2> size, const std::string& kind, int steps, double pitch_px,
                              const std::vector<double>& pitches_px, int xor_stripe_px, int square_px,
                              bool repeat_first) {
  PatternSequence sequence{
      {kind_of(kind), steps, pitch_px, pitches_px, xor_stripe_px, square_px, repeat_first},
      {size[0], size[1]}};
  validate(sequence);
  return sequence;
}

std::vector<std::string> names(const PatternSequence& sequence) {
  std::vector<std::string> all;
  for (int k = 0; k < picture_count(sequence); ++k) all.push_back(picture_name(sequence, k));
  return all;
}

py::array pattern_pictures(const PatternSequence& sequence) {
  const py::ssize_t count = picture_count(sequence), w = sequence.projector_size.x,
                    h = sequence.projector_size.y;
  return array_of(without_lock([&] {
                    std::vector<std::uint8_t> all;
                    for (int k = 0; k < count; ++k) {
                      const Image<std::uint8_t> picture = pattern_picture(sequence, k);
                      all.insert(all.end(), picture.values.begin(), picture.values.end());
                    }
                    return all;
                  }),
                  {count, h, w});
}

// What does not depend on the patterns, shared by all views of it.
struct Held {
  std::shared_ptr<const Scene> scene;
  Traced traced;
};

struct ViewOf {
  std::shared_ptr<const Held> held;
  std::size_t index;
  const View& view() const { return held->traced.views[index]; }
  const Scene& scene() const { return *held->scene; }
  std::string camera() const { return scene().cameras[view().camera].device.name; }
  std::string projector() const { return scene().projectors[view().projector].device.name; }
  PatternSequence patterns() const { return pattern_sequence(scene(), scene().projectors[view().projector]); }
};

struct Capture {
  ViewOf view;
  CapturedStack pictures;
};

std::vector<ViewOf> trace_views(const SceneAndSpec& given, const py::object& progress) {
  const auto held = without_lock([&, tell = progress_to(progress)] {
    StageTimes times;
    return std::shared_ptr<const Held>(new Held{given.scene, trace(*given.scene, times, tell)});
  });
  std::vector<ViewOf> views;
  for (std::size_t i = 0; i < held->traced.views.size(); ++i) views.push_back({held, i});
  return views;
}

Capture capture_of(const ViewOf& view, std::uint64_t seed) {
  return without_lock([&] {
    StageTimes times;
    return Capture{view, capture_view(view.scene(), view.held->traced, view.view(), seed, times)};
  });
}

std::vector<Capture> capture(const SceneAndSpec& scene, std::uint64_t seed, const py::object& progress) {
  std::vector<Capture> captures;
  for (const ViewOf& view : trace_views(scene, progress)) captures.push_back(capture_of(view, seed));
  return captures;
}

py::array pictures(const py::object& self) {
  return std::visit(
      [&](const auto& stack) {
        return array_in(self, stack.values.data(), {stack.count, stack.height, stack.width});
      },
      self.cast<const Capture&>().pictures);
}

template <class T>
py::array map_in(const py::object& owner, const PixelArray<T>& map) {
  return array_in(owner, map.values.data(), {map.height, map.width});
}

void bind_patterns(py::module_& module) {
  const PatternParameters d;
  py::class_<PatternSequence>(module, "Patterns",
                              "What a projector shows so that each of its pixels tells its place.")
      .def(py::init(&make_patterns), py::arg("size"), py::arg("kind") = "gray", py::arg("steps") = d.steps,
           py::arg("pitch_px") = d.pitch_px, py::arg("pitches_px") = d.pitches_px,
           py::arg("xor_stripe_px") = d.xor_stripe_px, py::arg("square_px") = d.square_px,
           py::arg("repeat_first") = d.repeat_first,
           "size: the projector's (width, height) in px. The others are the keys of [patterns] in a scene "
           "file.")
      .def_property_readonly(
          "size",
          [](const PatternSequence& p) { return py::make_tuple(p.projector_size.x, p.projector_size.y); },
          "The projector's (width, height) in px.")
      .def_property_readonly(
          "kind",
          [](const PatternSequence& p) {
            return names_of(p.parameters.kind)[std::size_t(p.parameters.kind)];
          },
          "The family, as scene files name it.")
      .def_property_readonly("names", &names, "What each picture shows, in words.")
      .def("pictures", &pattern_pictures, "The pictures to show: uint8 (pictures, height, width), 0 to 255.")
      .def("__len__", [](const PatternSequence& p) { return picture_count(p); });
}

}  // namespace

void bind_capture(py::module_& module) {
  bind_patterns(module);
  py::class_<ViewOf>(module, "View",
                     "What one camera sees of one projector's light: the truth of each camera pixel. Arrays "
                     "are (height, width) of "
                     "the camera and stand in the view's own memory.")
      .def_property_readonly("camera", &ViewOf::camera, "The camera's name.")
      .def_property_readonly("projector", &ViewOf::projector, "The projector's name.")
      .def_property_readonly("patterns", &ViewOf::patterns, "What the projector shows.")
      .def_property_readonly(
          "u_px",
          [](const py::object& self) { return map_in(self, self.cast<const ViewOf&>().view().light.u_px); },
          "float64: column of the projector at the pixel's centre; NaN where nothing is seen.")
      .def_property_readonly(
          "v_px",
          [](const py::object& self) { return map_in(self, self.cast<const ViewOf&>().view().light.v_px); },
          "float64: row of the projector.")
      .def_property_readonly(
          "white_lx",
          [](const py::object& self) {
            return map_in(self, self.cast<const ViewOf&>().view().light.white_lx);
          },
          "float64: illuminance by the all-white picture, lx; 0 unless lit.")
      .def_property_readonly(
          "lit",
          [](const ViewOf& v) {
            const auto& why = v.view().light.why.values;
            std::vector<std::uint8_t> lit(why.size());
            for (std::size_t i = 0; i < why.size(); ++i) lit[i] = v.view().light.lit(i);
            const py::array bytes = array_of(std::move(lit), {v.view().light.height, v.view().light.width});
            return py::array(bytes.attr("view")("bool"));
          },
          "bool: whether the projector lights it; a copy.")
      .def_property_readonly(
          "depth_m",
          [](const py::object& self) {
            const auto& v = self.cast<const ViewOf&>();
            return map_in(self, v.held->traced.surfaces[v.view().camera].depth_m);
          },
          "float64: along the camera's axis, m; NaN where nothing is seen.")
      .def_property_readonly(
          "points_world",
          [](const py::object& self) {
            const auto& v = self.cast<const ViewOf&>();
            const auto& points = v.held->traced.points_world[v.view().camera];
            return array_in(self, points.values.data(), {points.height, points.width});
          },
          "float64 (height, width, 3), m; NaN where nothing is seen.")
      .def("capture", &capture_of, py::arg("seed") = 1, "Takes the pictures; the seed draws the noise.");
  py::class_<Capture>(module, "Capture", "The pictures of one view.")
      .def_property_readonly("pictures", &pictures,
                             "uint8, or uint16 above 8 bits, (pictures, height, width): digital numbers, in "
                             "the capture's own memory.")
      .def_readonly("view", &Capture::view, "Whose pictures they are, with the truth.")
      .def(
          "decode",
          [](const Capture& c) {
            return without_lock([&] { return decoded(c.pictures, c.view.patterns(), {}); });
          },
          "decode(pictures, view.patterns), from the capture's memory.");
  module.def("trace", &trace_views, py::arg("scene"), py::arg("progress") = py::none(),
             "Every camera's view of every projector, camera by camera. progress: called with a line between "
             "stages.");
  module.def("capture", &capture, py::arg("scene"), py::arg("seed") = 1, py::arg("progress") = py::none(),
             "Traces and takes all pictures, view by view.");
}

}  // namespace laterna::python
