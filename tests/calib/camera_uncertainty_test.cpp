#include "calib/camera_uncertainty.h"

#include "calib/solve.h"
#include "tests/calib/trials.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;

// A camera that looks at the volume that usual_projector() lights, from beside it.
Device camera_beside(const Device& projector) {
  Device camera;
  camera.name = "camera";
  camera.intrinsics = {{1280, 960}, 1500, 1500, 639.5, 479.5};
  camera.device_from_world =
      compose(rigid_from_rotation_vector({0.02, 0.25, -0.05}, {-0.8, 0.1, 0.2}), projector.device_from_world);
  return camera;
}

// The device after a step of its tangent parameters: fx, fy, cx, cy, lens, w, t; R = exp([w]×)·R̂.
Device moved(Device d, const std::vector<double>& step) {
  const std::size_t p = step.size();
  d.intrinsics.fx += step[0], d.intrinsics.fy += step[1];
  d.intrinsics.cx += step[2], d.intrinsics.cy += step[3];
  for (std::size_t i = 0; i < d.lens.parameters.size(); ++i) d.lens.parameters[i] += step[4 + i];
  const Rigid turn = rigid_from_rotation_vector({step[p - 6], step[p - 5], step[p - 4]}, glm::dvec3(0.0));
  d.device_from_world.rotation = turn.rotation * d.device_from_world.rotation;
  d.device_from_world.translation += glm::dvec3(step[p - 3], step[p - 2], step[p - 1]);
  return d;
}

// Where the ray of a camera pixel meets the plane through x with normal n.
glm::dvec3 seen(const Device& camera, const glm::dvec2& pixel, const glm::dvec3& x, const glm::dvec3& n) {
  const Rigid world_from_device = inverse(camera.device_from_world);
  const glm::dvec3 origin = world_from_device.translation;
  const glm::dvec3 ray =
      world_from_device.rotation * *LensProjection(camera.intrinsics, camera.lens).unproject(pixel);
  return origin + glm::dot(n, x - origin) / glm::dot(n, ray) * ray;
}

// x of a pixel (u, v) at depth z, on a plane that faces the camera: ∂x/∂cx = -z/fx, ∂x/∂fx = -x/fx, and t
// moves it back by as much.
TEST(CameraUncertainty, APointsDerivativeByHand) {
  Device camera;
  camera.intrinsics = {{640, 480}, 500, 400, 320, 240};
  const LensGradient lens("LENSMODEL_PINHOLE");
  std::vector<double> d;
  ASSERT_TRUE(point_by_camera(lens, state_of(camera), {0.3, -0.2, 2}, {0, 0, 1}, d));
  const std::vector<double> expected_x = {-0.3 / 500,         0,    -2.0 / 500, 0, /*w*/ 0.3 * -0.2 / 2,
                                          -2 - 0.3 * 0.3 / 2, -0.2, -1,         0, 0.3 / 2};
  for (int j = 0; j < 10; ++j) EXPECT_NEAR(d[j], expected_x[j], 1e-14) << j;
  for (int j = 0; j < 10; ++j) EXPECT_NEAR(d[20 + j], 0, 1e-14);                      // it stays on z = 2
  EXPECT_FALSE(point_by_camera(lens, state_of(camera), {0, 0, 2}, {0, 1, 0.01}, d));  // grazing
  EXPECT_FALSE(point_by_camera(lens, state_of(camera), {0, 0, -2}, {0, 0, 1}, d));    // behind
}

TEST(CameraUncertainty, APointsDerivativeByDifferencesWithALens) {
  Device camera = camera_beside(testing::usual_projector());
  camera.lens = {"LENSMODEL_OPENCV4", {-0.2, 0.05, 0.001, -0.002}};
  const LensGradient lens(camera.lens.model);
  const glm::dvec2 pixel(900, 200);
  const glm::dvec3 x = *WorldProjection(camera).unproject(pixel, 2.5);
  const glm::dvec3 n = glm::normalize(glm::dvec3(0.3, -0.2, 1));
  std::vector<double> d;
  ASSERT_TRUE(point_by_camera(lens, state_of(camera), x, n, d));
  for (int j = 0; j < 14; ++j) {
    std::vector<double> step(14, 0.0);
    const double h = step[j] = j < 4 ? 1e-3 : 1e-6;
    const glm::dvec3 after = seen(moved(camera, step), pixel, x, n);
    step[j] = -h;
    const glm::dvec3 before = seen(moved(camera, step), pixel, x, n);
    for (int i = 0; i < 3; ++i)  // unproject() ends within 1e-9 px = 2e-12 m, over 2e-6
      EXPECT_NEAR(d[14 * i + j], (after[i] - before[i]) / (2 * h), 5e-6) << j;
  }
}

struct Sightings {
  Device projector, camera;
  Correspondences points;
  std::vector<glm::dvec2> camera_pixels;
  std::vector<double> sigma;  // of the camera's ten parameters
};

// Points in the projector's volume on planes of many directions, noise-free, that a camera with independent
// errors saw.
Sightings sightings(int n, double sigma_px = 0.1) {
  auto random = testing::generator();
  Sightings s{testing::usual_projector(), {}, {}, {}, {2, 2, 1, 1, 5e-4, 5e-4, 5e-4, 1e-3, 1e-3, 1e-3}};
  s.camera = camera_beside(s.projector);
  s.points = testing::scattered(s.projector, n, 2, 3, sigma_px, random);
  std::normal_distribution<double> normal;
  std::vector<double> covariance(100, 0.0);
  for (int i = 0; i < 10; ++i) covariance[11 * i] = s.sigma[i] * s.sigma[i];
  s.points.cameras = {{s.camera, covariance}};
  s.points.camera.assign(n, 0);
  for (const glm::dvec3& x : s.points.world_points) {
    s.camera_pixels.emplace_back(WorldProjection(s.camera).project(x));
    const glm::dvec3 ray = glm::normalize(x - center_in_world(s.camera.device_from_world));
    const glm::dvec3 tilt(normal(random), normal(random), normal(random));
    s.points.normals_world.push_back(glm::normalize(-ray + 0.3 * tilt));
  }
  return s;
}

// The world points that a camera with these errors would give.
Correspondences seen_by(const Sightings& s, const std::vector<double>& step) {
  Correspondences c = s.points;
  const Device camera = moved(s.camera, step);
  for (std::size_t i = 0; i < c.world_points.size(); ++i)
    c.world_points[i] = seen(camera, s.camera_pixels[i], s.points.world_points[i], s.points.normals_world[i]);
  return c;
}

// 200 cameras drawn from the covariance, each solved on noise-free pixels. A sample's standard deviation of
// 200 has itself one of 1/√400 = 5 %; 20 % is four of them.
TEST(CameraUncertainty, SigmasAreThoseOfSampledCameras) {
  const Sightings s = sightings(120, 1);
  const SolveResult told = solve(s.points, s.projector.intrinsics.size);
  ASSERT_EQ(told.covariance_camera.size(), 100u);
  std::mt19937_64 random(testing::seed() + 1);
  std::normal_distribution<double> normal;
  constexpr int draws = 200;
  std::vector<double> sum2(10, 0.0);
  double chi2 = 0, volume2 = 0;
  SolveOptions options;
  options.start = s.projector;
  for (int k = 0; k < draws; ++k) {
    std::vector<double> step;
    for (const double sigma : s.sigma) step.push_back(sigma * normal(random));
    const SolveResult r = solve(seen_by(s, step), s.projector.intrinsics.size, options);
    ASSERT_NE(r.status, Status::refused) << r.reason;
    const auto e = testing::tangent_error(s.projector, r.estimate);
    for (int i = 0; i < 10; ++i) sum2[i] += e[i] * e[i];
    chi2 += r.reduced_chi2 * (2 * 120 - 10);
    volume2 += std::pow(verify(s.projector, r.estimate, {}, s.points.world_points).volume.rms, 2);
  }
  double worst = 0;
  for (int i = 0; i < 10; ++i) {
    const double ratio = std::sqrt(sum2[i] / draws / told.covariance_camera[11 * i]);
    EXPECT_NEAR(ratio, 1, 0.2) << i;
    worst = std::max(worst, std::abs(ratio - 1));
  }
  RecordProperty("worst_sigma_deviation", std::to_string(worst));
  RecordProperty("volume_ratio",
                 std::to_string(std::sqrt(volume2 / draws) / told.predicted_volume_rms_camera_px));
  RecordProperty("chi2_ratio", std::to_string(chi2 / draws / told.expected_camera_chi2));
  EXPECT_NEAR(std::sqrt(volume2 / draws) / told.predicted_volume_rms_camera_px, 1, 0.2);
  // Were one direction to make it all, the mean of 200 squared normals would scatter by √(2/200) = 10 %.
  EXPECT_NEAR(chi2 / draws / told.expected_camera_chi2, 1, 0.4);
}

TEST(CameraUncertainty, TheVerdictUsesTheTotal) {
  Sightings s = sightings(400);
  auto random = testing::generator();
  testing::add_noise(s.points, random);
  Correspondences certain = s.points;
  certain.cameras.clear(), certain.camera.clear(), certain.normals_world.clear();
  const SolveResult without = solve(certain, s.projector.intrinsics.size);
  const SolveResult with = solve(s.points, s.projector.intrinsics.size);
  EXPECT_EQ(without.status, Status::ok) << without.reason;
  EXPECT_EQ(with.status, Status::weak);
  EXPECT_THAT(with.reason, HasSubstr("from the camera's uncertainty"));
  // The estimate is the same; the two covariances add up.
  EXPECT_EQ(with.estimate.intrinsics.fx, without.estimate.intrinsics.fx);
  for (std::size_t i = 0; i < 100; ++i)
    EXPECT_EQ(with.covariance[i], without.covariance[i] + with.covariance_camera[i]);
  EXPECT_NEAR(std::pow(with.predicted_volume_rms_px, 2),
              std::pow(without.predicted_volume_rms_px, 2) + std::pow(with.predicted_volume_rms_camera_px, 2),
              1e-9 * std::pow(with.predicted_volume_rms_px, 2));
}

// A certain camera among them, or one whose covariance is 0, leaves no trace.
TEST(CameraUncertainty, CertainCamerasAddNothing) {
  Sightings s = sightings(200);
  s.points.cameras[0].covariance.assign(100, 0.0);
  const SolveResult zero = solve(s.points, s.projector.intrinsics.size);
  s.points.cameras[0].covariance.clear();
  const SolveResult none = solve(s.points, s.projector.intrinsics.size);
  for (const double x : zero.covariance_camera) EXPECT_EQ(x, 0);
  EXPECT_EQ(zero.covariance, none.covariance);
  EXPECT_EQ(zero.predicted_volume_rms_px, none.predicted_volume_rms_px);
}

// Residuals that the camera's uncertainty explains are no reason for weak; without it they are.
TEST(CameraUncertainty, ExplainedResidualsAreNoMisfit) {
  Sightings s = sightings(400, 0.02);
  SolveOptions options;
  options.tolerance_px = 100;  // the predicted error is another matter
  const std::vector<double> step = {2, -2, 1, 1, 5e-4, -5e-4, 5e-4, 1e-3, -1e-3, 1e-3};  // one sigma each
  Correspondences c = seen_by(s, step);
  EXPECT_EQ(solve(c, s.projector.intrinsics.size, options).status, Status::ok);
  c.cameras.clear(), c.camera.clear(), c.normals_world.clear();
  EXPECT_THAT(solve(c, s.projector.intrinsics.size, options).reason, HasSubstr("residual rms"));
}

TEST(CameraUncertainty, BadInputIsNamed) {
  const Sightings s = sightings(20);
  const auto error = [&](auto&& change) {
    Correspondences c = s.points;
    change(c);
    return testing::input_error([&] { validate(c); });
  };
  EXPECT_THAT(error([](auto& c) { c.normals_world.pop_back(); }), HasSubstr("19 normals"));
  EXPECT_THAT(error([](auto& c) { c.cameras.clear(); }), HasSubstr("0 uncertain cameras"));
  EXPECT_THAT(error([](auto& c) { c.camera[3] = 1; }), HasSubstr("correspondence 3: camera 1 of 1"));
  EXPECT_THAT(error([](auto& c) { c.normals_world[5] *= 2.0; }), HasSubstr("correspondence 5: a normal"));
  EXPECT_THAT(error([](auto& c) { c.cameras[0].covariance.pop_back(); }), HasSubstr("99 numbers"));
}

}  // namespace
}  // namespace laterna
