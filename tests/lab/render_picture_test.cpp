#include "apps/lab/render_picture.h"

#include "sim/image_file.h"
#include "tests/render/rig.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numeric>

namespace laterna {
namespace {

using testing::device_at;
using testing::object_of;
using testing::scene_of;

// A plane at z = 0 before a camera and a projector, each a hand's breadth from the middle.
Scene plane_scene() {
  Scene scene = scene_of({object_of(plane(4, 4))}, device_at({0.1, 0, 2}, {0.1, 0, 0}, {60, 40}, 80),
                         device_at({0, 0.1, 2}, {0, 0.1, 0}, {30, 20}, 25));
  scene.cameras[0].device.name = "eye";
  return scene;
}

Image<float> render(const Scene& scene, RenderOptions options, const testing::ScratchFolder& folder) {
  StageTimes times;
  render_picture(scene, options, folder / "out.exr", times);
  return read_grey_float(folder / "out.exr", Encoding::linear);
}

TEST(RenderPicture, ThePhotographOfWhiteIsTheFacingPlanesLuminance) {
  const testing::ScratchFolder folder;
  const Image<float> photo = render(plane_scene(), {}, folder);
  ASSERT_EQ(photo.width, 60);
  // E = Φ·fx·fy/z² on a facing plane, L = albedo/π·E.
  const double expected = 0.8 / std::numbers::pi * (1000.0 / (30 * 20)) * 25 * 25 / 4;
  for (const float value : photo.values) EXPECT_NEAR(value, expected, 1e-6 * expected);  // single precision
}

TEST(RenderPicture, TheDualIsTheTransposeOfThePhotograph) {
  // With white from both sides the two pictures hold the same sum: 1ᵀ·(A·1) = (Aᵀ·1)ᵀ·1.
  const testing::ScratchFolder folder;
  RenderOptions options;
  options.samples_per_pixel = 16;
  const Image<float> photo = render(plane_scene(), options, folder);
  options.kind = RenderKind::dual;
  const Image<float> dual = render(plane_scene(), options, folder);
  ASSERT_EQ(dual.width, 30);
  ASSERT_EQ(dual.height, 20);
  const auto sum = [](const Image<float>& i) {
    return std::accumulate(i.values.begin(), i.values.end(), 0.0);
  };
  EXPECT_NEAR(sum(dual), sum(photo), 1e-6 * sum(photo));  // pictures in single precision
}

TEST(RenderPicture, ABakedPhotographSeenThroughTheMeshesTextureIsThePhotograph) {
  // The bake, as the plane's albedo map under even light, is the photograph again.
  const testing::ScratchFolder folder;
  Scene scene = plane_scene();
  scene.objects[0].mesh = plane(1.2, 0.8);
  scene.cameras[0].device.device_from_world = device_from_world_looking_at({0, 0, 2}, {0, 0, 0}, {0, 1, 0});
  Image<float> photograph(60, 40);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 60; ++x) photograph(x, y) = 0.5f + 0.3f * std::sin(0.2f * float(x) + 0.1f * float(y));
  write_picture(folder / "photo.exr", photograph);
  RenderOptions options;
  options.kind = RenderKind::bake;
  options.show = folder / "photo.exr";
  options.texture_px = 256;
  StageTimes times;
  render_picture(scene, options, folder / "bake.exr", times);
  const ExrLayers baked = read_exr_layers(folder / "bake.exr");
  const auto y = std::find(baked.names.begin(), baked.names.end(), "Y") - baked.names.begin();
  scene.objects[0].albedo = 1;
  scene.objects[0].albedo_map = std::make_shared<const Image<float>>(baked.planes[y]);
  scene.projectors[0].flux_lm = 1e-9;
  scene.ambient_lx = std::numbers::pi;  // L = albedo
  const Image<float> again = render(scene, {}, folder);
  double largest = 0;
  int compared = 0;
  for (int j = 12; j < 28; ++j)  // the plane spans the middle 48 × 32 pixels
    for (int i = 12; i < 48; ++i, ++compared)
      largest = std::max(largest, std::abs(double(again(i, j)) - double(photograph(i, j))));
  EXPECT_GT(compared, 500);
  // Bilinear in a texture 5 times as fine as the picture: the kinks of the picture's own bilinear surface at
  // pixel centres are cut by at most a tenth of a pixel's second difference, 0.3·0.05/8.
  EXPECT_LT(largest, 2e-3);
}

TEST(RenderPicture, RefusesWhatTheSceneDoesNotHave) {
  const testing::ScratchFolder folder;
  StageTimes times;
  RenderOptions options;
  options.camera = "ear";
  const auto error = [&] {
    return testing::input_error([&] { render_picture(plane_scene(), options, folder / "x.png", times); });
  };
  EXPECT_EQ(error(), "--camera: found \"ear\", expected one of \"eye\"");
  options.camera.clear();
  write_picture(folder / "small.png", Image<std::uint8_t>(3, 2, 9));
  options.show = folder / "small.png";
  EXPECT_THAT(error(), ::testing::HasSubstr("small.png"));
  EXPECT_EQ(testing::input_error([] { render_kind_of("bog"); }),
            "--as: found \"bog\", expected photo, dual or bake");
}

}  // namespace
}  // namespace laterna
