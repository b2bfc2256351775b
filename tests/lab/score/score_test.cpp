// Each of the usual mistakes, planted in a calibration, is the first that a score names; a right, a noisy and
// a generally wrong calibration name nobody.
#include "apps/lab/score/score.h"

#include "apps/lab/trial.h"
#include "calib/refine.h"
#include "calib/solve.h"
#include "calib/verify.h"
#include "sim/scene_file.h"
#include "tests/testing.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace laterna {
namespace {

// Two rigs, small: one with the lens shift of a real projector, whose axis is below its picture; one nearly
// centred.
Scene scene_of(bool is_shifted, const std::string& rest = "", const std::string& projector = "") {
  const std::string optics = is_shifted ? "fx = 474.0\nfy = 474.5\ncx = 161.2\ncy = 202.7\n"
                                          "position = [-0.2, -1.0, 2.0]\nlook_at = [-0.1, -0.6, 0]\n"
                                        : "throw_ratio = 1.2\nlens_shift = [0.02, 0.1]\n"
                                          "position = [0.35, -0.1, 2.1]\nlook_at = [0, 0, 0]\n";
  return build_scene(
      parse_scene("[[mesh]]\nshape = \"relief\"\nshape_size = [1.6, 1.0, 0.7]\nseed = 7\n[[projector]]\n"
                  "name = \"left\"\nsize = [320, 200]\nup = [0, 1, 0]\n" +
                      optics + projector +
                      "\n[[camera]]\nname = \"eye\"\nsize = [400, 250]\nfov_x_deg = 42\n"
                      "position = [-0.35, 0.15, 2.0]\nlook_at = [0, 0, 0]\nup = [0.1, 1, 0]\n" +
                      rest,
                  "small.toml"),
      ".");
}

// A scene with what is needed to try suspects on it, made once.
struct Case {
  explicit Case(bool is_shifted) : scene(scene_of(is_shifted)) {
    StageTimes times;
    const Traced traced = trace(scene, times);
    const auto outcomes = run_trial(scene, traced, {}, times);
    recovered = outcomes[0].solve.estimate;
    bound_px = outcomes[0].verification.volume.predicted_rms;
    surface = lit_points(traced, 0);
    truth = {scene.cameras[0].device, scene.projectors[0].device};
  }
  std::vector<Suspect> suspects(const ScoreRig& result, const Alignment& alignment = {}) const {
    return geometric_suspects(result, make_probe(truth, alignment, surface), bound_px);
  }
  Scene scene;
  ScoreRig truth;
  Device recovered;
  double bound_px = 0;
  LargeVector<glm::dvec3> surface;
};

class OnTwoRigs : public ::testing::TestWithParam<bool> {
 protected:
  static const Case& rig() {
    static const Case shifted(true), centred(false);
    return GetParam() ? shifted : centred;
  }
  // The recovered projector (with its noise) beside the true camera, both with a mistake.
  template <class Edit>
  static void expect_first(const std::string& name, const Edit& edit, const Alignment& alignment = {}) {
    ScoreRig result{rig().truth.camera, rig().recovered};
    edit(result);
    const auto suspects = rig().suspects(result, alignment);
    ASSERT_FALSE(suspects.empty()) << name << " is not named";
    EXPECT_EQ(suspects.front().name, name);
    EXPECT_GT(suspects.front().explains, 0.9);  // the noise left is far below half a pixel
  }
};
INSTANTIATE_TEST_SUITE_P(Score, OnTwoRigs, ::testing::Bool());

TEST_P(OnTwoRigs, ARightCalibrationNamesNobody) {
  EXPECT_THAT(rig().suspects({rig().truth.camera, rig().recovered}), ::testing::IsEmpty());
  EXPECT_THAT(rig().suspects(rig().truth, {true, true}), ::testing::IsEmpty());
}

TEST_P(OnTwoRigs, SwappedSize) {
  const auto size = [](Intrinsics& k) { std::swap(k.size.x, k.size.y); };
  const auto centre = [](Intrinsics& k) { std::swap(k.cx, k.cy); };
  expect_first("size_swapped", [&](ScoreRig& r) { size(r.projector.intrinsics); });
  expect_first("size_swapped", [&](ScoreRig& r) { centre(r.projector.intrinsics); });
  expect_first("size_swapped", [&](ScoreRig& r) {
    size(r.projector.intrinsics), centre(r.projector.intrinsics);
    std::swap(r.projector.intrinsics.fx, r.projector.intrinsics.fy);
  });
}

TEST_P(OnTwoRigs, HalfAPixel) {
  for (const double half : {-0.5, 0.5}) {
    expect_first("half_pixel",
                 [&](ScoreRig& r) { r.projector.intrinsics.cx += half, r.projector.intrinsics.cy += half; });
  }
}

TEST_P(OnTwoRigs, FlippedY) {
  expect_first("y_flipped", [](ScoreRig& r) {
    r.projector.intrinsics.cy = r.projector.intrinsics.size.y - 1 - r.projector.intrinsics.cy;
  });
  const glm::dmat3 opengl(glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, -1));
  expect_first("y_flipped", [&](ScoreRig& r) {
    Rigid& pose = r.projector.device_from_world;
    pose = {opengl * pose.rotation, opengl * pose.translation};
  });
}

TEST_P(OnTwoRigs, InversePose) {
  const auto invert = [](Device& d) { d.device_from_world = inverse(d.device_from_world); };
  expect_first("inverse_pose", [&](ScoreRig& r) { invert(r.projector); });
  expect_first("inverse_pose", [&](ScoreRig& r) { invert(r.projector), invert(*r.camera); }, {true, false});
}

TEST_P(OnTwoRigs, TransposedRotation) {
  expect_first("rotation_transposed", [](ScoreRig& r) {
    r.projector.device_from_world.rotation = glm::transpose(r.projector.device_from_world.rotation);
  });
}

TEST_P(OnTwoRigs, Units) {
  for (const double unit : {1000.0, 0.01}) {
    const auto scaled = [&](ScoreRig& r) {
      r.projector.device_from_world.translation *= unit;
      r.camera->device_from_world.translation *= unit;
    };
    expect_first("unit_scale", scaled);
    expect_first("unit_scale", scaled, {true, false});
    ScoreRig result{rig().truth.camera, rig().recovered};
    scaled(result);
    EXPECT_THAT(rig().suspects(result, {true, true}), ::testing::IsEmpty());  // scale is not judged
  }
}

TEST_P(OnTwoRigs, ExchangedAxes) {
  const glm::dmat3 exchanged(glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1));
  for (const double side : {1.0, -1.0}) {  // as it is, a reflection; or made a rotation
    expect_first("axes_exchanged", [&](ScoreRig& r) {
      std::swap(r.projector.intrinsics.fx, r.projector.intrinsics.fy);
      std::swap(r.projector.intrinsics.cx, r.projector.intrinsics.cy);
      Rigid& pose = r.projector.device_from_world;
      pose = {side * (exchanged * pose.rotation), side * (exchanged * pose.translation)};
    });
  }
}

TEST_P(OnTwoRigs, Overscan) {
  expect_first("overscan", [](ScoreRig& r) {
    Intrinsics& k = r.projector.intrinsics;
    const glm::dvec2 middle = (glm::dvec2(k.size) - 1.0) / 2.0;
    k.fx *= 0.95, k.fy *= 0.95;
    k.cx = middle.x + 0.95 * (k.cx - middle.x), k.cy = middle.y + 0.95 * (k.cy - middle.y);
  });
}

TEST_P(OnTwoRigs, Unconverged) {
  const Case& c = rig();
  Correspondences exact;
  exact.world_points = c.surface;
  const WorldProjection projection(c.truth.projector);
  for (const auto& x : c.surface) exact.projector_pixels.emplace_back(projection.project(x));
  exact.sigma_px.assign(c.surface.size(), 1.0);
  // Intrinsics as a solve begins with, and the placement that fits them best.
  SolveOptions options;
  Intrinsics guess = c.truth.projector.intrinsics;
  guess.fx = guess.fy = 1.3 * guess.size.x;
  guess.cx = (guess.size.x - 1) / 2.0, guess.cy = (guess.size.y - 1) / 2.0;
  options.known = KnownIntrinsics{guess, {}};
  const SolveResult start = solve(subset(exact, evenly_spread(c.surface.size(), 2000)), guess.size, options);
  ASSERT_NE(start.status, Status::refused) << start.reason;
  expect_first("unconverged", [&](ScoreRig& r) { r.projector = start.estimate; });
}

// Every number off by chance: 0.2 to 2 % of the focal lengths, as much of the picture for the centre, of a
// radian and of a metre for the placement. As a start of a solver it is as good as any, and no more is said.
TEST_P(OnTwoRigs, AGenerallyWrongCalibrationIsAtMostAStart) {
  auto generator = testing::generator();
  std::normal_distribution<double> normal;
  constexpr int tries = 20;
  int others = 0;
  for (int i = 0; i < tries; ++i) {
    const double size = 0.002 * std::pow(10.0, i / double(tries));
    const auto by = [&] { return size * normal(generator); };
    ScoreRig result = rig().truth;
    Intrinsics& k = result.projector.intrinsics;
    k.fx *= 1 + by(), k.fy *= 1 + by(), k.cx += k.size.x * by(), k.cy += k.size.y * by();
    const Rigid moved =
        rigid_from_rotation_vector(glm::dvec3(by(), by(), by()), glm::dvec3(by(), by(), by()));
    result.projector.device_from_world = compose(moved, result.projector.device_from_world);
    for (const Suspect& s : rig().suspects(result)) others += s.name != "unconverged";
  }
  EXPECT_LE(others, 1);  // one in twenty by chance
}

// Where decoded points hold the same error, a solver ends at it: it is not to blame.
TEST_P(OnTwoRigs, WhatTheDecodedPointsSayIsNotUnconverged) {
  ScoreRig result = rig().truth;
  result.projector.intrinsics.fx *= 1.01, result.projector.intrinsics.cy += 3;
  Correspondences decoded;
  decoded.world_points = rig().surface;
  const WorldProjection as_decoded(result.projector), truly(rig().truth.projector);
  for (const auto& x : rig().surface) decoded.projector_pixels.emplace_back(as_decoded.project(x));
  decoded.sigma_px.assign(rig().surface.size(), 0.1);
  const Probe probe = make_probe(rig().truth, {}, rig().surface);
  EXPECT_THAT(geometric_suspects(result, probe, rig().bound_px, decoded), ::testing::IsEmpty());
  decoded.projector_pixels.clear();
  for (const auto& x : rig().surface) decoded.projector_pixels.emplace_back(truly.project(x));
  const auto suspects = geometric_suspects(result, probe, rig().bound_px, decoded);
  ASSERT_EQ(suspects.size(), 1u);
  EXPECT_EQ(suspects[0].name, "unconverged");
}

TEST_P(OnTwoRigs, TwoMistakesStandInFrontTogether) {
  ScoreRig result{rig().truth.camera, rig().recovered};
  Intrinsics& k = result.projector.intrinsics;
  k.cx += 0.5, k.cy += 0.5;
  for (Device* d : {&result.projector, &*result.camera}) d->device_from_world.translation *= 1000.0;
  const auto suspects = rig().suspects(result);
  ASSERT_GE(suspects.size(), 2u);
  EXPECT_EQ(suspects[0].name, "unit_scale");  // which explains more alone
  EXPECT_EQ(suspects[1].name, "half_pixel");
  EXPECT_EQ(suspects[0].explains, suspects[1].explains);
}

std::vector<ProjectorScore> scored(const Scene& truth, const Device& projector) {
  return score({truth}, {Rig{{}, {projector}}, {{}}});
}

std::string first_name(const std::vector<ProjectorScore>& scores) {
  return scores.at(0).suspects.empty() ? "" : scores[0].suspects[0].name;
}

TEST(Score, OfARecoveredProjectorIsOkAndNamesNobody) {
  const Scene scene = scene_of(false);
  StageTimes times;
  const auto outcome = run_trial(scene, trace(scene, times), {}, times).at(0);
  const auto scores = scored(scene, outcome.solve.estimate);
  EXPECT_EQ(scores.at(0).status, Status::ok);
  EXPECT_EQ(first_name(scores), "");
  // The same points and definitions.
  EXPECT_NEAR(scores[0].volume_error_px, outcome.verification.volume.rms, 1e-9);
  EXPECT_NEAR(scores[0].surface_error_px, outcome.verification.surface.rms, 1e-9);
  EXPECT_NEAR(scores[0].volume_bound_px, outcome.verification.volume.predicted_rms, 1e-12);
  // A pixel is some 2 m/384 wide on the relief; a fifth of that depth is relief.
  EXPECT_NEAR(scores[0].surface_error_mm, 1000 * scores[0].surface_error_px * 2.0 / 384,
              0.4 * scores[0].surface_error_mm);
}

TEST(Score, AScalersPictureIsNamed) {
  for (const auto& [projector, name] :
       {std::pair("scaler = { overscan = 0.05 }", "overscan"),
        std::pair("scaler = { keystone = [0.0, 0.0, 1.0, 0.0, 0.85, 1.0, 0.12, 1.0] }", "keystone")}) {
    const Scene scene = scene_of(false, "[effects]\nscaler = true\n", projector);
    StageTimes times;
    const auto outcome = run_trial(scene, trace(scene, times), {}, times).at(0);
    EXPECT_EQ(first_name(scored(scene, outcome.solve.estimate)), name) << outcome.solve.reason;
  }
}

// What is recovered from the scene's own pictures.
Device recovered(const Scene& scene) {
  StageTimes times;
  return run_trial(scene, trace(scene, times), {}, times).at(0).solve.estimate;
}

TEST(Score, ABentResponseIsNamedWhereItDoesHarm) {
  const auto scene = [](const char* kind, int steps, double exponent) {
    return scene_of(
        false,
        fmt::format("[patterns]\nkind = \"{}\"\nsteps = {}\n[effects]\nresponse = true\n", kind, steps),
        fmt::format("response_exponent = {}", exponent));
  };
  const Scene bent = scene("phase", 3, 2.2), linear = scene("phase", 3, 1.0);
  EXPECT_EQ(first_name(scored(bent, recovered(bent))), "gamma");
  EXPECT_EQ(first_name(scored(linear, recovered(linear))), "");
  EXPECT_EQ(first_name(scored(bent, bent.projectors[0].device)), "");  // right whatever its pictures
  // Eight steps or black and white hide it: another's mistake is not blamed on it.
  for (const Scene& harmless : {scene("phase", 8, 2.2), scene("gray", 4, 2.2)}) {
    Device wrong = harmless.projectors[0].device;
    EXPECT_EQ(first_name(scored(harmless, recovered(harmless))), "");
    wrong.intrinsics.cx += 0.5, wrong.intrinsics.cy += 0.5;
    const auto suspects = scored(harmless, wrong).at(0).suspects;
    ASSERT_EQ(suspects.size(), 1u);
    EXPECT_EQ(suspects[0].name, "half_pixel");
  }
}

TEST(Score, ADroppedFrameIsNamed) {
  const Scene scene = scene_of(false, "[timing]\ndropped_frame = 9\n[effects]\ntiming = true\n");
  EXPECT_EQ(first_name(scored(scene, scene.projectors[0].device)), "dropped_frame");
}

}  // namespace
}  // namespace laterna
