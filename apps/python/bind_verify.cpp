// An estimate against the truth, and the whole round trip.
#include "apps/lab/trial.h"
#include "apps/lab/trial_report.h"
#include "apps/python/arrays.h"
#include "apps/python/json_value.h"
#include "apps/python/long_call.h"
#include "apps/python/module.h"
#include "calib/verify.h"
#include "sim/error.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cmath>

namespace laterna::python {

namespace {

// What run_trial() returns, one for each projector.
struct Outcome {
  std::shared_ptr<const Scene> scene;
  ProjectorOutcome found;
};

std::vector<double> covariance_of(const py::object& estimate) {
  return py::isinstance<Estimate>(estimate) ? estimate.cast<const Estimate&>().solve.covariance
                                            : std::vector<double>{};
}

Device device_of(const py::object& estimate) {
  if (py::isinstance<Device>(estimate)) return estimate.cast<Device>();
  if (!py::isinstance<Estimate>(estimate)) throw InputError("estimate: expected a Device or an Estimate");
  const auto& given = estimate.cast<const Estimate&>();
  if (given.solve.status == Status::refused)
    throw InputError(
        fmt::format("estimate: was refused ({}), so there is nothing to verify", given.solve.reason));
  return given.solve.estimate;
}

Verification verify_estimate(const Device& truth, const py::object& estimate,
                             const py::object& points_world) {
  const py::array array = expect(points_world, {"points_world", {"float64"}, {-1, 3}, "(N, 3)"});
  const Device device = device_of(estimate);
  const std::vector<double> covariance = covariance_of(estimate);
  return without_lock([&] {
    std::vector<glm::dvec3> points(points_in(array).begin(), points_in(array).end());
    std::erase_if(points, [](const glm::dvec3& x) { return !std::isfinite(x.x + x.y + x.z); });
    return verify(truth, device, covariance, points);
  });
}

std::vector<Outcome> roundtrip(const SceneAndSpec& given, std::uint64_t seed, double tolerance_px,
                               bool true_uv, bool known_intrinsics, const py::object& progress) {
  TrialOptions options;
  options.seed = seed;
  options.solve.tolerance_px = tolerance_px;
  options.true_uv = true_uv;
  options.known_intrinsics = known_intrinsics;
  return without_lock([&, tell = progress_to(progress)] {
    StageTimes times;
    const Traced traced = trace(*given.scene, times, tell);
    std::vector<Outcome> outcomes;
    for (ProjectorOutcome& found : run_trial(*given.scene, traced, options, times, {}, tell))
      outcomes.push_back({given.scene, std::move(found)});
    return outcomes;
  });
}

void bind_errors(py::module_& module) {
  py::class_<ErrorSummary>(module, "ErrorSummary", "Errors over a set of points, in projector pixels.")
      .def_readonly("rms", &ErrorSummary::rms, "sqrt(mean(du² + dv²)).")
      .def_readonly("max", &ErrorSummary::max, "The largest.")
      .def_readonly("points", &ErrorSummary::points, "How many.")
      .def_readonly("predicted_rms", &ErrorSummary::predicted_rms,
                    "What noise predicts; NaN without a covariance.")
      .def_readonly("failed", &ErrorSummary::failed, "Points that the estimate cannot project.");
  py::class_<Verification>(module, "Verification", "How far an estimate is from the truth.")
      .def_readonly("surface", &Verification::surface, "Over the points given.")
      .def_readonly("volume", &Verification::volume, "The whole projector image × 5 to 95 % of their depths.")
      .def_readonly("extrapolation", &Verification::extrapolation,
                    "Nearer and farther, from 0.8 × the nearest to 1.25 × the farthest.");
}

}  // namespace

void bind_verify(py::module_& module) {
  bind_errors(module);
  py::class_<Outcome>(module, "Outcome", "How one projector fared in a round trip.")
      .def_property_readonly(
          "name", [](const Outcome& o) { return o.found.name; }, "The projector's name.")
      .def_property_readonly(
          "status", [](const Outcome& o) { return status_word(o.found.solve.status); },
          "\"ok\", \"weak\" or \"refused\", as of Estimate.")
      .def_property_readonly(
          "reason", [](const Outcome& o) { return o.found.solve.reason; }, "Why it is not ok; else empty.")
      .def_property_readonly(
          "estimate",
          [](const Outcome& o) {
            return Estimate{o.found.name, o.found.correspondences, o.found.solve, o.found.flags};
          },
          "The recovered projector; a copy.")
      .def_property_readonly(
          "verification", [](const Outcome& o) { return o.found.verification; },
          "Its errors; of no points where refused.")
      .def_property_readonly(
          "surface_error_px",
          [](const py::object& self) {
            const auto& errors = self.cast<const Outcome&>().found.surface_error_px;
            return array_in(self, errors.data(), {py::ssize_t(errors.size())});
          },
          "float32 (N,): error at each lit camera pixel, in the order of View.lit, view by view.")
      .def_property_readonly(
          "seconds",
          [](const Outcome& o) {
            py::dict seconds;
            for (const auto& stage : o.found.times.stages) seconds[py::str(stage.name)] = stage.seconds;
            return seconds;
          },
          "Wall clock by stage.")
      .def(
          "as_dict",
          [](const Outcome& o) {
            return value_of(trial_json(*o.scene, {o.found}, o.found.times)["projectors"][0]);
          },
          "What `laterna roundtrip --json` prints of it.");
  module.def("verify", &verify_estimate, py::arg("truth"), py::arg("estimate"), py::arg("points_world"),
             "truth: a Device. estimate: a Device, or an Estimate, whose covariance gives predictions. "
             "points_world: float64 (N, 3), "
             "m, points that the true projector lights; rows with NaN are passed over.");
  module.def("roundtrip", &roundtrip, py::arg("scene"), py::arg("seed") = 1,
             py::arg("tolerance_px") = SolveOptions{}.tolerance_px, py::arg("true_uv") = false,
             py::arg("known_intrinsics") = false, py::arg("progress") = py::none(),
             "Patterns, pictures, decoding, solve and comparison with the truth, for each projector. "
             "true_uv: the true places in "
             "place of pictures. known_intrinsics: only the placement is solved for.");
}

}  // namespace laterna::python
