#include "render/transpose.h"

#include "render/replay.h"
#include "tests/render/sampled.h"
#include "tests/testing.h"

#include <random>

namespace laterna {
namespace {

using testing::random_pattern;
using testing::Sampled;

TEST(ApplyTranspose, AgreesInInnerProducts) {
  const Sampled sampled;
  const PatternStack p = random_pattern({60, 40}, 1);
  auto random = testing::generator();
  Image<float> y(130, 90);
  for (float& value : y.values) value = std::uniform_real_distribution<float>(0, 1)(random);
  for (const Lookup lookup : {Lookup::nearest, Lookup::bilinear}) {
    const auto picture = play_luminance(sampled.image(3), lookup, p);
    const Image<double> back = apply_transpose(sampled.image(3), lookup, y, {60, 40});
    double forward = 0, backward = 0;
    for (std::size_t i = 0; i < y.values.size(); ++i) forward += double(y.values[i]) * picture.values[i];
    for (std::size_t i = 0; i < back.values.size(); ++i) backward += back.values[i] * p.values[i] / 255;
    EXPECT_GT(forward, 100);
    EXPECT_NEAR(backward / forward, 1, 1e-6);  // pictures are in single precision
  }
}

}  // namespace
}  // namespace laterna
