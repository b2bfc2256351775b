#include "apps/lab/dataset/sample_record.h"

#include "apps/lab/dataset/sample_maps.h"
#include "apps/lab/matrices.h"
#include "apps/lab/noun_json.h"
#include "sim/pattern_json.h"
#include "sim/scene_fields.h"

#include <fmt/format.h>

namespace laterna {

namespace {

using Json = nlohmann::json;

Json view_json(const CaptureSequence& s, const Sight& sight) {
  return {{"camera", s.camera},
          {"projector", s.projector},
          {"pictures", s.pictures},
          {"truth", truth_file(s.camera, s.projector)},
          {"mask", mask_file(s.camera, s.projector)},
          {"correspondences", correspondence_file(s.camera, s.projector)},
          {"saturation_cd_per_m2", s.saturation_cd_per_m2},
          {"seen_share", sight.seen},
          {"lit_share", sight.lit},
          {"projector_share", sight.projector}};
}

Json object_of(const std::vector<std::pair<std::string, Json>>& values) {
  Json object = Json::object();
  for (const auto& [path, value] : values) object[path] = value;
  return object;
}

}  // namespace

std::string truth_file(const std::string& camera, const std::string& projector) {
  return fmt::format("truth/{}_{}.npy", camera, projector);
}

std::string mask_file(const std::string& camera, const std::string& projector) {
  return fmt::format("mask/{}_{}.png", camera, projector);
}

std::string correspondence_file(const std::string& camera, const std::string& projector) {
  return fmt::format("correspondences/{}_{}.npy", camera, projector);
}

Json sample_record(const DrawnSample& sample, const Scene& scene, const CaptureManifest& manifest) {
  Json record{{"format", "laterna-sample"},
              {"version", 1},
              {"key", sample.key},
              {"index", sample.index},
              {"seed", sample.seed},
              {"capture_seed", sample.capture_seed},
              {"scene", manifest.scene},
              {"rejected", sample.rejected},
              {"drawn", object_of(sample.drawn.values)},
              {"absent_meshes", sample.drawn.absent},
              {"patterns", noun_json(scene.patterns)},
              {"effects", noun_json(scene.effects)},
              {"calibration", matrices_json(scene)},
              {"sensors", Json::object()},
              {"projector_effects", Json::object()},
              {"correspondence_columns", correspondence_columns},
              {"truth_channels", truth_channels},
              {"views", Json::array()}};
  for (const Camera& camera : scene.cameras) record["sensors"][camera.device.name] = noun_json(camera.sensor);
  for (const Projector& projector : scene.projectors)
    record["projector_effects"][projector.device.name] = noun_json(projector.effects);
  for (std::size_t k = 0; k < manifest.sequences.size(); ++k)
    record["views"].push_back(view_json(manifest.sequences[k], sample.sights.at(k)));
  return record;
}

std::string sample_schema() {
  return R"({
  "$schema": "http://json-schema.org/draft-07/schema#",
  "title": "A sample of a Laterna data set",
  "type": "object",
  "required": ["format", "version", "key", "index", "seed", "capture_seed", "scene", "rejected", "drawn",
               "absent_meshes", "patterns", "effects", "calibration", "sensors", "projector_effects",
               "correspondence_columns", "truth_channels", "views"],
  "additionalProperties": false,
  "properties": {
    "format": {"enum": ["laterna-sample"]},
    "version": {"enum": [1]},
    "key": {"type": "string", "pattern": "^[0-9]{8}$"},
    "index": {"type": "integer", "minimum": 0},
    "seed": {"type": "integer", "minimum": 0, "description": "of the data set"},
    "capture_seed": {"type": "integer", "minimum": 0, "description": "`laterna capture scene.toml --seed` draws the same noise"},
    "scene": {"type": "string", "description": "the whole scene, self-contained"},
    "rejected": {"type": "object", "additionalProperties": {"type": "integer", "minimum": 1},
                 "description": "attempts that the rig could not see, by reason"},
    "drawn": {"type": "object", "description": "what was random: scene path and value"},
    "absent_meshes": {"type": "array", "items": {"type": "integer", "minimum": 0}},
    "patterns": {"type": "object", "required": ["kind"]},
    "effects": {"type": "object", "additionalProperties": {"type": "boolean"}},
    "calibration": {
      "type": "object", "required": ["projectors", "cameras"],
      "properties": {"projectors": {"$ref": "#/definitions/devices"}, "cameras": {"$ref": "#/definitions/devices"}}
    },
    "sensors": {"type": "object", "additionalProperties": {"type": "object", "required": ["kind", "bit_depth"]}},
    "projector_effects": {"type": "object", "additionalProperties": {"type": "object"}},
    "correspondence_columns": {"type": "array", "items": {"type": "string"}, "minItems": 8, "maxItems": 8},
    "truth_channels": {"type": "array", "items": {"type": "string"}, "minItems": 7, "maxItems": 7},
    "views": {
      "type": "array", "minItems": 1,
      "items": {
        "type": "object", "additionalProperties": false,
        "required": ["camera", "projector", "pictures", "truth", "mask", "correspondences",
                     "saturation_cd_per_m2", "seen_share", "lit_share", "projector_share"],
        "properties": {
          "camera": {"type": "string"},
          "projector": {"type": "string"},
          "pictures": {"type": "array", "items": {"type": "string"}, "minItems": 1},
          "truth": {"type": "string", "description": "npy, single precision, height × width × truth_channels"},
          "mask": {"type": "string", "description": "PNG: 255 where camera and projector both see the point"},
          "correspondences": {"type": "string", "description": "npy, single precision, a row of correspondence_columns each"},
          "saturation_cd_per_m2": {"type": "number", "exclusiveMinimum": 0},
          "seen_share": {"$ref": "#/definitions/share"},
          "lit_share": {"$ref": "#/definitions/share"},
          "projector_share": {"$ref": "#/definitions/share"}
        }
      }
    }
  },
  "definitions": {
    "share": {"type": "number", "minimum": 0, "maximum": 1},
    "matrix": {"type": "array", "minItems": 4, "maxItems": 4,
               "items": {"type": "array", "items": {"type": "number"}, "minItems": 4, "maxItems": 4}},
    "devices": {
      "type": "array", "minItems": 1,
      "items": {
        "type": "object",
        "required": ["name", "size", "fx", "fy", "cx", "cy", "texture_from_world"],
        "properties": {
          "size": {"type": "array", "items": {"type": "integer", "minimum": 1}, "minItems": 2, "maxItems": 2},
          "fx": {"type": "number"}, "fy": {"type": "number"}, "cx": {"type": "number"}, "cy": {"type": "number"},
          "texture_from_world": {"$ref": "#/definitions/matrix"}
        }
      }
    }
  }
}
)";
}

}  // namespace laterna
