#include "sim/formats/tree.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;

TEST(Tree, TheSameFromThreeLanguages) {
  const Tree yaml = yaml_tree("%YAML:1.0\n---\na: 1.\nlist: [ 2, \"x y\" ]\n", "y");
  const Tree xml = xml_tree(
      "<?xml version=\"1.0\"?><opencv_storage><a>1.</a><list>2 \"x y\"</list></opencv_storage>", "x");
  EXPECT_EQ(yaml, xml);
  const Place place{&yaml, "y"};
  EXPECT_EQ(place.at("a").number(), 1);
  EXPECT_EQ(place.at("list").at(std::size_t(1)).text(), "x y");
  const Tree json = json_tree("{\"a\": 1}", "j");
  EXPECT_EQ((Place{&json, "j"}).at("a").whole_number(), 1);
}

TEST(Tree, LimitsHold) {
  const auto error = [](const std::string& text) {
    return testing::input_error([&] { any_tree(text, "f"); });
  };
  std::string deep = "%YAML:1.0\n---\n", xml = "<opencv_storage>";
  for (int i = 0; i < 40; ++i) deep += std::string(std::size_t(i), ' ') + "a:\n", xml += "<a>";
  EXPECT_THAT(error(deep + std::string(40, ' ') + "b: 1\n"), HasSubstr("nests deeper than 32"));
  for (int i = 0; i < 40; ++i) xml += "</a>";
  EXPECT_THAT(error(xml + "</opencv_storage>"), HasSubstr("nests deeper than 32"));
  EXPECT_THAT(error("a: &x [1, 2]\nb: *x\n"), HasSubstr("f:2: an alias"));
  EXPECT_THAT(error("a: 1\na: 2\n"), HasSubstr("f:2: a second \"a\""));
  EXPECT_THAT(error("a: [1, 2\n"), HasSubstr("no YAML"));
  EXPECT_THAT(error("<opencv_storage><a></opencv_storage>"), HasSubstr("no XML"));
  EXPECT_THAT(error("<a/>"), HasSubstr("no <opencv_storage>"));
  EXPECT_THAT(error("{\"a\": }"), HasSubstr("f: no JSON"));
  EXPECT_THAT(error("a: \xff"), HasSubstr("UTF-8"));
}

TEST(Tree, BytesFlippedAtRandomAreReadOrRefused) {
  auto random = testing::generator();
  const std::vector<std::string> sound = {
      "%YAML:1.0\n---\na: !!opencv-matrix\n   rows: 1\n   data: [ 1., 2. ]\nb: {c: \"d\", e: [f, ~]}\n- g\n",
      "<?xml version=\"1.0\"?><opencv_storage><a type_id=\"m\"><_>1 "
      "2</_><_>\"x\"</_></a><b>3</b></opencv_storage>",
      "{\"a\": [1, 2.5e3, {\"b\": null}], \"c\": \"d\"}"};
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string text = sound[std::size_t(i) % sound.size()];
    for (int flips = 1 + int(random() % 3); flips > 0; --flips)
      text[random() % text.size()] = char(32 + random() % 95);
    try {
      any_tree(text, "f");
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace laterna
