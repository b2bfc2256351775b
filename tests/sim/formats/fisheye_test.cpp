#include "sim/formats/fisheye.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using Coefficients = std::array<double, 4>;

constexpr double degree = std::numbers::pi / 180;

// A lens as kalibr finds it for a global shutter camera of 752×480 with 4 mm.
constexpr Coefficients usual = {-0.0136, 0.0236, -0.0247, 0.0098};

Device camera(glm::ivec2 size, double f, glm::dvec2 centre_of_size = {0.49, 0.52}) {
  Device device;
  device.name = "cam0";
  device.intrinsics = {size, f, 1.01 * f, centre_of_size.x * size.x, centre_of_size.y * size.y};
  return device;
}

// r = θ + k1·θ³ + k2·θ⁵ + k3·θ⁷ + k4·θ⁹ along the azimuth.
glm::dvec2 pixel_by_formula(const Intrinsics& k, const Coefficients& c, double theta, double azimuth) {
  const double r = theta + c[0] * std::pow(theta, 3) + c[1] * std::pow(theta, 5) + c[2] * std::pow(theta, 7) +
                   c[3] * std::pow(theta, 9);
  return {k.cx + k.fx * r * std::cos(azimuth), k.cy + k.fy * r * std::sin(azimuth)};
}

bool is_inside(const glm::dvec2& pixel, const glm::ivec2& size) {
  return pixel.x >= -0.5 && pixel.y >= -0.5 && pixel.x <= size.x - 0.5 && pixel.y <= size.y - 0.5;
}

struct Difference {
  double largest_px = 0, farthest_theta = 0;
  int directions = 0;
};

// Over the directions, by degrees around the axis and quarters of one from it, that the formula puts inside
// the image.
Difference difference_over_image(const Device& device, const Coefficients& c) {
  const LensProjection projection(device.intrinsics, device.lens);
  Difference found;
  for (int column = 0; column < 360; ++column) {
    const double azimuth = column * degree;
    bool entered = false;
    for (int row = 0; row < 4 * 85; ++row) {
      const double theta = 0.25 * row * degree;
      const glm::dvec2 expected = pixel_by_formula(device.intrinsics, c, theta, azimuth);
      if (!is_inside(expected, device.intrinsics.size)) {
        if (entered) break;  // an outward line leaves the image once
        continue;
      }
      entered = true;
      const auto pixel = projection.project(
          {std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth), std::cos(theta)});
      const double px = pixel ? glm::distance(*pixel, expected) : std::numeric_limits<double>::infinity();
      found.largest_px = std::max(found.largest_px, px);
      found.farthest_theta = std::max(found.farthest_theta, theta);
      ++found.directions;
    }
  }
  return found;
}

double told_px(const std::string& note) { return std::stod(note.substr(note.find("within ") + 7)); }

TEST(Fisheye, FollowsTheFormulaOverTheWholeImage) {
  struct Case {
    const char* name;
    Device device;
    Coefficients k;
    double farthest_deg;  // the image's farthest corner looks further from the axis than this
  };
  for (const Case& c :
       {Case{"usual", camera({752, 480}, 460), usual, 50},
        Case{"equidistant to the digit", camera({752, 480}, 460), {}, 50},
        Case{"wide", camera({752, 480}, 310), usual, 80},
        Case{"bulging", camera({640, 480}, 400), {0.3, 0.1, -0.05, 0.02}, 45},
        Case{"off the axis", camera({640, 480}, 700, {1.2, -0.1}), usual, 75},
        Case{"twelve megapixels", camera({4096, 3072}, 1900), usual, 70},
        Case{"narrow, badly determined", camera({640, 480}, 4000), {2, -90, 800, -2000}, 4}}) {
    SCOPED_TRACE(c.name);
    Device device = c.device;
    Notes notes;
    device.lens = lens_from_fisheye(device, c.k, "camchain.yaml: cam0", notes);
    ASSERT_EQ(notes.size(), 1u);
    const Difference found = difference_over_image(device, c.k);
    EXPECT_GT(found.directions, 1000);
    EXPECT_GT(found.farthest_theta, c.farthest_deg * degree);
    // A quarter more between the pixels that were tried.
    EXPECT_LT(found.largest_px, 0.0025);
    EXPECT_LT(found.largest_px, 1.25 * told_px(notes[0]));
    EXPECT_GT(found.largest_px, 0.5 * told_px(notes[0]));
    EXPECT_TRUE(
        LensProjection(device.intrinsics, device.lens).unproject(glm::dvec2(device.intrinsics.size) - 0.5));
  }
}

TEST(Fisheye, TellsHowFarTheSplineIsOffAndASecondIsTheSameBits) {
  const Device device = camera({752, 480}, 460);
  Notes notes;
  const Lens first = lens_from_fisheye(device, usual, "c.yaml", notes),
             second = lens_from_fisheye(device, usual, "c.yaml", notes);
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_THAT(notes[0],
              HasSubstr("lens of \"cam0\": fisheye fitted by a spline of 24×24 knots within 0.000"));
  EXPECT_EQ(notes[0], notes[1]);
  EXPECT_EQ(first, second);
}

TEST(Fisheye, WhatCannotBeFittedIsOneSentence) {
  const auto error_of = [](const Device& device, const std::vector<double>& k) {
    Notes notes;
    std::string message = testing::input_error([&] { lens_from_fisheye(device, k, "c.yaml: cam0", notes); });
    EXPECT_EQ(notes, Notes{});
    EXPECT_THAT(message, ::testing::StartsWith("c.yaml: cam0: "));
    return message;
  };
  const Device device = camera({752, 480}, 460);
  EXPECT_THAT(error_of(camera({16384, 16384}, 10, {-2.5, 0.5}), {0, 0, 0, 1e4}),
              HasSubstr("no spline of up to 96×96 knots comes within 0.02 px"));
  // A circle of 170° inside the picture, and a θ_d that falls again from θ = 1/√(0.9) = 60° on.
  EXPECT_THAT(error_of(camera({752, 480}, 150), {0, 0, 0, 0}),
              HasSubstr("pixel (-0.5, -0.5) of the fisheye lens has no ray within 85° of the axis"));
  EXPECT_THAT(error_of(camera({752, 480}, 500), {-0.3, 0, 0, 0}), HasSubstr("has no ray within 85°"));
  EXPECT_THAT(error_of(device, {0, 0, 0}), HasSubstr("found 3 coefficients of a fisheye lens, expected 4"));
  EXPECT_THAT(error_of(device, {0, 0, 1.5e4, 0}), HasSubstr("found 15000 as a coefficient"));
  EXPECT_THAT(error_of(device, {0, std::nan(""), 0, 0}), HasSubstr("found nan as a coefficient"));
  EXPECT_THAT(error_of(camera({0, 0}, 460), {0, 0, 0, 0}), HasSubstr("size is 0 × 0"));
  EXPECT_THAT(error_of(camera({752, 480}, 0), {0, 0, 0, 0}), HasSubstr("focal length is 0"));
}

}  // namespace
}  // namespace laterna
