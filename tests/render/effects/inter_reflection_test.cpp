// Diffuse paths beside closed forms: the spherical cavity, and a V-groove beside its radiosity.
#include "render/effects/inter_reflection.h"

#include "render/pixel_samples.h"
#include "render/transpose.h"
#include "sim/parallel.h"
#include "tests/render/effects/lit_scene.h"
#include "tests/testing.h"

#include <cmath>
#include <numbers>
#include <numeric>

namespace laterna {
namespace {

using testing::device_at;
using testing::object_of;
using testing::scene_of;

constexpr double pi = std::numbers::pi;
constexpr double albedo = 0.8;  // of object_of

Scene reflecting(Scene scene, int bounces, int paths) {
  scene.effects.inter_reflection = true;
  scene.inter_reflection = {bounces, paths};
  return scene;
}

void flip(Mesh& mesh) {
  for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
}

// A scene ready to be asked for rows.
struct Ready {
  const Scene& scene;
  RayScene rays;
  CameraRays directions;

  explicit Ready(const Scene& s) : scene(s), rays(s), directions(s.cameras[0].device) {}
  ImageRows image(int projector = 0, const PixelSamples& samples = {1, 5}) const {
    return {{directions.width(), directions.height()},
            trace_rows(rays, scene, 0, directions, projector, samples),
            region_px_of(scene, samples)};
  }
  LightRows rows(int projector = 0) const {
    LightRows rows;
    rows.region = {0, 0, directions.width(), directions.height()};
    image(projector).rows(rows);
    return rows;
  }
};

ImageStack<float> luminance(const Scene& scene, const PatternStack& patterns) {
  return play_luminance(Ready(scene).image(), Lookup::nearest, patterns);
}

// Patterns of 0 and 255 where lit(pattern, x, y).
template <class Lit>
PatternStack patterns_of(glm::ivec2 size, int count, const Lit& lit) {
  PatternStack stack = testing::constant_pattern(size, count, 0);
  for (int y = 0, i = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      for (int k = 0; k < count; ++k, ++i) stack.values[i] = lit(k, x, y) ? 255 : 0;
  return stack;
}

// Inside a sphere any two surface elements see each other with dF = dA/(4πR²), wherever they lie. So one
// bounce gives every point a·Φ/(4πR²), with Φ all the light that has landed, and k bounces give
// Φ·(a + a² + ... + a^k)/(4πR²) = Φ·a(1 - a^k)/((1 - a)·4πR²), whatever the pattern.
TEST(InterReflection, ASphericalCavityFillsEvenly) {
  Mesh cavity = sphere(1, 63);
  flip(cavity);
  const Scene dark = scene_of({object_of(cavity)}, device_at({-0.2, 0.1, 0.05}, {0.3, 0.2, 1}, {32, 24}, 16),
                              device_at({0.1, 0.05, 0}, {1, 0, 0}, {8, 8}, 3));
  const PatternStack patterns = patterns_of({8, 8}, 4, [](int k, int x, int y) {
    return k == 0 || (k == 1 && x < 4) || (k == 2 && y < 4) || (k == 3 && (x / 2 + y / 2) % 2);
  });
  const ImageStack<float> direct = luminance(dark, patterns);
  for (const int bounces : {1, 3}) {
    const ImageStack<float> whole = luminance(reflecting(dark, bounces, 512), patterns);
    for (int k = 0; k < 4; ++k) {
      const double flux_lm = k == 0 ? 1000 : 500;
      const double expected_lx = flux_lm * albedo * (1 - std::pow(albedo, bounces)) / ((1 - albedo) * 4 * pi);
      double quadrant[4] = {};
      for (int p = 0; p < 32 * 24; ++p) {
        const double added = double(whole.picture(k)[p]) - direct.picture(k)[p];
        quadrant[p / 32 / 12 * 2 + p % 32 / 16] += added * pi / albedo / (16 * 12);
      }
      const double mean = std::accumulate(quadrant, quadrant + 4, 0.0) / 4;
      // 1 %: what is asked; noise is 0.3 % (768 × 512 paths, a sigma of 2 to 3 each, some of it taken away by
      // their cells), flat triangles in place of the sphere 0.1 %.
      EXPECT_NEAR(mean, expected_lx, 0.01 * expected_lx);
      // 2 %: a quarter of the paths has twice the noise; three sigma.
      for (const double lx : quadrant) EXPECT_NEAR(lx, expected_lx, 0.02 * expected_lx);
    }
  }
}

// An endless V-groove in two dimensions, cut into strips: irradiance[flank][strip] after `bounces`.
struct Radiosity {
  static constexpr int strips = 200;
  double opening, length;
  std::vector<double> flank[2];  // illuminance that is still to be reflected

  // From a point of one flank to the other flank's strip t0..t1: half the difference of the sines of the
  // directions' angles from the normal (two-dimensional form factor; distances from the crease).
  double form_factor(double s, double t0, double t1) const {
    const auto sine = [&](double t) {
      return (t * std::cos(opening) - s) / std::hypot(t * std::cos(opening) - s, t * std::sin(opening));
    };
    return std::abs(sine(t1) - sine(t0)) / 2;
  }
  double gathered(double s, const std::vector<double>& other) const {
    double sum = 0;
    for (int m = 0; m < strips; ++m)
      sum += albedo * other[m] * form_factor(s, m * length / strips, (m + 1) * length / strips);
    return sum;
  }
  void bounce() {
    std::vector<double> next[2];
    for (int side = 0; side < 2; ++side)
      for (int m = 0; m < strips; ++m)
        next[side].push_back(gathered((m + 0.5) * length / strips, flank[1 - side]));
    flank[0] = next[0], flank[1] = next[1];
  }
};

// The projector looks down along the groove's plane of symmetry, so that its left half is the left flank.
// With irradiance off each lit point gets the same light: the problem is the same at each y.
Scene groove(double opening_deg) {
  Scene scene =
      scene_of({object_of(v_groove(2, 60, opening_deg))}, device_at({0, 0, 6}, {0, 0, 0}, {40, 16}, 110),
               device_at({0, 0, 4}, {0, 0, 0}, {64, 8}, 90));
  scene.effects.irradiance = scene.effects.border = false;
  return scene;
}

void expect_radiosity(double opening_deg, bool right_is_lit) {
  constexpr int bounces = 3, paths = 256;
  const Scene dark = groove(opening_deg);
  const testing::Lit lit(dark);
  const PatternStack pattern =
      patterns_of({64, 8}, 1, [&](int, int x, int) { return right_is_lit || x < 32; });
  const ImageStack<float> direct = luminance(dark, pattern),
                          whole = luminance(reflecting(dark, bounces, paths), pattern);
  const double white_lx = 1000.0 / (64 * 8) * 90 * 90, half = glm::radians(opening_deg) / 2;
  std::vector<Radiosity> before;  // of each bounce
  Radiosity groove{2 * half, 1 / std::sin(half), {}};
  for (int side = 0; side < 2; ++side)
    groove.flank[side].assign(Radiosity::strips, side == 0 || right_is_lit ? white_lx : 0);
  for (int b = 0; b < bounces; ++b) before.push_back(groove), groove.bounce();
  constexpr int bins = 8, columns = 40 / bins;
  double sum = 0, sum_expected = 0;
  for (int bin = 0; bin < bins; ++bin) {
    double added_lx = 0, expected_lx = 0;
    for (int x = bin * columns; x < (bin + 1) * columns; ++x) {
      const double x_m = lit.points.values[x].x;  // the same in each row
      for (const Radiosity& r : before)
        expected_lx += r.gathered(std::abs(x_m) / std::sin(half), r.flank[x_m < 0]) / columns;
      for (int y = 0; y < 16; ++y) {
        const std::size_t p = std::size_t(y) * 40 + x;
        added_lx += (double(whole.picture(0)[p]) - direct.picture(0)[p]) * pi / albedo / (16 * columns);
      }
    }
    // 0.6 % of the direct light: four sigma of a bin's 20,000 paths, partly stratified.
    EXPECT_NEAR(added_lx, expected_lx, 0.006 * white_lx) << "at bin " << bin;
    sum += added_lx / bins, sum_expected += expected_lx / bins;
  }
  // 1 %: two sigma of all 160,000 paths where one flank is lit; the strips' own error is below 0.1 %.
  EXPECT_NEAR(sum, sum_expected, 0.01 * sum_expected);
}

TEST(InterReflection, AGrooveIsItsRadiosity) {
  for (const double opening_deg : {60.0, 100.0}) expect_radiosity(opening_deg, true);
}
TEST(InterReflection, AGrooveWithOneFlankLitIsItsRadiosity) {
  for (const double opening_deg : {60.0, 100.0}) expect_radiosity(opening_deg, false);
}

TEST(InterReflection, APlaneAloneGetsNothing) {
  Object tilted = object_of(plane(4, 4, 13, 13), {100, -70, 30});
  tilted.world_from_object = glm::rotate(tilted.world_from_object, 1.0, glm::dvec3(1, 2, 0.5));
  const glm::dvec3 above = glm::dvec3(tilted.world_from_object * glm::dvec4(0.3, 0.2, 3, 1)),
                   middle = glm::dvec3(tilted.world_from_object * glm::dvec4(0, 0, 0, 1));
  const Scene scene = scene_of({tilted}, device_at(above, middle, {60, 40}, 40),
                               device_at(above + glm::dvec3(0.1, 0, 0), middle, {50, 30}, 30));
  const LightRows direct = Ready(scene).rows(), whole = Ready(reflecting(scene, 2, 64)).rows();
  EXPECT_GT(direct.entries.size(), 1000u);
  EXPECT_EQ(direct.begin, whole.begin);
}

void expect_same_rows(const LightRows& a, const LightRows& b) {
  EXPECT_EQ(a.begin, b.begin);
  EXPECT_EQ(a.ambient_cd_per_m2, b.ambient_cd_per_m2);
  ASSERT_EQ(a.entries.size(), b.entries.size());
  for (std::size_t e = 0; e < a.entries.size(); ++e) {
    ASSERT_EQ(a.entries[e].u_px, b.entries[e].u_px);
    ASSERT_EQ(a.entries[e].v_px, b.entries[e].v_px);
    ASSERT_EQ(a.entries[e].weight, b.entries[e].weight);
  }
}

TEST(InterReflection, OffOrWithoutBouncesItLeavesNoTrace) {
  const Scene plain = groove(90), none = reflecting(plain, 0, 16);
  Scene off = reflecting(plain, 3, 16);
  off.effects.inter_reflection = false;
  const LightRows direct = Ready(plain).rows();
  for (const Scene* scene : std::initializer_list<const Scene*>{&none, &off}) {
    EXPECT_TRUE(rows_are_direct(*scene, 0));
    expect_same_rows(Ready(*scene).rows(), direct);
  }
  EXPECT_FALSE(rows_are_direct(reflecting(plain, 1, 1), 0));
}

// A floor that the camera sees, and beside it a wall that alone is lit.
Scene floor_and_wall() {
  Scene scene =
      scene_of({object_of(plane(2, 2)), object_of(plane(2, 2))},
               device_at({0, 0, 3}, {0, 0, 0}, {32, 24}, 40), device_at({-3, 0, 1}, {1, 0, 1}, {32, 32}, 64));
  scene.objects[1].world_from_object = glm::dmat4({0, 1, 0, 0}, {0, 0, 1, 0}, {-1, 0, 0, 0}, {1, 0, 1, 1});
  return scene;
}

double sum_of_weights(const LightRows& rows) {
  return std::accumulate(rows.entries.begin(), rows.entries.end(), 0.0,
                         [](double sum, const LightEntry& e) { return sum + e.weight; });
}

double reflected(const Scene& scene) {
  return sum_of_weights(Ready(reflecting(scene, 1, 32)).rows()) - sum_of_weights(Ready(scene).rows());
}

TEST(InterReflection, WhatIsMetHasItsAlbedoMapItsSolidAlbedoAndABlackBack) {
  const Scene plain = floor_and_wall();
  const double white = reflected(plain);
  ASSERT_GT(white, 1);
  Scene mapped = plain, solid = plain, back = plain;
  mapped.objects[1].albedo_map = std::make_shared<const Image<float>>(Image<float>(1, 1, 0.5f));
  // The wall's own coordinates lie in one dark cell of the checker.
  Object& wall = solid.objects[1];
  for (glm::dvec3& x : wall.mesh.positions) x.x += 10;
  wall.world_from_object = glm::translate(wall.world_from_object, glm::dvec3(-10, 0, 0));
  wall.effects.solid = {SolidKind::checker, 10, 0.5};
  solid.effects.solid_albedo = true;
  // Halves are exact; what is left is the rounding of sums, and of the moved wall's coordinates.
  EXPECT_NEAR(reflected(mapped), white / 2, 1e-9 * white);
  EXPECT_NEAR(reflected(solid), white / 2, 1e-6 * white);
  flip(back.objects[1].mesh);
  EXPECT_EQ(reflected(back), 0);
  back.effects.back_face = false;
  EXPECT_NEAR(reflected(back), white, 1e-6 * white);  // margins on the other side of the wall
}

TEST(InterReflection, AnIdleProjectorsBlackIsReflectedToo) {
  Scene scene = reflecting(floor_and_wall(), 2, 8);
  scene.projectors.push_back(scene.projectors[0]);
  scene.projectors[1].device.device_from_world =
      device_from_world_looking_at({-2, 0.5, 1.2}, {1, 0, 1}, {0, 0, 1});
  scene.projectors[1].effects.black_level = 0.1;
  scene.effects.black_level = true;
  const Ready ready(scene);
  const LightRows idle = ready.rows(0), playing = ready.rows(1);
  int reached = 0;
  for (std::size_t p = 0; p < idle.region.size(); ++p) {
    double white = 0;
    for (std::uint32_t e = playing.begin[p]; e < playing.begin[p + 1]; ++e)
      white += playing.entries[e].weight;
    EXPECT_NEAR(idle.ambient_cd_per_m2[p], 0.1 * white, 1e-12 * white);  // roundings of the sum
    reached += white > 0;
  }
  EXPECT_GT(reached, 300);
}

TEST(InterReflection, PlayIsLinearAndHasItsTranspose) {
  const Scene scene = reflecting(floor_and_wall(), 2, 16);
  const Ready ready(scene);
  auto engine = testing::generator();
  PatternStack patterns = testing::constant_pattern({32, 32}, 3, 0);  // p, q, 2p + q
  for (std::size_t i = 0; i < patterns.values.size(); i += 3) {
    patterns.values[i] = std::uint8_t(engine() % 64), patterns.values[i + 1] = std::uint8_t(engine() % 128);
    patterns.values[i + 2] = std::uint8_t(2 * patterns.values[i] + patterns.values[i + 1]);
  }
  for (const Lookup lookup : {Lookup::nearest, Lookup::bilinear}) {
    const ImageStack<float> played = play_luminance(ready.image(), lookup, patterns);
    Image<float> camera(32, 24);
    double in_camera = 0, in_projector = 0;
    for (std::size_t p = 0; p < played.picture_size(); ++p) {
      camera.values[p] = float(engine() % 1000);
      const double both = 2.0 * played.picture(0)[p] + played.picture(1)[p];
      EXPECT_NEAR(played.picture(2)[p], both, 1e-5 * both);  // single precision, some 30 entries
      in_camera += double(camera.values[p]) * played.picture(0)[p];
    }
    const Image<double> projector = apply_transpose(ready.image(), lookup, camera, {32, 32});
    for (std::size_t i = 0; i < projector.values.size(); ++i)
      in_projector += projector.values[i] * patterns.values[3 * i] / 255;
    EXPECT_NEAR(in_projector, in_camera, 1e-5 * in_camera);  // likewise
  }
}

TEST(InterReflection, SameBitsForAnyThreadsAndRegions) {
  const Scene scene = reflecting(floor_and_wall(), 2, 6);
  const Ready ready(scene);
  const PatternStack pattern = testing::constant_pattern({32, 32}, 1, 200);
  const int threads = thread_count();
  ImageRows image = ready.image(0, {3, 5});
  const ImageStack<float> first = play_luminance(image, Lookup::nearest, pattern);
  for (const int count : {1, 2, 7}) {
    set_thread_count(count);
    for (const glm::ivec2 region : {glm::ivec2(4, 4), glm::ivec2(12, 8), glm::ivec2(256, 64)}) {
      image.region_px = region;
      EXPECT_EQ(play_luminance(image, Lookup::nearest, pattern).values, first.values);
    }
  }
  set_thread_count(threads);
  EXPECT_NE(play_luminance(ready.image(0, {3, 6}), Lookup::nearest, pattern).values, first.values);
}

TEST(PathNumbers, EachPathHasItsCellOnItsFirstBounce) {
  constexpr int paths = 24;
  const glm::ivec2 grid = cells(paths);
  std::vector<bool> taken(paths, false);
  for (int path = 0; path < paths; ++path) {
    const glm::dvec2 first = path_numbers({7, 1, 2, path, paths, 0}, {30, 40});
    const glm::ivec2 cell(first * glm::dvec2(grid));
    taken[std::size_t(cell.y) * grid.x + cell.x] = true;
    EXPECT_NE(path_numbers({7, 1, 2, path, paths, 1}, {30, 40}),
              path_numbers({7, 1, 2, path, paths, 2}, {30, 40}));
  }
  EXPECT_EQ(std::count(taken.begin(), taken.end(), true), paths);
}

TEST(CosineDirection, HasItsDensityAboutAnyNormal) {
  for (const glm::dvec3& n :
       {glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1), glm::normalize(glm::dvec3(1, -2, 0.5))}) {
    constexpr int side = 100;
    glm::dvec3 sum(0.0);
    for (int i = 0; i < side * side; ++i) {
      const glm::dvec3 d = cosine_direction(n, (glm::dvec2(i % side, i / side) + 0.5) / double(side));
      EXPECT_NEAR(glm::length(d), 1, 1e-14);  // roundings
      sum += d / double(side * side);
    }
    // ∫ cos²θ/π dω = 2/3; 1e-3: the midpoint rule with 100 × 100 points.
    EXPECT_NEAR(glm::length(sum - n * (2.0 / 3)), 0, 1e-3);
  }
}

}  // namespace
}  // namespace laterna
