// Projector pixels and a known scene, or points, to projectors.
#include "apps/lab/told_points.h"
#include "apps/lab/trial.h"
#include "apps/lab/trial_report.h"
#include "apps/python/arrays.h"
#include "apps/python/json_value.h"
#include "apps/python/long_call.h"
#include "apps/python/module.h"
#include "sim/error.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

namespace laterna::python {

namespace {

SolveOptions options_of(double tolerance_px, const std::string& loss, const std::optional<Device>& known,
                        std::uint64_t seed) {
  SolveOptions options;
  if (!(tolerance_px > 0))
    throw InputError(fmt::format("tolerance_px is {}, expected a number above 0", tolerance_px));
  options.tolerance_px = tolerance_px;
  options.seed = seed;
  if (loss == "huber")
    options.loss.kind = RobustLoss::Kind::huber;
  else if (loss == "cauchy")
    options.loss.kind = RobustLoss::Kind::cauchy;
  else if (loss != "none")
    throw InputError(fmt::format("loss: found \"{}\", expected none, huber or cauchy", loss));
  if (known) options.known = KnownIntrinsics{known->intrinsics, known->lens};
  return options;
}

Estimate solved(std::string name, const Correspondences& c, glm::ivec2 size, const SolveOptions& options) {
  Estimate estimate{std::move(name), c.world_points.size(), {}, {}};
  if (c.world_points.empty())
    estimate.solve.reason = "no overlap: no camera pixel sees light of this projector that could be decoded";
  else
    estimate.solve = solve(c, size, options);
  estimate.solve.estimate.name = estimate.name;
  return estimate;
}

void check_size(const Scene& scene, int camera, const DecodedMap& map) {
  const glm::ivec2 size = scene.cameras[camera].device.intrinsics.size;
  if (size != glm::ivec2(map.width, map.height))
    throw InputError(fmt::format("decoded: {} × {} px, expected those of camera \"{}\", {} × {}", map.width,
                                 map.height, scene.cameras[camera].device.name, size.x, size.y));
}

using DecodedByCamera = std::map<std::string, const Decoded*>;

Estimate calibrate(const SceneAndSpec& given, const DecodedByCamera& views, const std::string& projector,
                   SolveOptions options) {
  const Scene& scene = *given.scene;
  const int p = index_of(projector_names(scene), projector, "projector");
  options.lens_model = scene.projectors[p].device.lens.model;
  const ToldScene told(scene);
  Correspondences correspondences;
  correspondences.cameras = told_cameras(scene);
  std::vector<std::string> flags, doubts;
  for (const auto& [name, decoded] : views) {
    const int camera = index_of(camera_names(scene), name, "camera");
    check_size(scene, camera, decoded->map);
    append_correspondences(decoded->map, told.trace(camera), camera, TrialOptions{}.block_px,
                           correspondences);
    flags.insert(flags.end(), decoded->report.flags.begin(), decoded->report.flags.end());
    doubts.insert(doubts.end(), decoded->report.doubts.begin(), decoded->report.doubts.end());
  }
  const glm::ivec2 size = views.begin()->second->patterns.projector_size;
  Estimate estimate = solved(scene.projectors[p].device.name, correspondences, size, options);
  add_doubts(estimate.solve, doubts);
  estimate.flags = flags;
  return estimate;
}

Estimate calibrate_views(const SceneAndSpec& scene, const py::object& decoded, const std::string& projector,
                         double tolerance_px, const std::string& loss, const std::optional<Device>& known,
                         std::uint64_t seed) {
  const SolveOptions options = options_of(tolerance_px, loss, known, seed);
  DecodedByCamera views;
  if (py::isinstance<Decoded>(decoded)) {
    views[""] = &decoded.cast<const Decoded&>();
  } else if (py::isinstance<py::dict>(decoded) && py::len(decoded) > 0) {
    for (const auto& [name, map] : py::reinterpret_borrow<py::dict>(decoded)) {
      if (!py::isinstance<Decoded>(map))
        throw InputError("decoded: expected a Decoded for each camera's name");
      views[name.cast<std::string>()] = &map.cast<const Decoded&>();
    }
  } else {
    throw InputError("decoded: expected a Decoded, or a dictionary of them by the cameras' names");
  }
  return without_lock([&] { return calibrate(scene, views, projector, options); });
}

Estimate calibrate_points(const py::object& points_world, const py::object& pixels,
                          const py::object& sigma_px, std::array<int, 2> size, const std::string& lens_model,
                          double tolerance_px, const std::string& loss, const std::optional<Device>& known,
                          std::uint64_t seed) {
  const py::array points = expect(points_world, {"points_world", {"float64"}, {-1, 3}, "(N, 3)"});
  const Shape same{points.shape(0)};
  const py::array uv =
      expect(pixels, {"pixels", {"float64"}, {same[0], 2}, "(N, 2), a pixel for each of the points"});
  const py::array sigma =
      expect(sigma_px, {"sigma_px", {"float64"}, same, "(N,), one for each of the points"});
  SolveOptions options = options_of(tolerance_px, loss, known, seed);
  options.lens_model = lens_model;
  return without_lock([&] {
    Correspondences c;
    c.world_points.assign(points_in(points).begin(), points_in(points).end());
    c.projector_pixels.assign(pixels_in(uv).begin(), pixels_in(uv).end());
    const auto* s = static_cast<const double*>(sigma.data());
    c.sigma_px.assign(s, s + same[0]);
    return solved("", c, {size[0], size[1]}, options);
  });
}

void bind_estimate(py::module_& module) {
  py::class_<Estimate>(module, "Estimate", "One projector as it was recovered, with how sure that is.")
      .def_readonly("name", &Estimate::name, "The projector's name.")
      .def_property_readonly(
          "status", [](const Estimate& e) { return status_word(e.solve.status); },
          "\"ok\": believe it. \"weak\": the data tell less than was asked. \"refused\": no estimate.")
      .def_property_readonly(
          "reason", [](const Estimate& e) { return e.solve.reason; }, "Why it is not ok; else empty.")
      .def_readonly("flags", &Estimate::flags, "What looks wrong in the pictures.")
      .def_readonly("correspondences", &Estimate::correspondences, "How many points were used.")
      .def_property_readonly(
          "device",
          [](const Estimate& e) -> std::optional<Device> {
            if (e.solve.status == Status::refused) return {};
            return e.solve.estimate;
          },
          "The recovered projector; None where refused.")
      .def_property_readonly(
          "sigma",
          [](const Estimate& e) {
            py::dict sigma;
            for (std::size_t i = 0; i < e.solve.sigma.size(); ++i)
              sigma[py::str(e.solve.parameter_names[i])] = e.solve.sigma[i];
            return sigma;
          },
          "Standard deviation by parameter: px, rad, m.")
      .def_property_readonly(
          "covariance",
          [](const py::object& self) {
            const SolveResult& s = self.cast<const Estimate&>().solve;
            const auto p = py::ssize_t(s.parameter_names.size());
            return array_in(self, s.covariance.data(), {p, s.covariance.empty() ? 0 : p});
          },
          "float64 (p, p), in the order of `sigma`: fx, fy, cx, cy (px), lens, rotation (rad), translation "
          "(m).")
      .def_property_readonly(
          "fit_rms_px", [](const Estimate& e) { return e.solve.fit_rms_px; },
          "sqrt(mean(du² + dv²)) of the residuals; no measure of accuracy.")
      .def_property_readonly(
          "predicted_volume_rms_px", [](const Estimate& e) { return e.solve.predicted_volume_rms_px; },
          "The error over the lit volume that noise alone predicts.")
      .def(
          "as_dict", [](const Estimate& e) { return value_of(estimate_json(e.name, e.solve)); },
          "What `laterna calibrate -o` writes of it.");
}

}  // namespace

void bind_calibrate(py::module_& module) {
  const SolveOptions d;
  bind_estimate(module);
  module.def("calibrate", &calibrate_views, py::arg("scene"), py::arg("decoded"), py::arg("projector") = "",
             py::arg("tolerance_px") = d.tolerance_px, py::arg("loss") = "none",
             py::arg("known") = py::none(), py::arg("seed") = d.seed,
             "A projector from decoded views and the scene's meshes and cameras as they are believed. "
             "decoded: a Decoded, or a "
             "dictionary of them by the cameras' names. known: a Device whose intrinsics and lens are held. "
             "Of the scene's own "
             "projector only the lens model is used.");
  module.def("calibrate_points", &calibrate_points, py::arg("points_world"), py::arg("pixels"),
             py::arg("sigma_px"), py::arg("size"), py::arg("lens_model") = d.lens_model,
             py::arg("tolerance_px") = d.tolerance_px, py::arg("loss") = "none",
             py::arg("known") = py::none(), py::arg("seed") = d.seed,
             "A projector from world points, float64 (N, 3), m, and its pixels, float64 (N, 2), each "
             "coordinate with the "
             "standard deviation sigma_px, float64 (N,). size: (width, height).");
}

}  // namespace laterna::python
