#include "apps/lab/score/score.h"

#include "apps/lab/score/camera_score.h"
#include "apps/lab/score/picture_suspects.h"
#include "apps/lab/trial.h"
#include "calib/verify.h"
#include "render/effects/apply_effects.h"
#include "sim/error.h"
#include "sim/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace laterna {

namespace {

constexpr double beyond_noise = 5;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

int projector_index(const Scene& scene, const Rig& rig, const Device& projector) {
  for (int p = 0; p < int(scene.projectors.size()); ++p)
    if (scene.projectors[p].device.name == projector.name) return p;
  if (scene.projectors.size() == 1 && rig.projectors.size() == 1) return 0;
  throw InputError(fmt::format("the scene has no projector \"{}\", which the result names", projector.name));
}

// Of each projector of the result. Throws where one is unknown, or named twice.
std::vector<int> projector_indices(const Scene& scene, const Rig& rig) {
  std::vector<int> indices;
  for (const Device& projector : rig.projectors) {
    const int p = projector_index(scene, rig, projector);
    if (std::find(indices.begin(), indices.end(), p) != indices.end())
      throw InputError(fmt::format("the result has a second projector \"{}\"", projector.name));
    indices.push_back(p);
  }
  return indices;
}

// The camera that both know, for the truth and for the result; the scene's first where the result has none.
std::pair<std::optional<Device>, std::optional<Device>> cameras(const Scene& scene, const Rig& rig) {
  for (const Device& camera : rig.cameras)
    for (const Camera& known : scene.cameras)
      if (known.device.name == camera.name) return {known.device, camera};
  const Device& first = scene.cameras.at(0).device;
  return {first, rig.cameras.empty() ? std::nullopt : std::optional(rig.cameras.front())};
}

double rms_mm(const ScoreRig& result, const ScoreRig& truth, const Alignment& alignment,
              std::span<const glm::dvec3> points) {
  const auto projector = align(result, truth, alignment);
  if (!projector) return nan;
  const WorldProjection projection(*projector), true_projection(truth.projector);
  const glm::dvec3 centre_world = center_in_world(projector->device_from_world);
  const glm::ivec2 size = projector->intrinsics.size, true_size = truth.projector.intrinsics.size;
  double sum = 0;
  std::size_t count = 0;
  for (const glm::dvec3& x : points) {
    const glm::dvec2 pixel(true_projection.project(x));
    const auto on_ray = projection.unproject(stretched(pixel, true_size, size), 1);
    if (!on_ray) continue;
    const glm::dvec3 miss = glm::cross(x - centre_world, glm::normalize(*on_ray - centre_world));
    sum += glm::dot(miss, miss), ++count;
  }
  return count ? 1000 * std::sqrt(sum / double(count)) : nan;
}

double rms_px(const ScoreRig& result, const ScoreRig& truth, const Alignment& alignment,
              std::span<const glm::dvec3> points) {
  const WorldProjection projection(truth.projector);
  std::vector<glm::dvec2> expected;
  std::vector<glm::dvec3> projected;
  for (const glm::dvec3& x : points) {
    const glm::dvec2 pixel(projection.project(x));
    if (std::isfinite(pixel.x + pixel.y)) expected.push_back(pixel), projected.push_back(x);
  }
  const double diagonal = glm::length(glm::dvec2(truth.projector.intrinsics.size));
  return std::sqrt(squared_error_px2(result_pixels(result, truth, alignment, projected), expected, diagonal));
}

// What the pictures of one projector say: of the trial, or of the folder.
struct PictureEvidence {
  std::vector<Suspect> suspects;
  Correspondences decoded;
};

void add_evidence(const ScoreTruth& truth, const Traced& traced, const View& view,
                  const CapturedStack& pictures, const PatternSequence& sequence, const DecodedMap& map,
                  PictureEvidence& evidence) {
  for (Suspect& s : picture_suspects(truth.scene, view.projector, view.light, pictures, sequence))
    evidence.suspects.push_back(std::move(s));
  ToldPoints told;
  told.points_world = traced.points_world[view.camera];
  append_correspondences(map, told, view.camera, TrialOptions{}.block_px, evidence.decoded);
}

bool has_all_pictures(const ScoreTruth& truth, const CaptureSequence& s) {
  const PatternSequence sequence{s.patterns, s.projector_size};
  if (s.pictures.size() > 1 && int(s.pictures.size()) != picture_count(sequence)) return false;
  return std::all_of(s.pictures.begin(), s.pictures.end(),
                     [&](const std::string& file) { return std::filesystem::exists(truth.folder / file); });
}

void add_folder_evidence(const ScoreTruth& truth, const Traced& traced, const View& view,
                         PictureEvidence& evidence) {
  for (const CaptureSequence& s : truth.manifest.sequences) {
    if (s.camera != truth.scene.cameras[view.camera].device.name ||
        s.projector != truth.scene.projectors[view.projector].device.name || !is_coded(s.patterns.kind))
      continue;
    if (!has_all_pictures(truth, s)) {
      evidence.suspects.push_back(
          {"dropped_frame", 1, advice("dropped_frame") + " (a picture is not in the folder)"});
      continue;
    }
    const CapturedStack pictures = read_pictures(truth.folder, s);
    const PatternSequence sequence{s.patterns, s.projector_size};
    add_evidence(truth, traced, view, pictures, sequence, decode(pictures, sequence), evidence);
  }
}

// The bound, by projector, and what the trial's pictures say where there are no others.
struct Predicted {
  std::vector<ProjectorOutcome> outcomes;
  std::vector<PictureEvidence> evidence;
};

Predicted predict(const ScoreTruth& truth, const Traced& traced, const ScoreOptions& options,
                  const Progress& progress) {
  Predicted predicted{{}, std::vector<PictureEvidence>(truth.scene.projectors.size())};
  if (!is_coded(truth.scene.patterns.kind)) return predicted;
  TrialOptions trial;
  trial.seed = options.seed;
  StageTimes times;
  const auto look = [&](const View& view, const CapturedStack* pictures, const DecodedMap& map) {
    if (!truth.folder.empty() || !pictures) return;
    const PatternSequence sequence = pattern_sequence(truth.scene, truth.scene.projectors[view.projector]);
    add_evidence(truth, traced, view, *pictures, sequence, map, predicted.evidence[view.projector]);
  };
  predicted.outcomes = run_trial(truth.scene, traced, trial, times, look, progress);
  return predicted;
}

PictureEvidence evidence_of(const ScoreTruth& truth, const Traced& traced, const Predicted& predicted,
                            int p) {
  PictureEvidence evidence = predicted.evidence[p];
  if (!truth.folder.empty())
    for (const View& view : traced.views)
      if (view.projector == p) add_folder_evidence(truth, traced, view, evidence);
  const Device& device = truth.scene.projectors[p].device;
  if (const auto keystone = keystone_suspect(evidence.decoded, device.intrinsics.size, device.lens.model))
    evidence.suspects.push_back(*keystone);
  return evidence;
}

bool is_within(double error_px, double bound_px, double tolerance_px) {
  return error_px <= std::max(tolerance_px, std::isfinite(bound_px) ? beyond_noise * bound_px : 0.0);
}

// The geometry's suspects and the pictures', of each name the first, the group whose first explains more in
// front.
std::vector<Suspect> joined(std::vector<Suspect> a, std::vector<Suspect> b) {
  std::stable_sort(b.begin(), b.end(), [](const auto& x, const auto& y) { return x.explains > y.explains; });
  if (a.empty() || (!b.empty() && b.front().explains > a.front().explains)) std::swap(a, b);
  for (Suspect& suspect : b) {
    if (std::none_of(a.begin(), a.end(), [&](const Suspect& s) { return s.name == suspect.name; }))
      a.push_back(std::move(suspect));
  }
  return a;
}

// Nothing was recovered; what the pictures say may be why.
std::vector<ProjectorScore> refused_scores(const ScoreTruth& truth, const Traced& traced,
                                           const Predicted& predicted, const Alignment& alignment) {
  std::vector<ProjectorScore> scores;
  for (int p = 0; p < int(truth.scene.projectors.size()); ++p) {
    ProjectorScore s{truth.scene.projectors[p].device.name};
    s.alignment = alignment;
    s.surface_error_px = s.volume_error_px = s.surface_error_mm = s.camera_error_px = nan;
    s.surface_bound_px = s.volume_bound_px = s.predicted_volume_px = nan;
    s.suspects = joined({}, evidence_of(truth, traced, predicted, p).suspects);
    scores.push_back(std::move(s));
  }
  return scores;
}

ProjectorScore score_one(const ScoreTruth& truth, const Traced& traced, const Predicted& predicted, int p,
                         const ScoreRig& result, const ScoreRig& true_rig, const Alignment& alignment,
                         const ScoreOptions& options) {
  const LargeVector<glm::dvec3> surface = lit_points(traced, p);
  const std::vector<double> depths = depths_of(true_rig.projector, surface);
  if (depths.empty())
    throw InputError(
        fmt::format("\"{}\" lights nothing that a camera of the scene sees", true_rig.projector.name));
  ProjectorScore s;
  s.name = true_rig.projector.name;
  s.alignment = alignment;
  s.surface_error_px = rms_px(result, true_rig, alignment, surface);
  s.volume_error_px =
      rms_px(result, true_rig, alignment, image_grid(true_rig.projector, volume_depths(depths)));
  s.surface_error_mm = rms_mm(result, true_rig, alignment, surface);
  s.camera_error_px = camera_error_px(result, true_rig, alignment, surface);
  const bool has_bound = !predicted.outcomes.empty() && !predicted.outcomes[p].solve.covariance.empty();
  s.surface_bound_px = has_bound ? predicted.outcomes[p].verification.surface.predicted_rms : nan;
  s.volume_bound_px = has_bound ? predicted.outcomes[p].verification.volume.predicted_rms : nan;
  // Where this scene's pictures are too bad for Laterna's own solve, their noise excuses nothing.
  const bool excuses = has_bound && predicted.outcomes[p].solve.status == Status::ok;
  const double surface_noise_px = excuses ? s.surface_bound_px : 0;
  const bool projector_right =
      is_within(s.surface_error_px, surface_noise_px, options.tolerance_px) &&
      is_within(s.volume_error_px, excuses ? s.volume_bound_px : 0, options.tolerance_px);
  const bool camera_wrong =
      s.camera_error_px > 0 && !is_within(s.camera_error_px, surface_noise_px, options.tolerance_px);
  s.status = projector_right && !camera_wrong ? Status::ok : Status::weak;
  PictureEvidence evidence = evidence_of(truth, traced, predicted, p);
  if (s.status == Status::ok)
    std::erase_if(evidence.suspects, [](const Suspect& x) { return x.name == "gamma"; });
  const double noise_px = excuses ? s.volume_bound_px : 0;
  std::vector<Suspect> geometric;
  if (!projector_right)
    geometric =
        geometric_suspects(result, make_probe(true_rig, alignment, surface), noise_px, evidence.decoded);
  else if (camera_wrong)
    geometric = camera_suspects(result, true_rig, alignment, surface);
  s.suspects = joined(std::move(geometric), std::move(evidence.suspects));
  return s;
}

}  // namespace

RigReadOptions unsaid_by(const Scene& truth) {
  RigReadOptions options;
  if (!truth.cameras.empty()) options.camera_size = truth.cameras[0].device.intrinsics.size;
  if (!truth.projectors.empty()) options.projector_size = truth.projectors[0].device.intrinsics.size;
  return options;
}

ScoreTruth read_score_truth(const std::filesystem::path& path) {
  if (path.extension() == ".json")
    throw InputError(path.string() + ": a result, expected the truth: a scene file or a capture folder");
  if (!std::filesystem::is_directory(path)) return {load_scene(path)};
  ScoreTruth truth{{}, path, read_manifest(path)};
  if (truth.manifest.scene.empty())
    throw InputError(fmt::format("{}: its manifest names no scene, expected one with the truth",
                                 (path / "manifest.json").string()));
  truth.scene = load_scene(path / truth.manifest.scene);
  return truth;
}

std::vector<ProjectorScore> score(const ScoreTruth& truth, const ScoreResult& result,
                                  const ScoreOptions& options, const Progress& progress) {
  const std::vector<int> indices = projector_indices(truth.scene, result.rig);
  StageTimes times;
  const Traced traced = trace(truth.scene, times, progress);
  const auto [true_camera, camera] = cameras(truth.scene, result.rig);
  const Alignment alignment = options.alignment.value_or(Alignment{camera.has_value(), false});
  const Predicted predicted = predict(truth, traced, options, progress);
  if (result.rig.projectors.empty()) return refused_scores(truth, traced, predicted, alignment);
  std::vector<ProjectorScore> scores;
  for (std::size_t i = 0; i < result.rig.projectors.size(); ++i) {
    const Device& projector = result.rig.projectors[i];
    const int p = indices[i];
    const ScoreRig true_rig{true_camera, truth.scene.projectors[p].device};
    scores.push_back(
        score_one(truth, traced, predicted, p, {camera, projector}, true_rig, alignment, options));
    const auto& covariance = result.covariance.at(i);
    const LargeVector<glm::dvec3> points = lit_points(traced, p);
    scores.back().predicted_volume_px =
        covariance.empty() ? nan
                           : predicted_rms(projector, covariance,
                                           image_grid(true_rig.projector,
                                                      volume_depths(depths_of(true_rig.projector, points))))
                                 .value_or(nan);
  }
  return scores;
}

}  // namespace laterna
