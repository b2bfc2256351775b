#include "render/effects/veiling_glare.h"

#include "render/effects/response.h"
#include "tests/render/rig.h"
#include "tests/testing.h"

namespace laterna {
namespace {

TEST(VeilingGlare, AHalfLitPictureLightsItsDarkHalf) {
  PatternStack stack = testing::constant_pattern({10, 4}, 3, 0);
  for (std::size_t i = 0; i < stack.values.size(); i += 3) {
    stack.values[i] = (i / 3) % 10 < 5 ? 255 : 0;  // half white
    stack.values[i + 1] = 255;                     // white
  }
  apply_veiling_glare(stack, {.veiling_glare = 0.04});
  const auto light = [&](int value, int k) { return stack.light_of_value[value] + stack.added_light[k]; };
  // Floats, a few roundings: 1e-6.
  EXPECT_NEAR(light(0, 0), 0.02, 1e-6);
  EXPECT_NEAR(light(255, 0), 0.98, 1e-6);
  EXPECT_NEAR(light(255, 1), 1, 1e-6);
  EXPECT_EQ(light(0, 2), 0);
}

TEST(VeilingGlare, KeepsEachPicturesFluxAfterTheResponse) {
  auto random = testing::generator();
  PatternStack stack = testing::constant_pattern({30, 20}, 5, 0);
  for (auto& value : stack.values) value = std::uint8_t(random());
  apply_response(stack, {.response_exponent = 2.2});
  const std::vector<double> before = mean_light(stack);
  apply_veiling_glare(stack, {.veiling_glare = 0.1});
  const std::vector<double> after = mean_light(stack);
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(after[k], before[k], 1e-6);  // floats
}

}  // namespace
}  // namespace laterna
