// A right cloud of points is ok; each usual mistake in one is named; outliers are counted.
#include "apps/lab/score/cloud_score.h"

#include "apps/lab/capture_cloud.h"
#include "apps/lab/trial.h"
#include "render/effects/apply_effects.h"
#include "sim/scene_file.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using testing::input_error;
using ::testing::IsEmpty;

const char* const small = R"(
[[mesh]]
shape = "relief"
shape_size = [1.6, 1.0, 0.7]
seed = 7
[[projector]]
name = "left"
size = [160, 100]
throw_ratio = 1.2
lens_shift = [0.0, 0.1]
position = [0.35, -0.1, 2.1]
look_at = [0, 0, 0]
up = [0, 1, 0]
[[camera]]
name = "eye"
size = [200, 125]
fov_x_deg = 42
position = [-0.35, 0.15, 2.0]
look_at = [0, 0, 0]
up = [0.1, 1, 0]
)";

// A scene and the cloud that Laterna's decoder makes of other pictures of it than those of the bound.
class CloudScores : public ::testing::Test {
 protected:
  static const ScoreTruth& truth() {
    static const ScoreTruth made{build_scene(parse_scene(small, "small.toml"), ".")};
    return made;
  }
  static const PointCloud& decoded() {
    static const PointCloud made = [] {
      const Scene& scene = truth().scene;
      StageTimes times;
      const Traced traced = trace(scene, times);
      const CapturedStack pictures = capture_view(scene, traced, traced.views[0], 7, times);
      PointCloud cloud{{}, true, true};
      append_cloud(decode(pictures, pattern_sequence(scene, scene.projectors[0]), {}),
                   scene.cameras[0].device, scene.projectors[0].device, cloud.points);
      return cloud;
    }();
    return made;
  }
  template <class Edit>
  static PointCloud edited(const Edit& edit, bool has_pixels = true) {
    PointCloud cloud = decoded();
    for (CloudPoint& p : cloud.points) edit(p);
    cloud.has_projector_px = cloud.has_camera_px = has_pixels;
    return cloud;
  }
  static void expect_named(const std::string& name, const PointCloud& cloud,
                           const CloudScoreOptions& options = {}) {
    const CloudScore score = score_cloud(truth(), cloud, options);
    EXPECT_EQ(score.status, Status::weak);
    ASSERT_FALSE(score.suspects.empty()) << name << " is not named";
    EXPECT_EQ(score.suspects.front().name, name);
    EXPECT_GT(score.suspects.front().explains, 0.9);  // noise is far below the mistake
  }
  static const Device& eye() { return truth().scene.cameras[0].device; }
};

TEST_F(CloudScores, ARightCloudIsOkWithPixelsAndWithout) {
  for (const bool has_pixels : {true, false}) {
    const CloudScore score = score_cloud(truth(), edited([](CloudPoint&) {}, has_pixels));
    EXPECT_EQ(score.status, Status::ok);
    EXPECT_THAT(score.suspects, IsEmpty());
    EXPECT_EQ(score.points, decoded().points.size());
    // Other noise of the same kind: thousands of points agree to some per cent.
    EXPECT_NEAR(score.error.surface_mm, score.bound.surface_mm, 0.2 * score.bound.surface_mm);
    EXPECT_EQ(std::isnan(score.error.projector_px), !has_pixels);
    EXPECT_EQ(std::isnan(score.error.point_mm), !has_pixels);
    if (has_pixels) {
      EXPECT_LE(score.error.surface_mm, score.error.point_mm)
          << "the nearest point is no farther than a certain one";
    }
  }
}

TEST_F(CloudScores, OutliersAreCountedAndMakeItWeak) {
  PointCloud cloud = decoded();
  for (std::size_t i = 0; i < cloud.points.size(); i += 20) cloud.points[i].x_world.z += 0.3;
  const CloudScore score = score_cloud(truth(), cloud);
  EXPECT_EQ(score.status, Status::weak);
  EXPECT_THAT(score.suspects, IsEmpty());
  const std::size_t planted = (cloud.points.size() + 19) / 20;
  EXPECT_GE(score.outliers, planted * 9 / 10);  // some land beside another part of the relief
  EXPECT_LE(score.outliers, planted * 3 / 2);   // beside the planted ones those that noise makes
  EXPECT_THAT(cloud_score_text(score), HasSubstr(" outliers: "));
  CloudScoreOptions wide;
  wide.outlier_mm = 1e4;
  EXPECT_EQ(score_cloud(truth(), cloud, wide).outliers, 0u);
}

TEST_F(CloudScores, UsualMistakesAreNamed) {
  for (const bool has_pixels : {true, false}) {
    SCOPED_TRACE(has_pixels);
    for (const double unit : {1000.0, 1 / 0.0254})
      expect_named("unit_scale", edited([&](CloudPoint& p) { p.x_world *= unit; }, has_pixels));
    expect_named("y_flipped", edited([](CloudPoint& p) { p.x_world.y *= -1; }, has_pixels));
    expect_named("inverse_pose", edited(
                                     [](CloudPoint& p) {
                                       const Rigid& m = eye().device_from_world;
                                       p.x_world = apply(m, apply(m, p.x_world));
                                     },
                                     has_pixels));
  }
  expect_named("y_flipped", edited([](CloudPoint& p) { p.projector_px.y = 99 - p.projector_px.y; }));
  expect_named("axes_exchanged",
               edited([](CloudPoint& p) { std::swap(p.projector_px.x, p.projector_px.y); }));
}

TEST_F(CloudScores, OutliersHideNoMistakeAndAnythingElseNamesNobody) {
  for (const bool has_pixels : {true, false}) {
    SCOPED_TRACE(has_pixels);
    auto random = testing::generator();
    std::normal_distribution<double> normal;
    const auto noise = [&](double sigma) {
      return sigma * glm::dvec3(normal(random), normal(random), normal(random));
    };
    std::size_t i = 0;
    expect_named(
        "unit_scale",
        edited([&](CloudPoint& p) { p.x_world = ++i % 10 ? 1000.0 * p.x_world : noise(3000); }, has_pixels));
    const auto names_nobody = [&](const auto& edit) {
      const CloudScore score = score_cloud(truth(), edited(edit, has_pixels));
      EXPECT_EQ(score.status, Status::weak);
      EXPECT_THAT(score.suspects, IsEmpty());
      EXPECT_EQ(score.better_frame, "");
    };
    names_nobody([](CloudPoint& p) { p.x_world.x += 0.2; });
    names_nobody([&](CloudPoint& p) { p.x_world += noise(0.05); });
    names_nobody([](CloudPoint& p) { p.x_world *= 1.3; });  // a surface through the origin
    names_nobody([](CloudPoint& p) { p.x_world.z += 5; });
  }
}

TEST_F(CloudScores, ACamerasFrameIsFoundAndMayBeTold) {
  const auto to_eye = [](CloudPoint& p) { p.x_world = apply(eye().device_from_world, p.x_world); };
  for (const bool has_pixels : {true, false}) {
    const CloudScore lost = score_cloud(truth(), edited(to_eye, has_pixels));
    EXPECT_EQ(lost.status, Status::weak);
    EXPECT_EQ(lost.better_frame, "eye");
    EXPECT_THAT(lost.suspects, IsEmpty());
    CloudScoreOptions told;
    told.frame = "eye";
    EXPECT_EQ(score_cloud(truth(), edited(to_eye, has_pixels), told).status, Status::ok);
  }
  const CloudScore both = score_cloud(truth(), edited(
                                                   [&](CloudPoint& p) {
                                                     to_eye(p);
                                                     p.x_world *= 1000;
                                                   },
                                                   false));
  EXPECT_EQ(both.better_frame, "eye");
  ASSERT_EQ(both.suspects.size(), 1u);
  EXPECT_EQ(both.suspects[0].name, "unit_scale");
}

TEST_F(CloudScores, AlignmentNeedsPixelsAndTakesAwayWhatItSays) {
  const auto moved = [](CloudPoint& p) {
    p.x_world = apply(rigid_from_rotation_vector({0.3, -1, 2}, {4, 5, 6}), p.x_world);
  };
  const auto scaled = [](CloudPoint& p) { p.x_world *= 1.07; };
  const auto with = [](bool world, bool scale) {
    CloudScoreOptions options;
    options.alignment = {world, scale};
    return options;
  };
  EXPECT_EQ(score_cloud(truth(), edited(moved), with(true, false)).status, Status::ok);
  EXPECT_EQ(score_cloud(truth(), edited(scaled), with(false, true)).status, Status::ok);
  EXPECT_EQ(score_cloud(truth(), edited(scaled), with(true, false)).status, Status::weak);
  PointCloud of_projector = edited([&](CloudPoint& p) { scaled(p), moved(p); });
  EXPECT_EQ(score_cloud(truth(), of_projector, with(true, true)).status, Status::ok);
  of_projector.has_camera_px = false;
  EXPECT_EQ(score_cloud(truth(), of_projector, with(true, true)).status, Status::ok);
  expect_named("unit_scale", edited([&](CloudPoint& p) { moved(p), p.x_world *= 1000; }), with(true, false));
  EXPECT_THAT(input_error([&] { (void)score_cloud(truth(), edited(moved, false), with(true, false)); }),
              HasSubstr("--align world: the cloud's points have no pixels"));
  PointCloud pair = edited(moved);
  pair.points.resize(2);
  EXPECT_THAT(input_error([&] { (void)score_cloud(truth(), pair, with(true, false)); }),
              HasSubstr("fewer than three points"));
}

TEST_F(CloudScores, PointsBeyondAnyNumberAreOutliers) {
  PointCloud cloud = decoded();
  cloud.points[0].x_world = {1e300, -1e300, 1e300};
  cloud.points[1].x_world = {1e39, 0, 0};
  const CloudScore score = score_cloud(truth(), cloud);
  EXPECT_TRUE(std::isfinite(score.error.surface_mm) && std::isfinite(score.error.projector_px));
  EXPECT_GE(score.outliers, 2u);
}

TEST_F(CloudScores, UnknownDevicesAreOneSentence) {
  CloudScoreOptions options;
  options.frame = "nobody";
  EXPECT_THAT(input_error([&] { (void)score_cloud(truth(), decoded(), options); }),
              HasSubstr("--frame: the scene has no device \"nobody\""));
  options = {};
  options.projector = "nobody";
  EXPECT_THAT(input_error([&] { (void)score_cloud(truth(), decoded(), options); }),
              HasSubstr("--projector: the scene has none called \"nobody\""));
}

}  // namespace
}  // namespace laterna
