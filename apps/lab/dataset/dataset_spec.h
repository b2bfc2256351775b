// What a data set is made of: a scene, and which of its values are random.
//
//   name = "tabletop"
//   licence = "CC0-1.0"                 # of the data, for the data card
//   scene = "tabletop-scene.toml"       # relative to this file
//
//   [reject]                            # what a rig cannot see
//   least_lit = 0.1
//
//   [present]                           # a mesh that is not always there
//   "mesh.2" = 0.5
//
//   [random]                            # scene path = distribution (distribution.h)
//   "camera.fov_x_deg" = { uniform = [30, 60] }
//   "mesh.1" = { choice = [{ shape = "sphere" }, { file = "cup.ply", scale = { uniform = [0.9, 1.1] } }] }
//
// A path is that of `--set`: keys and indices joined by dots; an index left out is 0. A chosen table sets
// each of its keys under the path, and may hold distributions itself.
#pragma once

#include "apps/lab/dataset/distribution.h"
#include "sim/fields.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace laterna {

/// The plain keys of a specification.
struct DatasetSettings {
  std::string name = "dataset", description{}, licence = "CC0-1.0", scene{}, format = "png";
  int tar_samples = 64;
  bool folders = true;
  int correspondence_step_px = 4;
};

template <class Visitor>
void describe(Visitor& visit, DatasetSettings& s) {
  visit(Field{.key = "name", .sentence = "Of the data set, and of its tar files."}, s.name);
  visit(Field{.key = "description", .sentence = "For the data card."}, s.description);
  visit(Field{.key = "licence", .sentence = "Of the data, for the data card."}, s.licence);
  visit(Field{.key = "scene", .sentence = "The scene file, relative to the specification."}, s.scene);
  visit(Field{.key = "format", .sentence = "Of the pictures, as `capture --format`."}, s.format);
  visit(Field{.key = "tar_samples", .sentence = "Samples in one tar file.", .low = 1, .high = 1e6},
        s.tar_samples);
  visit(Field{.key = "folders", .sentence = "Whether samples stay as folders beside the tar files."},
        s.folders);
  visit(Field{.key = "correspondence_step_px",
              .unit = "px",
              .sentence = "Correspondences are listed at every so many camera pixels.",
              .low = 1,
              .high = 4096},
        s.correspondence_step_px);
}

/// When an attempt at a sample is thrown away and drawn anew (sight.h).
struct RejectSettings {
  double least_lit = 0.1, least_projector = 0.1;
  int tries = 100;
};

template <class Visitor>
void describe(Visitor& visit, RejectSettings& r) {
  visit(Field{.key = "least_lit",
              .sentence = "Least share of each camera's pixels that see light of each projector.",
              .low = 0,
              .high = 1},
        r.least_lit);
  visit(Field{.key = "least_projector",
              .sentence = "Least share of each projector's picture that each camera sees.",
              .low = 0,
              .high = 1},
        r.least_projector);
  visit(Field{.key = "tries", .sentence = "Attempts at a sample before the run ends.", .low = 1, .high = 1e6},
        r.tries);
}

struct RandomKey {
  std::string path;  ///< in the scene
  Distribution distribution;
  std::string place;  ///< "spec.toml:7: random \"camera.fov_x_deg\""
};

struct PresentKey {
  int mesh = 0;  ///< counted from 0
  double share = 1;
};

struct DatasetSpec {
  DatasetSettings settings{};
  RejectSettings reject{};
  std::vector<RandomKey> random{};  ///< in the order of the file
  std::vector<PresentKey> present{};
  std::filesystem::path scene_file{};
  std::string text{}, scene_text{};  ///< of both files
};

/// Throws InputError, beginning with file and line, for text that is no TOML, an unknown key, a value of a
/// wrong type or out of range, a distribution that is none, or no scene. The scene's text is left empty.
DatasetSpec parse_dataset_spec(std::string_view text, const std::string& file_name);

/// The same from a file, with the scene's text.
DatasetSpec read_dataset_spec(const std::filesystem::path& path);

}  // namespace laterna
