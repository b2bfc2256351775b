#include "apps/lab/capture_writer.h"

#include "sim/scene_build.h"
#include "sim/scene_file.h"
#include "sim/text_file.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <map>

namespace laterna {
namespace {

namespace fs = std::filesystem;

// Two projectors, one camera, exposure left to the sensor.
SceneSpec two_projectors(const std::string& effects, const std::string& camera, const std::string& light) {
  const std::string aim = "look_at = [0, 0, 0]\nup = [0, 1, 0]\n",
                    projector = "[[projector]]\nsize = [32, 24]\nthrow_ratio = 1\n" + aim + light;
  return parse_scene("ambient_lx = 3\n[[mesh]]\nshape = \"relief\"\nshape_size = [2, 2, 0.3]\ndetail = 32\n" +
                         projector + "name = \"a\"\nposition = [0.3, 0, 1.5]\n" + projector +
                         "name = \"b\"\nposition = [-0.3, 0, 1.5]\n[[camera]]\nsize = [50, 38]\n"
                         "fov_x_deg = 50\nposition = [0, 0.2, 1.5]\nsensor = { noise_sigma_dn = 1 }\n" +
                         aim + camera + "[effects]\n" + effects,
                     "s");
}

std::map<std::string, std::string> files_in(const fs::path& root) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(root))
    if (entry.is_regular_file())
      files[entry.path().lexically_relative(root).generic_string()] = read_text(entry.path(), 1 << 24);
  return files;
}

std::vector<std::string> differing(const std::map<std::string, std::string>& a,
                                   const std::map<std::string, std::string>& b) {
  std::vector<std::string> names;
  for (const auto& [name, bytes] : a)
    if (!b.contains(name) || b.at(name) != bytes) names.push_back(name);
  return names;
}

void expect_same_files(const std::string& effects, const std::string& camera = {},
                       const std::string& light = {}) {
  const testing::ScratchFolder scratch;
  const SceneSpec spec = two_projectors(effects, camera, light);
  const Scene scene = build_scene(spec, {});
  const CaptureOptions options{.seed = testing::seed() >> 1,
                               .format = "tif-pages"};  // a file's seed has 63 bits
  StageTimes times;
  for (const char* name : {"rig", "traced"}) fs::create_directory(scratch / name);
  fill_capture(spec, scene, make_rig(scene, times), {}, scratch / "rig", options, times);
  fill_capture(spec, scene, trace(scene, times), {}, scratch / "traced", options, times);
  const auto rig = files_in(scratch / "rig"), traced = files_in(scratch / "traced");
  EXPECT_EQ(rig.size(), 7u) << effects;
  EXPECT_EQ(traced.size(), 7u) << effects;
  EXPECT_THAT(differing(rig, traced), ::testing::IsEmpty()) << effects;
}

TEST(CaptureWriter, TracedViewsGiveTheSameFiles) {
  expect_same_files("");
  expect_same_files("black_level = true\n", {}, "black_level = 0.01\n");
  expect_same_files("antialiasing = true\n", "samples_per_pixel = 4\n");
  expect_same_files("inter_reflection = true\n[inter_reflection]\nbounces = 1\n");
}

}  // namespace
}  // namespace laterna
