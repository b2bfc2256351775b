// Row 1: what must be seen of the 1992 demo, in our passes and in a real OpenGL's fixed functions.
#include "apps/lab/classics/core_picture.h"
#include "sim/image_file.h"
#include "sim/scene_file.h"
#include "tests/classics/gl_passes.h"
#include "tests/classics/made.h"
#include "tests/gl/context.h"
#include "tests/gl/fixed_function.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using laterna::testing::classics_folder;
using laterna::testing::made_classic;

double found(const std::string& name) { return figure(made_classic("slide_projector"), name); }

Scene shipped() { return load_scene(classics_folder() / "slide_projector.toml"); }

// Doubles, of coordinates below 1e3 px: 1e-12 each, a thousand times that in all.
constexpr double rounding_px = 1e-9;

TEST(SlideProjector, ObjectLinearEyeLinearAndGivenCoordinatesAreTheSame) {
  EXPECT_LT(found("object-linear to eye-linear, greatest"), rounding_px);
  EXPECT_LT(found("object-linear to given, greatest"), rounding_px);
  EXPECT_LT(found("object-linear to the core's (u, v), greatest"), rounding_px);
  // A pixel on the very edge of a texel may fall to the other side: none of 46,080, or a few.
  EXPECT_LT(found("object-linear and eye-linear: pixels that differ"), 1e-4);
  EXPECT_LT(found("object-linear and given: pixels that differ"), 1e-4);
}

TEST(SlideProjector, FourPassesAreOne) {
  // The core's picture is in single precision.
  EXPECT_LT(found("four passes to one, greatest share of white"), 1e-6);
  // Rounded three times, by half a number each, of which the last pass keeps at most all.
  EXPECT_LT(found("four passes of 8 bits to one, greatest"), 1.5);
  EXPECT_GT(found("four passes of 8 bits to one, greatest"), 0.5);
}

TEST(SlideProjector, LightEndsOutsideTheSlideWhereItIsKilled) {
  EXPECT_GT(found("pixels with light that the kill takes away"), 0.1);
}

TEST(SlideProjector, NearAndFarPlanesAreThoseOfDepth) {
  EXPECT_EQ(found("light planes: pixels where r/q and depth disagree"), 0);
  EXPECT_LT(found("light planes: four passes to one, greatest share of white"), 1e-6);
  const Scene scene =
      load_scene(classics_folder() / "slide_projector.toml", {"projector.near=3.4", "projector.far=4.9"});
  const CoreView view(scene);
  const auto count = [&](Unlit why) {
    return std::ranges::count(view.lights[0].why.values, std::uint8_t(why));
  };
  // Both planes cross what the camera sees: a hundredth of its pixels beyond each.
  EXPECT_GT(count(Unlit::before_near), 460);
  EXPECT_GT(count(Unlit::beyond_far), 460);
}

TEST(SlideProjector, LightOnFacesTurnedAwayGoesWithTheTest) {
  EXPECT_GT(found("light on faces turned away, test off"), 0.005);
  EXPECT_EQ(found("light on faces turned away, test on"), 0);
  EXPECT_LT(found("test off: four passes to the core's `back_face = false`, greatest"), 1e-6);
}

// The same scene by OpenGL's own coordinate generation: one set of fragments, coordinates in floats.
TEST(SlideProjector, OpenGLGeneratesTheSameObjectLinearAndEyeLinear) {
  const gl::Context context(gl::Profile::compatibility);
  const Scene scene = shipped();
  const GLuint places = gl::upload_places({256, 256});
  const Image<glm::vec4> object = gl::draw_fixed(scene, places, gl::Generation::object_planes);
  const CoreView view(scene);
  for (const gl::Generation other : {gl::Generation::eye_planes, gl::Generation::eye_stack}) {
    const Image<glm::vec4> eye = gl::draw_fixed(scene, places, other);
    double apart = 0, from_ours = 0;
    std::size_t compared = 0, edges = 0;
    for (std::size_t p = 0; p < eye.values.size(); ++p) {
      apart = std::max(apart, double(glm::distance(glm::vec2(object.values[p]), glm::vec2(eye.values[p]))));
      const glm::dvec2 ours(view.lights[0].u_px.values[p], view.lights[0].v_px.values[p]);
      if (!view.lights[0].lit(p) || glm::any(glm::lessThan(ours, glm::dvec2(0.0))) ||
          glm::any(glm::greaterThan(ours, glm::dvec2(255.0))))
        continue;
      const double distance = glm::distance(ours, glm::dvec2(glm::vec2(eye.values[p])));
      ++compared, edges += distance > 0.01;
      if (distance <= 0.01) from_ours = std::max(from_ours, distance);
    }
    EXPECT_LT(apart, 0.01);  // texel; floats of 256, divided by a q of some metres
    EXPECT_GT(compared, 20'000u);
    EXPECT_LT(edges, compared / 200);  // silhouettes, where OpenGL sees the neighbour
    std::cout << "OpenGL: apart " << apart << " texel, from ours " << from_ours << ", edges " << edges
              << "\n";
  }
}

TEST(SlideProjector, OpenGLDrawsTheSameFourPasses) {
  const gl::Context context(gl::Profile::compatibility);
  const Scene scene = shipped();
  const Image<float> core = core_picture(CoreView(scene));
  const gl::PassPicture drawn = gl::draw_four_passes(scene, slide_of(scene));
  std::size_t beyond = 0;
  Image<std::uint8_t> map(core.width, core.height);
  for (std::size_t p = 0; p < core.values.size(); ++p) {
    map.values[p] = std::abs(drawn.share.values[p] - core.values[p] / drawn.white) * 255 > 2 ? 255 : 0;
    beyond += map.values[p] != 0;
  }
  std::cout << "OpenGL's four passes: " << beyond << " of " << core.values.size() << " pixels beyond 2 DN\n";
  // 2 DN: four passes of 8 bits. Beyond it only silhouettes and, of the nearest texel, edges within rounding.
  EXPECT_LT(beyond, core.values.size() / 200);
  if (HasFailure()) write_picture(laterna::testing::ScratchFolder() / "beyond.png", map);
}

}  // namespace
}  // namespace laterna
