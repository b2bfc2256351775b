#include "render/effects/attenuation.h"

#include "tests/render/effects/lit_scene.h"
#include "tests/testing.h"

namespace laterna {
namespace {

using testing::facing_plane;
using testing::Lit;

TEST(Attenuation, DividesByAPolynomialOfTheDistance) {
  Scene scene = facing_plane();
  scene.effects.irradiance = false;
  const Lit plain(scene);
  scene.effects.attenuation = true;
  scene.projectors[0].effects.attenuation = glm::dvec3(0.5, 0.25, 2);
  const Lit lit(scene);
  for (std::size_t p = 0; p < plain.size(); ++p) {
    const double d = glm::distance(plain.points.values[p], glm::dvec3(0.2, -0.1, 2));
    EXPECT_NEAR(lit.light().white_lx.values[p] * (0.5 + 0.25 * d + 2 * d * d),
                plain.light().white_lx.values[p], 1e-9);  // rounding of 450 lx
  }
}

}  // namespace
}  // namespace laterna
