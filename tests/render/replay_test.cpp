// Captured pictures beside closed forms that share nothing with the code under test but the scene.
#include "render/replay.h"

#include "render/transpose.h"
#include "sim/parallel.h"
#include "tests/render/rig.h"
#include "tests/render/sampled.h"
#include "tests/testing.h"

#include <algorithm>
#include <numbers>
#include <random>
#include <tuple>

namespace laterna {
namespace {

using testing::constant_pattern;
using testing::device_at;
using testing::object_of;
using testing::random_pattern;
using testing::Sampled;
using testing::scene_of;
using testing::Traced;

CapturedStack capture(const Scene& scene, const PatternStack& patterns, const Exposure& exposure) {
  const Traced traced(scene);
  return capture_stack(traced.surface, traced.light, scene.projectors[0], patterns, scene.ambient_lx,
                       exposure);
}

// A pinhole that looks from a place to another with y up, from scratch.
struct Plain {
  glm::dvec3 position, forward, right, down;
  glm::dvec2 size;
  double focal;

  Plain(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec2& pixels, double focal_px)
      : position(from), size(pixels), focal(focal_px) {
    forward = (to - from) / glm::length(to - from);
    const glm::dvec3 side(-forward.z, 0, forward.x);
    right = side / glm::length(side);
    down = glm::cross(forward, right);
  }
  glm::dvec3 ray(double x, double y) const {
    return forward + (x - (size.x - 1) / 2) / focal * right + (y - (size.y - 1) / 2) / focal * down;
  }
  glm::dvec2 pixel(const glm::dvec3& x_world) const {
    const glm::dvec3 d = x_world - position;
    return (size - 1.0) / 2.0 +
           focal / glm::dot(d, forward) * glm::dvec2(glm::dot(d, right), glm::dot(d, down));
  }
  // 1000 lm: E = Φ·f²·cos(θ_i)/(z²·cos θ).
  double illuminance(const glm::dvec3& x_world, const glm::dvec3& normal) const {
    const glm::dvec3 d = x_world - position;
    const double z = glm::dot(d, forward), distance = glm::length(d);
    const double cos_incidence = -glm::dot(d, normal) / distance, cos_axis = z / distance;
    return 1000 / (size.x * size.y) * focal * focal * cos_incidence / (z * z * cos_axis);
  }
};

struct ClosedForm {
  double dn;
  bool near_edge;  // of a texel's box, or of the picture
};

ClosedForm nearest_by_hand(const PatternStack& patterns, int k, const glm::dvec2& uv, double dark,
                           double white) {
  const glm::dvec2 cell = glm::floor(uv + 0.5), from_centre = glm::abs(uv - cell);
  const bool near_edge = std::max(from_centre.x, from_centre.y) > 0.5 - 1e-6;
  const bool inside = cell.x >= 0 && cell.y >= 0 && cell.x < patterns.width && cell.y < patterns.height;
  const double value = inside ? patterns.texel(int(cell.x), int(cell.y))[k] / 255.0 : 0;
  return {dark + white * value, near_edge};
}

TEST(CaptureStack, PlanesEqualTheirClosedForm) {
  const Plain camera({0.4, 0.3, 2.5}, {0.1, 0, 0}, {200, 150}, 220),
      projector({-0.5, 0.2, 2}, {0, 0, 0}, {64, 48}, 60);
  const PatternStack patterns = random_pattern({64, 48}, 5);
  for (const double tilt : {0.0, 0.6}) {
    for (const int bits : {8, 12}) {
      Object object = object_of(plane(5, 5, 3, 3));
      object.world_from_object = glm::rotate(object.world_from_object, tilt, glm::dvec3(0, 1, 0));
      const glm::dvec3 normal(std::sin(tilt), 0, std::cos(tilt));
      Scene scene = scene_of({object}, device_at({0.4, 0.3, 2.5}, {0.1, 0, 0}, {200, 150}, 220),
                             device_at({-0.5, 0.2, 2}, {0, 0, 0}, {64, 48}, 60));
      scene.ambient_lx = 20;
      const Exposure exposure{bits, 100, 0, {}};
      const CapturedStack stack = capture(scene, patterns, exposure);
      int compared = 0;
      for (int p = 0; p < 200 * 150; ++p) {
        const glm::dvec3 ray = camera.ray(p % 200, p / 200);
        const glm::dvec3 x =
            camera.position - glm::dot(camera.position, normal) / glm::dot(ray, normal) * ray;
        const double scale = ((1 << bits) - 1) / 100.0 * 0.8 / std::numbers::pi;
        for (int k = 0; k < 5; ++k) {
          const ClosedForm expected = nearest_by_hand(patterns, k, projector.pixel(x), scale * 20,
                                                      scale * projector.illuminance(x, normal));
          if (expected.near_edge) continue;
          ++compared;
          const double dn = std::visit([&](const auto& s) { return double(s.picture(k)[p]); }, stack);
          // Half a step of rounding, and single precision.
          ASSERT_NEAR(dn, std::min(expected.dn, double((1 << bits) - 1)), 0.501)
              << p % 200 << ", " << p / 200;
        }
      }
      EXPECT_GT(compared, 140000);  // of 150000
    }
  }
}

TEST(CaptureStack, ASphereEqualsItsClosedForm) {
  const Plain camera({0.3, 0.2, 4}, {0, 0, 0}, {160, 160}, 300),
      projector({-1.5, 0.5, 4}, {0, 0, 0}, {100, 100}, 180);
  const Scene scene =
      scene_of({object_of(sphere(1, 240))}, device_at({0.3, 0.2, 4}, {0, 0, 0}, {160, 160}, 300),
               device_at({-1.5, 0.5, 4}, {0, 0, 0}, {100, 100}, 180));
  const double saturation = 250;
  const auto stack = std::get<ImageStack<std::uint8_t>>(
      capture(scene, constant_pattern({100, 100}, 1, 255), {8, saturation, 0, {}}));
  int compared = 0, brightest = 0;
  for (int p = 0; p < 160 * 160; ++p) {
    const glm::dvec3 ray = glm::normalize(camera.ray(p % 160, p / 160));
    const double b = glm::dot(camera.position, ray),
                 root = b * b - glm::dot(camera.position, camera.position) + 1;
    if (root < 0.003) continue;  // the silhouette: rays within 3° of grazing
    const glm::dvec3 x = camera.position + (-b - std::sqrt(root)) * ray;
    const double facing = glm::dot(x, glm::normalize(projector.position - x));
    if (std::abs(facing) < 0.02) continue;  // where the light begins
    const double expected =
        facing > 0 ? 255 / saturation * 0.8 / std::numbers::pi * projector.illuminance(x, x) : 0;
    ++compared;
    brightest = std::max<int>(brightest, stack.values[p]);
    // Rounding, 0.5; and 241 bands of flat triangles, whose normals are up to 0.5° off: 0.009·50.
    ASSERT_NEAR(stack.values[p], expected, 1) << p % 160 << ", " << p / 160;
  }
  EXPECT_GT(compared, 15000);
  EXPECT_GT(brightest, 30);
}

TEST(CaptureStack, BilinearEqualsItsClosedFormAndNothingLeaksPastTheEdge) {
  // Facing each other across one plane, 10 camera pixels to one of the projector's.
  const Plain camera({0, 0, 2}, {0, 0, 0}, {120, 80}, 200), projector({0, 0, 2}, {0, 0, 0}, {8, 5}, 20);
  for (const Border border : {Border::black, Border::clamp}) {
    Scene scene = scene_of({object_of(plane(5, 5))}, device_at({0, 0, 2}, {0, 0, 0}, {120, 80}, 200),
                           device_at({0, 0, 2}, {0, 0, 0}, {8, 5}, 20));
    scene.projectors[0].lookup = Lookup::bilinear;
    scene.projectors[0].border = border;
    const PatternStack patterns = random_pattern({8, 5}, 3);
    const double white = 0.8 / std::numbers::pi * projector.illuminance({0, 0, 0}, {0, 0, 1});
    const auto stack = std::get<ImageStack<std::uint16_t>>(capture(scene, patterns, {16, white, 0, {}}));
    int dark = 0;
    for (int p = 0; p < 120 * 80; ++p) {
      const glm::dvec2 uv = projector.pixel(camera.position + 2.0 * camera.ray(p % 120, p / 120));
      if (std::abs(glm::fract(uv.x) - 0.5) < 1e-6 || std::abs(glm::fract(uv.y) - 0.5) < 1e-6) continue;
      const bool inside = uv.x > -0.5 && uv.x < 7.5 && uv.y > -0.5 && uv.y < 4.5;
      const glm::dvec2 c = glm::clamp(uv, glm::dvec2(0, 0), glm::dvec2(7, 4));
      for (int k = 0; k < 3; ++k) {
        double expected = 0;  // tent weights over all texels
        for (int j = 0; j < 5; ++j)
          for (int i = 0; i < 8; ++i)
            expected += std::max(0.0, 1 - std::abs(c.x - i)) * std::max(0.0, 1 - std::abs(c.y - j)) *
                        patterns.texel(i, j)[k];
        if (!inside && border == Border::black) expected = 0;
        ASSERT_NEAR(stack.picture(k)[p], expected / 255 * 65535,
                    0.52);  // rounding, single precision of 65535
      }
      dark += !inside;
    }
    EXPECT_GT(dark, 1000);
  }
}

TEST(CaptureStack, DarkPixelsGetTheAmbientLightAlone) {
  Scene scene = scene_of({object_of(plane(1, 1))}, device_at({0, 0, 2}, {0, 0, 0}, {50, 50}, 75),
                         device_at({0, 0, 2}, {9, 0, 0}, {8, 8}, 20));
  scene.ambient_lx = 10 * std::numbers::pi;
  const auto stack =
      std::get<ImageStack<std::uint8_t>>(capture(scene, constant_pattern({8, 8}, 2, 255), {8, 20.4, 0, {}}));
  EXPECT_EQ(stack.picture(1)[25 * 50 + 25], 100);  // 255·0.8·10/20.4
  EXPECT_EQ(stack.picture(1)[0], 0);               // beside the plane
  scene.cameras[0].device = device_at({0, 0, -2}, {0, 0, 0}, {50, 50}, 75);
  const auto back =
      std::get<ImageStack<std::uint8_t>>(capture(scene, constant_pattern({8, 8}, 2, 255), {8, 20.4, 0, {}}));
  EXPECT_EQ(back.picture(0)[25 * 50 + 25], 0);  // the back side is black
}

TEST(CaptureStack, GrayCodesArriveAsTheyWereSent) {
  const Scene scene =
      scene_of({object_of(relief(2, 2, 0.3, 40, 40))}, device_at({0.3, 0, 3}, {0, 0, 0}, {130, 90}, 150),
               device_at({-0.3, 0, 3}, {0, 0, 0}, {60, 40}, 60));
  const GraySequence sequence{{60, 40}};
  const PatternStack patterns = make_pattern_stack(sequence);
  const Traced traced(scene);
  const double saturation = testing::automatic_saturation(traced);
  const auto stack = std::get<ImageStack<std::uint8_t>>(
      capture_stack(traced.surface, traced.light, scene.projectors[0], patterns, 0, {8, saturation, 0, {}}));
  ASSERT_EQ(stack.count, picture_count(sequence));
  for (int k = 0; k < stack.count; ++k) {
    for (std::size_t p = 0; p < stack.picture_size(); ++p) {
      const bool lit =
          traced.light.lit(p) && gray_bit(sequence, k, nearest_texel(traced.light.u_px.values[p], 60),
                                          nearest_texel(traced.light.v_px.values[p], 40));
      ASSERT_EQ(stack.picture(k)[p] > 20, lit);
    }
  }
}

TEST(CaptureStack, NoiseHasItsSigmaAndTheSameBitsForAnyThreads) {
  Scene scene = scene_of({object_of(plane(9, 9))}, device_at({0, 0, 2}, {0, 0, 0}, {333, 70}, 75),
                         device_at({0, 0, 2}, {0, 0, 0}, {8, 8}, 1));
  scene.ambient_lx = 0;
  const Traced traced(scene);
  const double saturation = traced.light.white_lx.values[0] * 0.8 / std::numbers::pi;
  const PatternStack patterns = constant_pattern({8, 8}, 7, 128);
  const auto play = [&](const NoiseKey& key) {
    return std::get<ImageStack<std::uint16_t>>(capture_stack(
        traced.surface, traced.light, scene.projectors[0], patterns, 0, {12, saturation, 30, key}));
  };
  set_thread_count(1);
  const auto one = play({5, 0, 0});
  for (const int threads : {2, 7}) {
    set_thread_count(threads);
    EXPECT_EQ(play({5, 0, 0}).values, one.values);
  }
  set_thread_count(0);
  double sum = 0, squares = 0;
  const double mean = 4095 * 128.0 / 255, n = double(one.values.size());
  for (const auto dn : one.values) sum += dn - mean, squares += (dn - mean) * (dn - mean);
  EXPECT_NEAR(sum / n, 0, 5 * 30 / std::sqrt(n));  // five standard errors
  EXPECT_NEAR(squares / n, 900 + 1 / 12.0, 5 * 900 * std::sqrt(2 / n));
  EXPECT_NE(play({6, 0, 0}).values, one.values);
  EXPECT_NE(play({5, 1, 0}).values, one.values);
  EXPECT_NE(std::vector(one.picture(0).begin(), one.picture(0).end()),
            std::vector(one.picture(4).begin(), one.picture(4).end()));
}

TEST(PlayLuminance, IsLinearInThePattern) {
  const Sampled sampled;
  PatternStack p = random_pattern({60, 40}, 21), q = random_pattern({60, 40}, 21), sum = p;
  std::reverse(q.values.begin(), q.values.end());
  for (auto& value : p.values) value /= 4;
  for (auto& value : q.values) value /= 2;
  for (std::size_t i = 0; i < sum.values.size(); ++i)
    sum.values[i] = std::uint8_t(2 * p.values[i] + q.values[i]);
  for (const Lookup lookup : {Lookup::nearest, Lookup::bilinear}) {
    const auto a = play_luminance(sampled.image(5), lookup, p),
               b = play_luminance(sampled.image(5), lookup, q),
               c = play_luminance(sampled.image(5), lookup, sum);
    const float most = *std::max_element(c.values.begin(), c.values.end());
    EXPECT_GT(most, 1);
    for (std::size_t i = 0; i < c.values.size(); ++i)
      ASSERT_NEAR(2 * a.values[i] + b.values[i], c.values[i], 1e-6 * most);  // about ten roundings of 2⁻²⁴
  }
}

TEST(PlayStack, HasTheSameBitsForAnyThreadsAndRegions) {
  const Sampled sampled;
  const PatternStack values = random_pattern({60, 40}, 11);
  const BinaryPatternStack bits = make_binary_pattern_stack({{60, 40}});
  const Image<float> ones(130, 90, 1);
  const Exposure exposure{12, 60, 3, {1, 0, 0}};
  const auto play = [&](glm::ivec2 region_px) {
    const ImageRows image = sampled.image(3, region_px);
    return std::tuple(play_stack(image, Lookup::bilinear, values, exposure),
                      play_stack(image, Lookup::nearest, bits, exposure),
                      apply_transpose(sampled.image(3), Lookup::bilinear, ones, {60, 40}).values);
  };
  const auto same = [](const CapturedStack& a, const CapturedStack& b) {
    return std::get<ImageStack<std::uint16_t>>(a).values == std::get<ImageStack<std::uint16_t>>(b).values;
  };
  set_thread_count(1);
  const auto one = play({256, 4});
  for (const int threads : {2, 7}) {
    for (const glm::ivec2 region_px : {glm::ivec2(256, 4), glm::ivec2(12, 8), glm::ivec2(64, 92)}) {
      set_thread_count(threads);
      const auto other = play(region_px);
      EXPECT_TRUE(same(std::get<0>(one), std::get<0>(other)));
      EXPECT_TRUE(same(std::get<1>(one), std::get<1>(other)));
      EXPECT_EQ(std::get<2>(one), std::get<2>(other));
    }
  }
  set_thread_count(0);
}

TEST(PlayStack, BitsAndBytesOfOneSequenceGiveOnePicture) {
  const Sampled sampled;
  const GraySequence sequence{{60, 40}};
  const PatternStack bytes = make_pattern_stack(sequence);
  const BinaryPatternStack bits = make_binary_pattern_stack(sequence);
  for (const int bit_depth : {8, 12}) {
    for (const int samples : {1, 4}) {
      for (const double noise : {0.0, 2.0}) {
        const Exposure exposure{bit_depth, 60, noise, {1, 0, 0}};
        const ImageRows image = sampled.image(samples);
        EXPECT_EQ(std::visit([](const auto& s) { return std::vector<int>(s.values.begin(), s.values.end()); },
                             play_stack(image, Lookup::nearest, bits, exposure)),
                  std::visit([](const auto& s) { return std::vector<int>(s.values.begin(), s.values.end()); },
                             play_stack(image, Lookup::nearest, bytes, exposure)));
      }
    }
  }
  const auto a = play_luminance(sampled.image(2), Lookup::bilinear, bits),
             b = play_luminance(sampled.image(2), Lookup::bilinear, bytes);
  for (std::size_t i = 0; i < a.values.size(); ++i)
    ASSERT_NEAR(a.values[i], b.values[i], 1e-6 * 60);  // rounded in another order
}

TEST(CaptureStack, PatternsMustHaveTheProjectorsSize) {
  const Device device = device_at({0, 0, 2}, {0, 0, 0}, {8, 6}, 5);
  const Scene scene = scene_of({object_of(plane(1, 1))}, device, device);
  EXPECT_EQ(testing::input_error([&] {
              capture(scene, constant_pattern({6, 8}, 1, 0), {});
            }),
            "device: patterns of 6x8 pixels, expected the projector's 8x6");
}

}  // namespace
}  // namespace laterna
