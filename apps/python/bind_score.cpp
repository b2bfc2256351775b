// Anyone's calibration against a simulated truth.
#include "apps/lab/score/score.h"
#include "apps/python/json_value.h"
#include "apps/python/long_call.h"
#include "apps/python/module.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <optional>

namespace laterna::python {

namespace {

nlohmann::json score_files(const std::filesystem::path& truth_path, const std::filesystem::path& result_path,
                           const ScoreOptions& options, const Progress& progress) {
  const ScoreTruth truth = read_score_truth(truth_path);
  const ScoreResult result = read_score_result(result_path, unsaid_by(truth.scene));
  return score_json(score(truth, result, options, progress), result.rig.notes);
}

pybind11::object score_paths(const std::filesystem::path& truth, const std::filesystem::path& result,
                             const std::optional<std::string>& align, double tolerance_px, std::uint64_t seed,
                             const pybind11::object& progress) {
  ScoreOptions options;
  options.tolerance_px = tolerance_px, options.seed = seed;
  if (align) options.alignment = alignment_of(*align);
  return value_of(
      without_lock([&, tell = progress_to(progress)] { return score_files(truth, result, options, tell); }));
}

}  // namespace

void bind_score(pybind11::module_& module) {
  namespace py = pybind11;
  module.def("score", &score_paths, py::arg("truth"), py::arg("result"), py::arg("align") = std::nullopt,
             py::arg("tolerance_px") = 0.1, py::arg("seed") = 1, py::arg("progress") = py::none(),
             R"(Whether someone's calibration is right, and if not, why.

truth     path of a scene file or a capture folder
result    path of a calibration in any format that `laterna convert` reads
align     what is not judged: "none", "world", "scale" or "world+scale"; None: "world" where the result has a camera
returns   what `laterna score --json` prints: status ("ok", "weak", "refused"), surface_error_px and volume_error_px (rms,
          projector pixels), surface_error_mm, bound, suspects (name, explains), most likely first, and projectors)");
}

}  // namespace laterna::python
