#include "apps/lab/score/camera_score.h"

#include "calib/verify.h"

#include <cmath>
#include <limits>
#include <optional>

namespace laterna {

namespace {

/// The camera judged as a projector is: its place is its own, and there is nothing left to align.
std::optional<ScoreRig> as_projector(const ScoreRig& result, const ScoreRig& truth,
                                     const Alignment& alignment) {
  const std::optional<Device> camera = aligned_camera(result, truth, alignment);
  return camera ? std::optional(ScoreRig{std::nullopt, *camera}) : std::nullopt;
}

/// None where no point lies before the true camera.
std::optional<Probe> camera_probe(const ScoreRig& truth, std::span<const glm::dvec3> points_world) {
  if (!truth.camera || depths_of(*truth.camera, points_world).empty()) return std::nullopt;
  return make_probe({std::nullopt, *truth.camera}, {}, points_world);
}

}  // namespace

double camera_error_px(const ScoreRig& result, const ScoreRig& truth, const Alignment& alignment,
                       std::span<const glm::dvec3> points_world) {
  const auto camera = as_projector(result, truth, alignment);
  const auto probe = camera_probe(truth, points_world);
  if (!camera || !probe) return std::numeric_limits<double>::quiet_NaN();
  const std::vector<glm::dvec2> pixels = result_pixels(*camera, *probe);
  const std::size_t first = probe->surface_begin;
  return std::sqrt(squared_error_px2(std::span(pixels).subspan(first),
                                     std::span(probe->true_pixels).subspan(first), probe->diagonal_px));
}

std::vector<Suspect> camera_suspects(const ScoreRig& result, const ScoreRig& truth,
                                     const Alignment& alignment, std::span<const glm::dvec3> points_world) {
  const auto camera = as_projector(result, truth, alignment);
  const auto probe = camera_probe(truth, points_world);
  if (!camera || !probe) return {};
  std::vector<Suspect> suspects = geometric_suspects(*camera, *probe, 0);
  std::erase_if(suspects, [](const Suspect& s) { return s.name == "unconverged"; });
  for (Suspect& s : suspects) s.words = "of the camera: " + s.words;
  return suspects;
}

}  // namespace laterna
