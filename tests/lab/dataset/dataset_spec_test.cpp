#include "apps/lab/dataset/dataset_spec.h"

#include "apps/lab/dataset/drawn_scene.h"
#include "tests/lab/dataset/specs.h"

#include <gmock/gmock.h>

#include <set>

namespace laterna {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::input_error;
using testing::ScratchFolder;
using ::testing::StartsWith;

std::string error_of(const std::string& text) {
  return input_error([&] { parse_dataset_spec(text, "s.toml"); });
}

std::string random_error(const std::string& line) {
  return error_of("scene = \"a.toml\"\n[random]\n" + line + "\n");
}

TEST(DatasetSpec, ReadsWhatItSays) {
  const DatasetSpec spec = parse_dataset_spec(testing::tiny_spec, "s.toml");
  EXPECT_EQ(spec.settings.name, "tiny");
  EXPECT_EQ(spec.settings.tar_samples, 2);
  EXPECT_EQ(spec.reject.least_lit, 0.2);
  ASSERT_EQ(spec.present.size(), 1u);
  EXPECT_EQ(spec.present[0].mesh, 1);
  ASSERT_EQ(spec.random.size(), 7u);
  EXPECT_EQ(spec.random[0].path, "camera.fov_x_deg");
  EXPECT_EQ(spec.random[6].path, "patterns.kind");
  EXPECT_EQ(spec.random[0].place, "s.toml:13: random \"camera.fov_x_deg\"");
}

TEST(DatasetSpec, BadSpecificationsAreOneSentence) {
  EXPECT_THAT(error_of("name = 3\nscene = \"a\""), AllOf(HasSubstr("s.toml"), HasSubstr("name is 3")));
  EXPECT_THAT(error_of("name = \"x\""), HasSubstr("no scene"));
  EXPECT_THAT(error_of("scene = \"a\"\nname = \"../x\""), HasSubstr("name"));
  EXPECT_THAT(error_of("scen = \"a\""), HasSubstr("did you mean \"scene\""));
  EXPECT_THAT(error_of("scene = "), StartsWith("s.toml:1: "));
  EXPECT_THAT(error_of("random = 3\nscene = \"a\""), HasSubstr("expected [random]"));
  EXPECT_THAT(error_of("scene = \"a\"\n[reject]\nleast_lit = 2"), HasSubstr("0 to 1"));
  EXPECT_THAT(error_of("scene = \"a\"\n[present]\n\"mesh.1\" = 2"), HasSubstr("s.toml:3: "));
  EXPECT_THAT(error_of("scene = \"a\"\n[present]\n\"camera.1\" = 0.5"), HasSubstr("mesh.INDEX"));
}

TEST(DatasetSpec, BadDistributionsAreOneSentence) {
  EXPECT_THAT(random_error("x = { uniform = [2, 1] }"),
              StartsWith("s.toml:3: random \"x\": uniform is [2,1]"));
  EXPECT_THAT(random_error("x = { uniform = [[1, 2], [3]] }"), HasSubstr("expected [low, high]"));
  EXPECT_THAT(random_error("x = { uniform = [-1e308, 1e308] }"), HasSubstr("expected [low, high]"));
  EXPECT_THAT(random_error("x = { log_uniform = [0, 1] }"), HasSubstr("above 0"));
  EXPECT_THAT(random_error("x = { normal = [0, 1, 8, 9] }"), HasSubstr("some of the bell"));
  EXPECT_THAT(random_error("x = { whole = [1, 2.5] }"), HasSubstr("whole numbers"));
  EXPECT_THAT(random_error("x = { whole = [-9223372036854775807, 9223372036854775807] }"),
              HasSubstr("whole numbers"));
  EXPECT_THAT(random_error("x = { choice = [] }"), HasSubstr("a list"));
  EXPECT_THAT(random_error("x = { orbit = { around = [0, 0, 0] } }"), HasSubstr("elevation_deg"));
  EXPECT_THAT(random_error("x = { uniforn = [1, 2] }"), HasSubstr("expected one of uniform"));
  EXPECT_THAT(random_error("x = 3"), HasSubstr("expected one of uniform"));
  EXPECT_THAT(random_error("x = { uniform = [nan, 1] }"), HasSubstr("not finite"));
  EXPECT_THAT(random_error("x = { choice = [{ y = { uniform = [2, 1] } }] }"), HasSubstr("uniform is [2,1]"));
}

TEST(DatasetSpec, OneKeyUnderTwoNames) {
  const auto error = [](const std::string& text) {
    return testing::input_error([&] { parse_dataset_spec("scene = \"s.toml\"\n" + text, "d.toml"); });
  };
  EXPECT_EQ(error("[random]\n\"camera.fx\" = { uniform = [1, 2] }\n\"camera.0.fx\" = { uniform = [3, 4] }\n"),
            "d.toml:4: random \"camera.0.fx\": is the same key as \"camera.fx\"");
  EXPECT_THAT(error("[present]\n\"mesh.1\" = 0.5\n\"mesh.01\" = 0.2\n"),
              HasSubstr("says again what becomes of mesh 1"));
  EXPECT_NO_THROW(
      parse_dataset_spec("scene = \"s.toml\"\n[random]\n\"mesh.0.albedo\" = { uniform = [0.1, 0.2] "
                         "}\n\"mesh.1.albedo\" = { uniform = [0.1, 0.2] }\n",
                         "d.toml"));
}

TEST(DatasetSpec, TheSceneIsAskedAboutTheEndsBeforeAnythingIsMade) {
  const ScratchFolder scratch;
  testing::write_tiny_spec(scratch.path());
  const auto error_at = [&](const std::string& line) {
    const auto path = testing::write_text(scratch / "other.toml", testing::tiny_spec + line + "\n");
    return input_error([&] { check_ends(read_dataset_spec(path), 1); });
  };
  EXPECT_THAT(error_at("\"camera.fov_deg\" = { uniform = [1, 2] }"),
              AllOf(HasSubstr("other.toml:24: random"), HasSubstr("did you mean")));
  EXPECT_THAT(error_at("\"mesh.0.albedo\" = { uniform = [0.5, 1.5] }"), HasSubstr("0 to 1"));
  EXPECT_THAT(error_at("\"mesh.7.albedo\" = { uniform = [0.5, 0.6] }"), HasSubstr("mesh has 2 entries"));
  EXPECT_THAT(error_at("\"mesh.0\" = { choice = [{ shape = \"plane\" }, { shape = \"cone\" }] }"),
              HasSubstr("cone"));
  EXPECT_THAT(error_at("\"mesh.0.albedo_map\" = { choice = [\"\", \"none.png\"] }"), HasSubstr("none.png"));
  EXPECT_NO_THROW(check_ends(read_dataset_spec(scratch / "spec.toml"), 1));
}

TEST(DatasetSpec, TheSceneIsAskedAboutFormatAndAbsentMeshes) {
  const ScratchFolder scratch;
  testing::write_tiny_spec(scratch.path());
  const auto check = [&](const std::string& line, const std::string& instead, const std::string& last = {}) {
    std::string text = testing::tiny_spec + last;
    text.replace(text.find(line), line.size(), instead);
    check_ends(read_dataset_spec(testing::write_text(scratch / "other.toml", text)), 1);
  };
  EXPECT_THAT(input_error([&] { check("tar_samples = 2", "format = \"bmp\""); }),
              StartsWith("format: found \"bmp\", expected png"));
  const std::string pgm = "format = \"pgm\"", deep = "\"camera.sensor.bit_depth\" = { choice = [8, 10] }\n";
  EXPECT_NO_THROW(check("tar_samples = 2", pgm));
  EXPECT_THAT(input_error([&] { check("tar_samples = 2", pgm, deep); }),
              AllOf(HasSubstr("other.toml:24: random"), HasSubstr("pgm holds 8 bits")));
  EXPECT_THAT(input_error([&] { check("\"mesh.1\" = 0.8", "\"mesh.2\" = 0.8"); }),
              HasSubstr("present \"mesh.2\": the scene has 2 meshes"));
}

TEST(DatasetSpec, DrawsLieInTheirDistributionsAndDependOnTheSampleAlone) {
  const DatasetSpec spec = parse_dataset_spec(testing::tiny_spec, "s.toml");
  EXPECT_EQ(draw_values(spec, 1, 5, 0), draw_values(spec, 1, 5, 0));
  EXPECT_NE(draw_values(spec, 1, 5, 0), draw_values(spec, 1, 5, 1));
  EXPECT_NE(draw_values(spec, 1, 5, 0), draw_values(spec, 2, 5, 0));
  std::set<std::string> kinds, shapes;
  int absent = 0;
  for (std::uint64_t k = 0; k < 200; ++k) {
    const DrawnValues drawn = draw_values(spec, 1, k, 0);
    absent += !drawn.absent.empty();
    for (const auto& [path, value] : drawn.values) {
      const auto expect_between = [&path = path, &value = value](const char* key, double low, double high) {
        EXPECT_TRUE(path != key || (value >= low && value <= high)) << path << " " << value;
      };
      expect_between("camera.fov_x_deg", 30, 60);
      expect_between("projector.flux_lm", 50, 150);
      expect_between("mesh.1.detail", 4, 8);
      expect_between("mesh.1.scale", 0.5, 1);
      EXPECT_TRUE(path != "mesh.1.detail" || value.is_number_integer());
      if (path == "patterns.kind") kinds.insert(value);
      if (path == "mesh.1.shape") shapes.insert(value);
    }
  }
  EXPECT_EQ(kinds, (std::set<std::string>{"gray", "xor_gray"}));
  EXPECT_EQ(shapes, (std::set<std::string>{"box", "sphere"}));
  EXPECT_NEAR(absent, 40, 4 * 5.66);  // four standard deviations of 200 draws at 0.2
}

// One more random key leaves what the others draw.
TEST(DatasetSpec, AKeyDrawsTheSameWhateverElseIsRandom) {
  const DatasetSpec one = parse_dataset_spec("scene = \"a\"\n[random]\nx = { uniform = [0, 1] }\n", "s"),
                    two = parse_dataset_spec(
                        "scene = \"a\"\n[random]\nw = { uniform = [0, 1] }\nx = { uniform = [0, 1] }\n", "s");
  EXPECT_EQ(draw_values(one, 1, 0, 0).values[0], draw_values(two, 1, 0, 0).values[1]);
}

}  // namespace
}  // namespace laterna
