// The live page in headless Chromium, whose WebGL2 is yet another rasteriser (SwiftShader).
#include "apps/lab/live_page.h"

#include "sim/safe_write.h"
#include "tests/gl/shadow_edges.h"
#include "tests/gl/shipped.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <fstream>

namespace laterna::gl {
namespace {

using laterna::testing::ScratchFolder;
using laterna::testing::Traced;

constexpr char chromium[] = LATERNA_CHROMIUM;

// The page as it stands after its script has run.
std::string page_after(const ScratchFolder& folder, const std::string& page, const std::string& fragment) {
  write_file(folder / "live.html", page);
  const std::string command = fmt::format(
      "{} --headless=new --no-sandbox --disable-background-networking --use-angle=swiftshader "
      "--enable-unsafe-swiftshader --ignore-gpu-blocklist --user-data-dir={}/profile --dump-dom 'file://{}/"
      "live.html#{}' > {}/dom.html 2> {}/errors.txt",
      chromium, folder.path().string(), folder.path().string(), fragment, folder.path().string(),
      folder.path().string());
  EXPECT_EQ(std::system(command.c_str()), 0);  // NOLINT(cert-env33-c): a test's own words
  std::ifstream file(folder / "dom.html");
  return {std::istreambuf_iterator<char>(file), {}};
}

struct BrowserPicture {
  Image<glm::vec4> lit;  ///< (0, 0, 0, 1) where lit
  Image<std::uint8_t> dn;
};

BrowserPicture picture_in(const std::string& page, glm::ivec2 size) {
  BrowserPicture picture{Image<glm::vec4>(size.x, size.y), Image<std::uint8_t>(size.x, size.y)};
  const std::size_t element = page.find("<pre id=\"picture\""), begin = page.find('>', element) + 1;
  if (element == std::string::npos || page.find('<', begin) - begin != 3 * picture.dn.values.size()) {
    ADD_FAILURE() << "the page holds no picture of " << size.x << " × " << size.y << " pixels";
    return picture;
  }
  for (std::size_t p = 0; p < picture.dn.values.size(); ++p) {
    const std::string digits = page.substr(begin + 3 * p, 3);
    picture.lit.values[p].w = digits[0] == '1';
    picture.dn.values[p] = std::uint8_t(std::stoi(digits.substr(1), nullptr, 16));
  }
  return picture;
}

// 1 at pixels that have, in our picture, a step of more than `dn` or a change between lit and unlit among
// their 3×3 pixels: those within one pixel of any edge.
Image<std::uint8_t> near_steps(const Image<std::uint8_t>& ours, const LightMap& light, int dn) {
  Image<std::uint8_t> near(ours.width, ours.height);
  for (int y = 0; y < ours.height; ++y) {
    for (int x = 0; x < ours.width; ++x) {
      for (int j = std::max(y - 1, 0); j <= std::min(y + 1, ours.height - 1); ++j)
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, ours.width - 1); ++i)
          if (std::abs(ours(i, j) - ours(x, y)) > dn ||
              light.lit(light.why.index(i, j)) != light.lit(light.why.index(x, y)))
            near(x, y) = 1;
    }
  }
  return near;
}

class LivePage : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!chromium[0]) GTEST_SKIP() << "Chromium was not there when this was configured";
  }
  // The page of `shown`, after some keys, beside our picture of `scene`, which has one camera and one
  // projector; the slide has stripes of 16 texels. SwiftShader moves vertices to 1/16 px: much more is near
  // an edge to it than to Mesa.
  Differences compare(const Scene& shown, const Scene& scene, const std::string& keys) const {
    const nlohmann::json data = live_json(shown, GetParam());
    std::size_t slide = 0;
    while (data["projectors"][0]["patterns"].at(slide)["name"] != "column bit 3") ++slide;
    const ScratchFolder folder;
    const std::string page =
        page_after(folder, live_page(data), fmt::format("picture={}&keys={}", 4 + slide, keys));
    const BrowserPicture theirs = picture_in(page, {1280, 800});
    const Traced traced(scene);
    const auto ours = our_picture(scene, traced, pattern_picture({scene.patterns, {1920, 1080}}, int(slide)),
                                  data["cameras"].back()["saturation_cd_per_m2"].back());
    Image<std::uint8_t> near = near_steps(ours, traced.light, 8);
    const auto shadow = near_shadow_edges(scene, traced.light, glm::dvec2(1920, 1080) / 2048.0);
    for (std::size_t p = 0; p < near.values.size(); ++p) near.values[p] |= shadow.values[p];
    const auto at = edges(scene, traced.rays, traced.surface, traced.light, &near, 1.0 / 16);
    Differences found = compare_dn(ours, traced.light, theirs.lit, theirs.dn, at, 2);
    report(fmt::format("{} in Chromium, keys {}", GetParam(), keys), found, ours, theirs.dn);
    return found;
  }
};
INSTANTIATE_TEST_SUITE_P(Scenes, LivePage, ::testing::Values("relief", "house"),
                         [](const auto& each) { return std::string(each.param); });

// The scene as it ships: light, back faces, and shadows, of a depth map of 2048².
TEST_P(LivePage, ShowsWhatTheCameraSees) {
  const Differences found = compare(shipped_scene(GetParam()), shipped_scene(GetParam()), "");
  EXPECT_GT(found.lit, 500000u);
  EXPECT_LE(double(found.unexplained()), 1e-5 * double(found.lit));  // the depth map's acne
  EXPECT_LE(found.share(), 5e-3);  // seen 3.4e-3: a sixteenth of a pixel along every edge of a stripe
}

class LivePageKeys : public LivePage {};
INSTANTIATE_TEST_SUITE_P(Scenes, LivePageKeys, ::testing::Values("house"),
                         [](const auto& each) { return std::string(each.param); });

// Shadow and back faces off, the projector a step ahead, its focal length 5 % longer.
TEST_P(LivePageKeys, MoveOurProjectorToo) {
  Scene scene = shipped_scene(GetParam());
  scene.effects.shadow = scene.effects.back_face = false;
  const glm::dvec3 camera = scene.cameras[0].device.device_from_world.translation;
  Device& projector = scene.projectors[0].device;
  projector.device_from_world.translation.z -= 0.01 * glm::length(camera);
  projector.intrinsics.fx *= 1.05, projector.intrinsics.fy *= 1.05;
  const Differences found = compare(shipped_scene(GetParam()), scene, "hfw%2B");  // h f w +
  EXPECT_GT(found.lit, 400000u);
  // One pixel: a gap where an edge of a neighbour, not of the triangle seen, ends on another's middle.
  EXPECT_LE(double(found.unexplained()), 1e-5 * double(found.lit));
  EXPECT_LE(found.share(), 5e-3);
}

// The second camera sees the light of the second projector, which stand elsewhere, as if they were alone.
TEST_P(LivePageKeys, ChooseAmongCamerasAndProjectors) {
  Scene alone = shipped_scene(GetParam());
  alone.cameras[0].device.name = "second camera", alone.projectors[0].device.name = "second projector";
  alone.cameras[0].device.device_from_world.translation.x += 0.3;
  alone.projectors[0].device.device_from_world.translation.y += 0.2;
  alone.projectors[0].flux_lm *= 0.8;
  Scene both = shipped_scene(GetParam());
  both.cameras.push_back(alone.cameras[0]), both.projectors.push_back(alone.projectors[0]);
  const Differences found = compare(both, alone, "jk");
  EXPECT_GT(found.lit, 400000u);
  EXPECT_LE(double(found.unexplained()), 1e-5 * double(found.lit));  // as above
  EXPECT_LE(found.share(), 5e-3);
}

TEST(LivePageData, IsThatOfInfoAndHoldsTheMesh) {
  const Scene scene = shipped_scene("relief");
  const nlohmann::json data = live_json(scene, "relief");
  // Base64: four digits for three bytes, 12 bytes for three indices.
  EXPECT_EQ(data["meshes"][0]["triangles"].get<std::string>().size(),
            16 * scene.objects[0].mesh.triangles.size());
  EXPECT_EQ(data["projectors"][0]["texture_from_clip"], data["texture_from_clip"]);
  EXPECT_EQ(data["projectors"][0]["patterns"].size(), 44u);  // Gray code without white and black
  EXPECT_EQ(live_omissions(scene), "");
}

}  // namespace
}  // namespace laterna::gl
