#include "tests/lab/score/picture_confusion.h"

#include "apps/lab/capture_writer.h"
#include "apps/lab/decode_folder.h"
#include "apps/lab/score/score.h"
#include "apps/lab/trial.h"
#include "calib/peers/point_methods.h"
#include "sim/image_file.h"
#include "sim/scene_file.h"
#include "tests/lab/score/foreign_files.h"
#include "tests/lab/score/picture_mistakes.h"
#include "tests/lab/score/picture_scenes.h"
#include "tests/lab/score/random_rigs.h"
#include "tests/testing.h"

#include <utility>

namespace laterna::testing {

namespace {

namespace fs = std::filesystem;

struct Taken {
  SceneSpec spec;
  Scene scene;
};

Taken scene_with(const std::string& text, const std::vector<std::string>& overrides) {
  const SceneSpec spec = parse_scene(text, "picture_scene.toml", overrides);
  return {spec, build_scene(spec, ".")};
}

// A capture that Laterna's own trial is content with.
std::string sound_scene(int family, std::mt19937_64& random) {
  for (;;) {
    std::string text = picture_scene(family, random);
    const Scene scene = scene_with(text, {}).scene;
    StageTimes times;
    if (run_trial(scene, trace(scene, times), {}, times).at(0).solve.status == Status::ok) return text;
  }
}

void capture_into(const fs::path& folder, const Taken& taken, std::uint64_t seed) {
  fs::remove_all(folder);
  StageTimes times;
  CaptureOptions options;
  options.seed = seed;
  options.format = "tif";
  options.truth = false;
  write_capture(taken.spec, taken.scene, ".", folder, options, times);
}

// The capture as the mistake leaves it; its one sequence.
CaptureSequence spoilt_capture(const fs::path& folder, const std::string& text, const PictureMistake& mistake,
                               std::mt19937_64& random) {
  const std::uint64_t seed = random();
  const auto overrides = mistake.overrides ? mistake.overrides(random) : std::vector<std::string>{};
  capture_into(folder, scene_with(text, overrides), seed);
  CaptureSequence sequence = read_manifest(folder).sequences.at(0);
  CapturedStack pictures = read_pictures(folder, sequence);
  if (!mistake.truth_knows) capture_into(folder, scene_with(text, {}), seed);
  if (mistake.spoil) mistake.spoil(pictures, {sequence.patterns, sequence.projector_size}, random);
  std::vector<fs::path> files;
  for (const std::string& file : sequence.pictures) files.push_back(folder / file);
  write_stack(files, pictures);
  return sequence;
}

// What a calibrator that knows the surface and the camera decodes.
Correspondences decoded_points(const fs::path& folder, const CaptureSequence& sequence, const Scene& scene) {
  Correspondences points;
  const DecodedSequence decoded = decode_sequence(folder, sequence, {});
  append_correspondences(decoded.map, ToldScene(scene).trace(0), 0, TrialOptions{}.block_px, points);
  return points;
}

// As calibrators do, in the camera's frame. Empty where the method refuses.
ScoreResult calibrated(const std::string& method, const Correspondences& points, const Scene& truth,
                       const fs::path& folder, std::mt19937_64& random, std::string& format) {
  const Device &projector = truth.projectors[0].device, &camera = truth.cameras[0].device;
  SolveOptions options;
  options.lens_model = projector.lens.model;
  if (points.world_points.size() < 6) return {};
  // OpenCV takes its time, and 4,000 points serve it as well.
  const Correspondences some =
      method == "opencv" ? subset(points, evenly_spread(points.world_points.size(), 4000)) : points;
  PointAnswer answer = solve_points(method, some, projector.intrinsics.size, options);
  if (answer.status == Status::refused) return {};
  Rig rig{{camera}, {answer.estimate}};
  rig.projectors[0].name = projector.name;
  rig.cameras[0].device_from_world = Rigid{};
  rig.projectors[0].device_from_world =
      compose(answer.estimate.device_from_world, inverse(camera.device_from_world));
  auto told = told_by_a_file(rig, one_of(random, 10), folder, unsaid_by(truth));
  format = told.format;
  return told.result;
}

// Of both methods.
void add_verdicts(const PictureMistake& mistake, const std::string& text, const ScratchFolder& scratch,
                  std::mt19937_64& random, std::vector<Verdict>& verdicts) {
  const auto folder = scratch / "capture";
  const CaptureSequence sequence = spoilt_capture(folder, text, mistake, random);
  const ScoreTruth truth = read_score_truth(folder);
  Correspondences points = decoded_points(folder, sequence, truth.scene);
  if (mistake.exchanges_codes)
    for (glm::dvec2& pixel : points.projector_pixels) std::swap(pixel.x, pixel.y);
  for (const char* method : {"laterna", "opencv"}) {
    Verdict v{mistake.suspect, mistake.how, "", {}};
    const ScoreResult result = calibrated(method, points, truth.scene, scratch.path(), random, v.format);
    // Laterna refuses what is mirrored, and says so: where the pictures are right, nothing is left to be
    // scored.
    if (mistake.exchanges_codes && result.rig.projectors.empty()) continue;
    const ProjectorScore s = score(truth, result).at(0);
    v.error_px = s.volume_error_px, v.bound_px = s.volume_bound_px, v.shows = s.status != Status::ok;
    for (const Suspect& suspect : s.suspects) v.named.push_back(suspect.name);
    verdicts.push_back(v);
  }
}

}  // namespace

std::vector<Verdict> picture_verdicts(int rigs, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const ScratchFolder scratch;
  const auto mistakes = picture_mistakes();
  std::vector<Verdict> verdicts;
  for (int i = 0; i < rigs; ++i) {
    const std::string text = sound_scene(i, random);
    for (const PictureMistake& mistake : mistakes) add_verdicts(mistake, text, scratch, random, verdicts);
  }
  return verdicts;
}

}  // namespace laterna::testing
