// The parts of the module, one for each noun of the pipeline.
#pragma once

#include "apps/lab/simulation.h"
#include "calib/decode.h"
#include "calib/decode_report.h"
#include "calib/solve.h"
#include "sim/scene_spec.h"

#include <pybind11/pybind11.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace laterna::python {

/// A scene with what its file says. Immutable.
struct SceneAndSpec {
  SceneSpec spec;
  std::filesystem::path folder;
  std::shared_ptr<const Scene> scene;
};

/// A decoded view.
struct Decoded {
  PatternSequence patterns;
  DecodedMap map;
  DecodeReport report;
};

/// One projector as it was recovered.
struct Estimate {
  std::string name;
  std::size_t correspondences = 0;
  SolveResult solve;
  std::vector<std::string> flags;
};

/// Decodes and looks at what is wrong, in anyone's memory.
Decoded decoded(const CapturedView& pictures, const PatternSequence& patterns, const DecodeOptions& options);

/// The index of `name`, or 0 for an empty one where there is but one. Throws InputError otherwise: "the scene
/// has no camera ...".
int index_of(const std::vector<std::string>& names, const std::string& name, const char* kind);
std::vector<std::string> camera_names(const Scene& scene);
std::vector<std::string> projector_names(const Scene& scene);

void bind_scene(pybind11::module_& module);
void bind_capture(pybind11::module_& module);
void bind_decode(pybind11::module_& module);
void bind_calibrate(pybind11::module_& module);
void bind_boards(pybind11::module_& module);
void bind_verify(pybind11::module_& module);
void bind_score(pybind11::module_& module);

}  // namespace laterna::python
