// What a calibration says of one projector and the camera that looks at its light.
#pragma once

#include "sim/device.h"
#include "sim/formats/rig_file.h"

#include <glm/glm.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace laterna {

/// One projector of a result, and the camera that its world is tied to. Lengths in metres, device_from_world
/// of the result's own world. What is wrong with a result is what a score looks for: a rotation may be a
/// reflection here, and a focal length negative.
struct ScoreRig {
  std::optional<Device> camera;
  Device projector;
};

/// A calibration, as a file holds it.
struct ScoreResult {
  Rig rig;
  std::vector<std::vector<double>> covariance{};  ///< one per projector (verify.h); empty: none told
};

/// Reads what `laterna calibrate -o` wrote (of a known scene, or of boards, whose camera then is the world),
/// or any format of sim/formats/rig_file.h; the device of a lone .cameramodel is the projector. Of Laterna's
/// own files, refused projectors are left out, and a reflection in place of a rotation passes. Throws
/// InputError, beginning with the path, for anything else. `options`: what a file does not say itself.
ScoreResult read_score_result(const std::filesystem::path& path, const RigReadOptions& options = {});

/// What follows from a camera-projector pair and not from anyone's choice of a world.
struct Alignment {
  bool world =
      false;  ///< the result's world is moved rigidly until its camera stands where the true one does
  bool scale =
      false;  ///< and is scaled until the baseline from camera to projector is as long as the true one
};

/// "none", "world", "scale" or "world+scale". Throws InputError for another word.
Alignment alignment_of(const std::string& word);
std::string alignment_word(const Alignment& alignment);

/// The result's projector in the truth's world. world: projector_from_world = projector_from_camera (result)
/// · camera_from_world (truth); where the result has no camera its world is taken for the camera's frame.
/// scale: lengths of the result × |baseline of the truth|/|baseline of the result|; where the result has no
/// camera and its world stays, the baseline is that from the world's origin. None where a baseline is 0 or
/// not finite.
std::optional<Device> align(const ScoreRig& result, const ScoreRig& truth, const Alignment& alignment);

/// The result's camera in the truth's world, likewise. world: where the true one stands. None where either
/// has no camera.
std::optional<Device> aligned_camera(const ScoreRig& result, const ScoreRig& truth,
                                     const Alignment& alignment);

}  // namespace laterna
