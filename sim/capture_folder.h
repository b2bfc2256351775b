// A capture folder: the pictures of every sequence with a manifest that says which is which.
//
//   DIR/manifest.json                what this header describes
//   DIR/scene.toml, DIR/meshes/      the scene, self-contained
//   DIR/<camera>/<projector>/NN.png  the pictures of one sequence, in the order of
//                                   sim/pattern_sequence.h
//   DIR/truth/<camera>_<projector>.exr  per camera pixel: projector u, v, lit, depth, normal
#pragma once

#include "sim/image.h"
#include "sim/pattern_sequence.h"

#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace laterna {

/// One projector's patterns as one camera saw them. Paths are relative to the folder.
struct CaptureSequence {
  std::string camera, projector;
  glm::ivec2 camera_size{0, 0}, projector_size{0, 0};
  PatternParameters patterns{};
  int bit_depth = 8;
  double saturation_cd_per_m2 = 0;    ///< the luminance that fills the scale; 0: not known
  double exposure_time_s = 0;         ///< of an EMVA 1288 sensor; 0: not known, and then not written
  std::vector<std::string> pictures;  ///< in the order of the patterns
  std::string truth;                  ///< multi-layer EXR; empty: not known
};

/// manifest.json: {"format": "laterna-capture", "version": 1, "scene", "seed", "matrices", "sequences":
/// [...]}, each sequence with the fields of CaptureSequence as keys and sizes as [W, H]. `patterns` is
/// "gray", or an object of what [patterns] of a scene file says of the family, as {"kind": "gray_phase",
/// "steps": 4}; keys at their defaults may be absent.
struct CaptureManifest {
  std::string scene;  ///< scene file, relative to the folder; empty: none
  std::uint64_t seed = 0;
  std::string matrices;  ///< file with what `laterna info --json` prints; empty: none
  std::vector<CaptureSequence> sequences;
};

std::string manifest_json(const CaptureManifest& manifest);

/// Throws InputError, naming the file and the key, for anything but a manifest of this version.
CaptureManifest parse_manifest(const std::string& text, const std::string& file_name);

/// Reads DIR/manifest.json.
CaptureManifest read_manifest(const std::filesystem::path& folder);

/// A folder of plain pictures, as a real projector and camera leave them: every .png, .tif, .pgm, .bmp or
/// .jpg of the folder in the order of their names (numbers compared as numbers) is one picture of one
/// sequence of the given family.
CaptureSequence plain_sequence(const std::filesystem::path& folder, const PatternSequence& patterns);

/// The pictures of a sequence. Throws InputError where one is missing, unreadable, or of another size or
/// depth.
CapturedStack read_pictures(const std::filesystem::path& folder, const CaptureSequence& sequence);

}  // namespace laterna
