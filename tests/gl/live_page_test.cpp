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

class LivePage : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!chromium[0]) GTEST_SKIP() << "Chromium was not there when this was configured";
  }
};
INSTANTIATE_TEST_SUITE_P(Scenes, LivePage, ::testing::Values("relief", "house"),
                         [](const auto& each) { return std::string(each.param); });

// The scene as it ships: light, back faces, shadows (of a depth map of 2048²), and its finest columns.
TEST_P(LivePage, ShowsWhatTheCameraSees) {
  const Scene scene = shipped_scene(GetParam());
  const Traced traced(scene);
  const nlohmann::json data = live_json(scene, GetParam());
  std::size_t slide = 0;
  while (data["patterns"].at(slide)["name"] != "column bit 0") ++slide;
  const ScratchFolder folder;
  const BrowserPicture theirs =
      picture_in(page_after(folder, live_page(data), fmt::format("picture={}", 4 + slide)), {1280, 800});
  const auto near = near_shadow_edges(scene, traced.light, glm::dvec2(1920, 1080) / 2048.0);
  const auto at = edges(scene, traced.rays, traced.surface, traced.light, &near);
  const auto ours = our_picture(scene, traced, pattern_picture({scene.patterns, {1920, 1080}}, int(slide)),
                                data["saturation_cd_per_m2"]);
  const Differences found = compare_dn(ours, traced.light, theirs.lit, theirs.dn, at, 2);
  // Acne of the shadow map: seen 6 of 860,000.
  EXPECT_LE(double(found.unexplained()), 1e-5 * double(found.lit));
  EXPECT_LE(found.share(), 3e-3);
  EXPECT_GT(found.lit, 500000u);
  report(fmt::format("{} in Chromium", GetParam()), found, ours, theirs.dn);
}

TEST(LivePageData, IsThatOfInfoAndHoldsTheMesh) {
  const Scene scene = shipped_scene("relief");
  const nlohmann::json data = live_json(scene, "relief");
  EXPECT_EQ(data["meshes"][0]["triangles"].size(), 3 * scene.objects[0].mesh.triangles.size());
  EXPECT_EQ(data["projectors"][0]["texture_from_clip"], data["texture_from_clip"]);
  EXPECT_EQ(data["patterns"].size(), 44u);  // Gray code without white and black
  EXPECT_EQ(live_omissions(scene), "");
}

}  // namespace
}  // namespace laterna::gl
