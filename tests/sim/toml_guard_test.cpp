#include "sim/toml_guard.h"

#include "tests/sim/scene_text.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::AllOf;
using testing::error_of;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using testing::with_mesh;

TEST(TomlGuard, BytesThatNoParserShouldSee) {
  EXPECT_THAT(error_of(std::string("ambient_lx = 1\nname = \"a\0b\"", 27)),
              AllOf(StartsWith("scene.toml:2: "), HasSubstr("0x00")));
  EXPECT_THAT(error_of("name = \"\xff\"\n"), AllOf(StartsWith("scene.toml:1: "), HasSubstr("UTF-8")));
  EXPECT_THAT(error_of("name = \"\xc0\xaf\"\n"), HasSubstr("UTF-8"));  // overlong
  for (const char* deep : {"[", "{a=", "[{a="}) {
    std::string text = "\nmesh = ";
    for (int i = 0; i < 100000; ++i) text += deep;
    EXPECT_THAT(error_of(text), AllOf(StartsWith("scene.toml:2: "), HasSubstr("nest deeper than 64")));
  }
  std::string dotted = "a";
  for (int i = 0; i < 100000; ++i) dotted += ".a";
  for (const std::string& text : {dotted + " = 1\n", "[" + dotted + "]\n", "a = { " + dotted + " = 1 }\n"})
    EXPECT_THAT(error_of(text), HasSubstr("nest deeper than 64"));
  EXPECT_THAT(error_of(std::string(17 << 20, ' ')), HasSubstr("expected at most"));
}

TEST(TomlGuard, BracketsAndDotsInTextAreOnlyText) {
  const std::string many = std::string(200, '[') + std::string(200, '.');
  const std::string text = "# " + many + "\nname = \"" + many + "\" # " + many + "\n" +
                           with_mesh("name = '''" + many.substr(170, 60) + "'''\n");
  EXPECT_EQ(parse_scene(text, "s").name, many);
}

}  // namespace
}  // namespace laterna
