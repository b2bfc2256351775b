#include "apps/lab/score/score_rig.h"

#include "sim/error.h"
#include "sim/plain_name.h"
#include "sim/text_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>

namespace laterna {

namespace {

using Json = nlohmann::json;

// [R | t] whose R is orthogonal to 1e-6; unlike rigid_from_rows, also a reflection.
Rigid orthogonal_from_rows(const std::array<std::array<double, 4>, 3>& rows, const std::string& name) {
  Rigid motion;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) motion.rotation[c][r] = rows[r][c];
    motion.translation[r] = rows[r][3];
  }
  const glm::dmat3 rest = motion.rotation * glm::transpose(motion.rotation) - glm::dmat3(1.0);
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r)
      if (!(std::abs(rest[c][r]) <= 1e-6))
        throw InputError(fmt::format("\"{}\": the placement has no orthogonal matrix", name));
  }
  return motion;
}

// Of a Laterna file; `at_origin` where nothing says a placement.
Device device_of(const Json& json) {
  Device device;
  const auto size = json.at("size").get<std::array<int, 2>>();
  device.name = json.value("name", "");
  device.intrinsics = {{size[0], size[1]}, json.at("fx"), json.at("fy"), json.at("cx"), json.at("cy")};
  if (json.contains("lens"))
    device.lens = {json["lens"].at("model"), json["lens"].at("parameters").get<std::vector<double>>()};
  for (const char* key : {"device_from_world", "device_from_camera"})
    if (json.contains(key))
      device.device_from_world =
          orthogonal_from_rows(json.at(key).get<std::array<std::array<double, 4>, 3>>(), device.name);
  const Intrinsics& k = device.intrinsics;
  if (k.size.x < 1 || k.size.y < 1 || !(k.fx != 0 && k.fy != 0) || !std::isfinite(k.fx + k.fy + k.cx + k.cy))
    throw InputError(fmt::format("\"{}\": unusable size, focal lengths or centre", device.name));
  [[maybe_unused]] const LensProjection throws_for_an_unknown_model(device.intrinsics, device.lens);
  return device;
}

ScoreResult from_estimate(const Json& json) {
  ScoreResult result;
  for (const Json& camera : json.value("cameras", Json::array()))
    result.rig.cameras.push_back(device_of(camera));
  for (const Json& projector : json.at("projectors")) {
    const Json& entry = projector.contains("estimate") ? projector.at("estimate") : projector;
    if (entry.is_null() || entry.value("status", "ok") == "refused") continue;
    if (!entry.contains("device_from_world") && !entry.contains("device_from_camera"))
      throw InputError(fmt::format("\"{}\": no placement, expected device_from_world or device_from_camera",
                                   entry.value("name", "")));
    result.rig.projectors.push_back(device_of(entry));
    result.covariance.push_back(entry.value("covariance", std::vector<double>{}));
  }
  return result;
}

double length(const glm::dvec3& v) { return std::sqrt(glm::dot(v, v)); }

Rigid projector_from_camera(const ScoreRig& rig) {
  return rig.camera ? compose(rig.projector.device_from_world, inverse(rig.camera->device_from_world))
                    : rig.projector.device_from_world;
}

/// What lengths of the result are multiplied by; none where a baseline is 0 or not finite.
std::optional<double> scale_of(const ScoreRig& result, const ScoreRig& truth, const Alignment& alignment) {
  if (!alignment.scale) return 1;
  const bool has_pair = alignment.world || result.camera;
  const double found = length(has_pair ? projector_from_camera(result).translation
                                       : result.projector.device_from_world.translation);
  const double expected = length(has_pair ? projector_from_camera(truth).translation
                                          : truth.projector.device_from_world.translation);
  const double scale = expected / found;
  return scale > 0 && std::isfinite(scale) ? std::optional(scale) : std::nullopt;
}

/// Throws where a device of a pair, or a lone one, stands nowhere of its own: formats such as ROS's
/// camera_info hold no placement.
void expect_placement(const Rig& rig) {
  for (const Device& projector : rig.projectors)
    for (const Device& camera : rig.cameras)
      if (projector.device_from_world.rotation == camera.device_from_world.rotation &&
          projector.device_from_world.translation == camera.device_from_world.translation)
        throw InputError(
            fmt::format("projector \"{}\" stands exactly where camera \"{}\" does, as in a file without "
                        "placements, expected one",
                        projector.name, camera.name));
}

}  // namespace

ScoreResult read_score_result(const std::filesystem::path& path, const RigReadOptions& options) {
  if (path.extension() == ".json") {
    const Json json = Json::parse(read_text(path, 1 << 26), nullptr, false);
    if (json.is_object() && json.contains("projectors")) {
      try {
        return from_estimate(json);
      } catch (const Json::exception& error) {
        throw InputError(fmt::format("{}: not what `laterna calibrate` writes: {}", path.string(),
                                     plain_json_message(error.what())));
      } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", path.string(), error.what()));
      }
    }
  }
  ScoreResult result{read_rig(path, options)};
  const bool is_lone = result.rig.projectors.empty() && result.rig.cameras.size() == 1;
  if (is_lone && path.extension() == ".cameramodel") std::swap(result.rig.projectors, result.rig.cameras);
  if (result.rig.projectors.empty())
    throw InputError(fmt::format("{}: holds no projector, expected one", path.string()));
  try {
    expect_placement(result.rig);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
  result.covariance.resize(result.rig.projectors.size());
  return result;
}

Alignment alignment_of(const std::string& word) {
  if (word == "none") return {};
  if (word == "world") return {true, false};
  if (word == "scale") return {false, true};
  if (word == "world+scale") return {true, true};
  throw InputError(fmt::format("--align: found \"{}\", expected none, world, scale or world+scale", word));
}

std::string alignment_word(const Alignment& a) {
  return a.world && a.scale ? "world+scale" : a.world ? "world" : a.scale ? "scale" : "none";
}

std::optional<Device> align(const ScoreRig& result, const ScoreRig& truth, const Alignment& alignment) {
  const std::optional<double> scale = scale_of(result, truth, alignment);
  if (!scale) return std::nullopt;
  Device projector = result.projector;
  if (alignment.world) {
    Rigid pair = projector_from_camera(result);
    pair.translation *= *scale;
    projector.device_from_world = compose(pair, truth.camera ? truth.camera->device_from_world : Rigid{});
  } else {
    projector.device_from_world.translation *= *scale;
  }
  return projector;
}

std::optional<Device> aligned_camera(const ScoreRig& result, const ScoreRig& truth,
                                     const Alignment& alignment) {
  const std::optional<double> scale = scale_of(result, truth, alignment);
  if (!result.camera || !truth.camera || !scale) return std::nullopt;
  Device camera = *result.camera;
  if (alignment.world)
    camera.device_from_world = truth.camera->device_from_world;
  else
    camera.device_from_world.translation *= *scale;
  return camera;
}

}  // namespace laterna
