// Every pattern family from scene to recovered projector, in memory and through a folder.
#include "apps/lab/calibrate_folder.h"
#include "apps/lab/capture_writer.h"
#include "apps/lab/trial.h"
#include "sim/scene_build.h"
#include "sim/scene_file.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using K = PatternKind;

const std::filesystem::path scenes = laterna::testing::data_folder() / "scenes";

SceneSpec small_spec(const PatternParameters& patterns) {
  SceneSpec spec = parse_scene(
      "[[mesh]]\nshape = \"relief\"\nshape_size = [1.6, 1.0, 0.7]\nseed = 7\n"
      "[[projector]]\nsize = [320, 200]\nthrow_ratio = 1.2\nlens_shift = [0.0, 0.1]\nlookup = \"bilinear\"\n"
      "position = [0.35, -0.1, 2.1]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\n"
      "[[camera]]\nsize = [400, 250]\nfov_x_deg = 42\nposition = [-0.35, 0.15, 2.0]\nlook_at = [0, 0, 0]\n"
      "up = [0.1, 1, 0]\nsensor = { noise_sigma_dn = 0.7 }\n",
      "small.toml");
  spec.patterns.parameters = patterns;
  return spec;
}

ProjectorOutcome run(const Scene& scene, const TrialOptions& options = {}) {
  StageTimes times;
  return run_trial(scene, trace(scene, times), options, times).at(0);
}

TEST(PatternTrial, PhaseOnTheReliefIsRightAndFitsBetterThanGray) {
  Scene scene = load_scene(scenes / "relief.toml");
  scene.projectors[0].lookup = Lookup::bilinear;
  const ProjectorOutcome gray = run(scene);
  scene.patterns = {.kind = K::gray_phase, .steps = 4, .pitch_px = 16};
  const ProjectorOutcome phase = run(scene);
  EXPECT_EQ(phase.solve.status, Status::ok) << phase.solve.reason;
  EXPECT_THAT(phase.flags, IsEmpty());
  // Beyond three times the clustered prediction is beyond chance for a sum of 10 squared parameters.
  EXPECT_LE(phase.verification.volume.rms, 3 * phase.verification.volume.predicted_rms);
  EXPECT_LT(phase.solve.fit_rms_px, 0.25 * gray.solve.fit_rms_px);
  EXPECT_GT(phase.correspondences, 50000u);
}

TEST(PatternTrial, EveryFamilyRecoversTheProjector) {
  for (const PatternParameters& patterns :
       {PatternParameters{.kind = K::xor_gray},
        PatternParameters{.kind = K::gray_phase, .steps = 3, .pitch_px = 20},
        PatternParameters{.kind = K::phase, .steps = 6, .pitch_px = 40},
        PatternParameters{.kind = K::multi_frequency, .steps = 4, .pitch_px = 20},
        PatternParameters{.kind = K::micro_phase, .steps = 4, .pitch_px = 20}}) {
    const ProjectorOutcome o = run(build_scene(small_spec(patterns), "."));
    EXPECT_EQ(o.solve.status, Status::ok) << int(patterns.kind) << " " << o.solve.reason;
    EXPECT_THAT(o.flags, IsEmpty()) << int(patterns.kind);
    EXPECT_LE(o.verification.volume.rms, 3 * o.verification.volume.predicted_rms) << int(patterns.kind);
    EXPECT_LT(o.solve.fit_rms_px, patterns.kind == K::xor_gray ? 0.45 : 0.2) << int(patterns.kind);
    EXPECT_GT(o.correspondences, 20000u);
  }
}

TEST(PatternTrial, CrossingsFitBetterThanWholePixels) {
  SceneSpec spec = small_spec({});
  spec.projectors[0].device.size = {{120, 75}};  // the camera resolves the projector's pixels
  const Scene scene = build_scene(spec, ".");
  TrialOptions options;
  const ProjectorOutcome whole = run(scene, options);
  options.decode.gray.subpixel = true;
  const ProjectorOutcome refined = run(scene, options);
  EXPECT_LT(refined.solve.fit_rms_px, 0.6 * whole.solve.fit_rms_px);
  // Edges' shapes err alike from stripe to stripe, which blocks do not show: five times.
  EXPECT_LE(refined.verification.volume.rms, 5 * refined.verification.volume.predicted_rms);
}

TEST(PatternTrial, AFolderIsReadBackWithItsFamily) {
  const testing::ScratchFolder scratch;
  const PatternParameters patterns{.kind = K::multi_frequency, .steps = 5, .pitches_px = {17, 21.5, 26}};
  const SceneSpec spec = with_names(small_spec(patterns));
  StageTimes times;
  write_capture(spec, build_scene(spec, "."), ".", scratch / "capture", {.format = "pgm", .truth = false},
                times);
  const CaptureManifest manifest = read_manifest(scratch / "capture");
  EXPECT_EQ(manifest.sequences.at(0).patterns, patterns);
  const auto estimates =
      calibrate_folder(scratch / "capture", manifest, load_scene(scratch / "capture/scene.toml"), {}, {});
  EXPECT_EQ(estimates.at(0).solve.status, Status::ok) << estimates[0].solve.reason;
  EXPECT_LT(estimates[0].solve.fit_rms_px, 0.2);
}

TEST(PatternTrial, GammaIsFlagged) {
  SceneSpec spec = small_spec({.kind = K::gray_phase, .steps = 3, .pitch_px = 32});
  spec.effects.response = true;
  spec.projectors[0].effects.response_exponent = 2.2;
  EXPECT_THAT(run(build_scene(spec, ".")).flags, ::testing::Contains(HasSubstr("not linear")));
}

TEST(PatternTrial, PicturesOfTheUsersArePlayedAndTellNoPlace) {
  const testing::ScratchFolder scratch;
  for (const char* name : {"a.png", "b.png"})
    write_picture(scratch / name, Image<std::uint8_t>(320, 200, 128));
  SceneSpec spec = small_spec({.kind = K::pictures});
  spec.patterns.files = {"a.png", "b.png"};
  const Scene scene = build_scene(spec, scratch.path());
  StageTimes times;
  const Traced traced = trace(scene, times);
  const CapturedStack stack = capture_view(scene, traced, traced.views[0], 1, times);
  EXPECT_EQ(std::get<ImageStack<std::uint8_t>>(stack).count, 2);
  EXPECT_THAT(testing::input_error([&] { run(scene); }), HasSubstr("tell no pixel its place"));
  spec.patterns.files.clear();
  EXPECT_THAT(testing::input_error([&] { check(spec); }), HasSubstr("files is empty"));
}

}  // namespace
}  // namespace laterna
