// sample.json: what a sample is, for machines.
#pragma once

#include "apps/lab/dataset/drawn_scene.h"
#include "apps/lab/dataset/sight.h"
#include "sim/capture_folder.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace laterna {

/// A sample before it is written down.
struct DrawnSample {
  std::string key;  ///< "00000012"
  std::uint64_t seed = 0, index = 0, capture_seed = 0;
  std::map<std::string, int> rejected;  ///< attempts thrown away before, by reason (sight.h)
  DrawnValues drawn;
  SceneSpec spec;
  std::vector<Sight> sights;  ///< camera by camera, projector by projector
};

/// The record; `scene` is of sample.spec, the manifest of its capture.
nlohmann::json sample_record(const DrawnSample& sample, const Scene& scene, const CaptureManifest& manifest);

/// Names of files of one view, relative to the sample.
std::string truth_file(const std::string& camera, const std::string& projector);
std::string mask_file(const std::string& camera, const std::string& projector);
std::string correspondence_file(const std::string& camera, const std::string& projector);

/// The record's JSON Schema (draft 7).
std::string sample_schema();

}  // namespace laterna
