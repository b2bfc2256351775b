#include "sim/capture_folder.h"

#include "sim/error.h"
#include "sim/image_file.h"
#include "sim/pattern_json.h"
#include "sim/plain_name.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>

namespace laterna {

namespace {

using Json = nlohmann::json;

Json json_of(const CaptureSequence& s) {
  Json json{{"camera", s.camera},
            {"projector", s.projector},
            {"camera_size", {s.camera_size.x, s.camera_size.y}},
            {"projector_size", {s.projector_size.x, s.projector_size.y}},
            {"patterns", patterns_json(s.patterns)},
            {"bit_depth", s.bit_depth},
            {"saturation_cd_per_m2", s.saturation_cd_per_m2},
            {"pictures", s.pictures},
            {"truth", s.truth}};
  if (s.exposure_time_s > 0) json["exposure_time_s"] = s.exposure_time_s;
  return json;
}

glm::ivec2 size_of(const Json& json) {
  const auto size = json.get<std::array<int, 2>>();
  return {size[0], size[1]};
}

CaptureSequence sequence_of(const Json& json) {
  CaptureSequence s;
  s.camera = json.at("camera");
  s.projector = json.at("projector");
  s.camera_size = size_of(json.at("camera_size"));
  s.projector_size = size_of(json.at("projector_size"));
  s.patterns = patterns_of(json.at("patterns"));
  s.bit_depth = json.value("bit_depth", 8);
  s.saturation_cd_per_m2 = json.value("saturation_cd_per_m2", 0.0);
  s.exposure_time_s = json.value("exposure_time_s", 0.0);
  s.pictures = json.at("pictures").get<std::vector<std::string>>();
  s.truth = json.value("truth", "");
  check_plain_name(s.camera, "camera");
  check_plain_name(s.projector, "projector");
  for (const std::string& picture : s.pictures) check_inner_path(picture, "pictures");
  return s;
}

}  // namespace

std::string manifest_json(const CaptureManifest& manifest) {
  Json json{{"format", "laterna-capture"},   {"version", 1},
            {"scene", manifest.scene},       {"seed", manifest.seed},
            {"matrices", manifest.matrices}, {"sequences", Json::array()}};
  for (const CaptureSequence& s : manifest.sequences) json["sequences"].push_back(json_of(s));
  return json.dump(2) + "\n";
}

CaptureManifest parse_manifest(const std::string& text, const std::string& file_name) {
  try {
    const Json json = Json::parse(text);
    if (json.at("format") != "laterna-capture" || json.at("version") != 1) {
      throw InputError(fmt::format("{}: found format {} version {}, expected \"laterna-capture\" version 1",
                                   file_name, json.at("format").dump(), json.at("version").dump()));
    }
    CaptureManifest manifest{
        json.value("scene", ""), json.value("seed", std::uint64_t{0}), json.value("matrices", ""), {}};
    for (const Json& s : json.at("sequences")) manifest.sequences.push_back(sequence_of(s));
    if (!manifest.scene.empty()) check_inner_path(manifest.scene, "scene");
    return manifest;
  } catch (const Json::exception& error) {
    throw InputError(
        fmt::format("{}: not a capture manifest: {}", file_name, plain_json_message(error.what())));
  } catch (const InputError& error) {
    const std::string message = error.what();
    throw InputError(message.starts_with(file_name) ? message : file_name + ": " + message);
  }
}

bool natural_less(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (std::isdigit(static_cast<unsigned char>(a[i])) && std::isdigit(static_cast<unsigned char>(b[j]))) {
      const std::size_t i0 = std::min(a.find_first_not_of('0', i), a.size()),
                        j0 = std::min(b.find_first_not_of('0', j), b.size());
      const std::size_t i1 = std::min(a.find_first_not_of("0123456789", i0), a.size());
      const std::size_t j1 = std::min(b.find_first_not_of("0123456789", j0), b.size());
      if (i1 - i0 != j1 - j0) return i1 - i0 < j1 - j0;
      if (const int order = a.compare(i0, i1 - i0, b, j0, j1 - j0)) return order < 0;
      i = i1, j = j1;
    } else if (a[i] != b[j]) {
      return a[i] < b[j];
    } else {
      ++i, ++j;
    }
  }
  if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
  return a < b;  // "1" and "01": a fixed order all the same
}

CaptureManifest read_manifest(const std::filesystem::path& folder) {
  const auto path = folder / "manifest.json";
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw InputError(fmt::format("{}: no such file, expected a capture folder's manifest", path.string()));
  std::ostringstream text;
  text << file.rdbuf();
  return parse_manifest(text.str(), path.string());
}

bool is_picture(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  constexpr std::array known{".png", ".tif", ".tiff", ".pgm", ".bmp", ".jpg", ".jpeg"};
  return std::find(known.begin(), known.end(), extension) != known.end();
}

CaptureSequence plain_sequence(const std::filesystem::path& folder, const PatternSequence& patterns) {
  std::error_code failed;
  const std::filesystem::directory_iterator entries(folder, failed);
  if (failed)
    throw InputError(fmt::format("{}: {}, expected a folder of pictures", folder.string(), failed.message()));
  CaptureSequence sequence;
  sequence.camera = "camera";
  sequence.projector = "projector";
  sequence.projector_size = patterns.projector_size;
  sequence.patterns = patterns.parameters;
  for (const auto& entry : entries) {
    if (entry.is_regular_file() && is_picture(entry.path()))
      sequence.pictures.push_back(entry.path().filename().string());
  }
  if (sequence.pictures.empty())
    throw InputError(fmt::format("{}: holds no picture, expected a sequence of them", folder.string()));
  std::sort(sequence.pictures.begin(), sequence.pictures.end(), natural_less);
  return sequence;
}

CapturedStack read_pictures(const std::filesystem::path& folder, const CaptureSequence& sequence) {
  std::vector<std::filesystem::path> files;
  for (const std::string& picture : sequence.pictures) files.push_back(folder / picture);
  return read_stack(files);
}

}  // namespace laterna
