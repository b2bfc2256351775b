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
  std::vector<std::string> pictures;  ///< in the order of the patterns: one file each, or one file of pages
  std::string truth;                  ///< multi-layer EXR; empty: not known
};

/// manifest.json: {"format": "laterna-capture", "version": 1, "scene", "seed", "matrices", "sequences":
/// [...]}, each sequence with the fields of CaptureSequence as keys and sizes as [W, H]. `patterns` is
/// "gray", or an object of what [patterns] of a scene file says of the family, as {"kind": "gray_phase",
/// "steps": 4}; keys at their defaults may be absent.
///
/// `laterna capture --format` chooses how a sequence's pictures stand on disk. All keep the digital numbers,
/// 8 bits as 8 and 9 to 16 bits as 16, exactly:
///
///   png        CAMERA/PROJECTOR/00.png, 01.png, ...; smallest, fast setting, encoded in parallel
///   tif        the same as uncompressed TIFF: written as fast as the disk takes them
///   pgm        the same as binary PGM; cameras of 8 bits only
///   exr        the same as ZIP-packed EXR, the numbers unscaled: half floats for 8 bits (exact to 2048),
///              single floats for more (exact to 2²⁴)
///   tif-pages  CAMERA/PROJECTOR/pages.tif alone: one uncompressed page per picture
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

/// The order of file names, with runs of digits compared as numbers: "graycode_2.png" before
/// "graycode_10.png".
bool natural_less(const std::string& a, const std::string& b);

/// Whether a file's name ends as a plain picture's: .png, .tif, .tiff, .pgm, .bmp, .jpg or .jpeg.
bool is_picture(const std::filesystem::path& path);

/// A folder of plain pictures, as a real projector and camera leave them: every .png, .tif, .pgm, .bmp or
/// .jpg of the folder in the order of their names (numbers compared as numbers) is one picture of one
/// sequence of the given family.
CaptureSequence plain_sequence(const std::filesystem::path& folder, const PatternSequence& patterns);

/// The pictures of a sequence. Throws InputError where one is missing, unreadable, or of another size or
/// depth.
CapturedStack read_pictures(const std::filesystem::path& folder, const CaptureSequence& sequence);

}  // namespace laterna
