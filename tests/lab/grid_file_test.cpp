#include "apps/lab/grid_file.h"

#include "apps/lab/noun_json.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using testing::input_error;

std::vector<Grid> parse(const std::string& text) { return parse_grids(text, "g.toml", {"seeds"}); }

const std::string head = "[[grid]]\nname = \"a\"\nkind = \"points\"\n";

TEST(GridFile, AllCombinationsInTheOrderOfTheFile) {
  const auto grids = parse(head + "z = [1, 2]\nseeds = 5\nb = \"word\"\ny = [true, false]\n");
  ASSERT_EQ(grids.size(), 1u);
  EXPECT_EQ(grids[0].settings["seeds"], 5);
  const auto cells = cells_of(grids[0]);
  ASSERT_EQ(cells.size(), 4u);
  EXPECT_EQ(cells[0].name, "a: z=1 y=true");
  EXPECT_EQ(cells[1].name, "a: z=1 y=false");
  EXPECT_EQ(cells[2].name, "a: z=2 y=true");
  EXPECT_EQ(cells[3].values["b"], "word");
}

TEST(GridFile, ListsOfListsSweepOverLists) {
  const auto cells = cells_of(parse(head + "set = [[\"a=1\"], [\"b=2\", \"c=3\"]]\n")[0]);
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_EQ(cells[1].values["set"].size(), 2u);
}

TEST(GridFile, BadFilesAreNamedWithTheirLine) {
  EXPECT_THAT(input_error([] { parse(""); }), HasSubstr("no [[grid]]"));
  EXPECT_THAT(input_error([] { parse("x = 1\n"); }), HasSubstr("g.toml:1"));
  EXPECT_THAT(input_error([] { parse("[[grid]]\nname = \"a\"\n"); }), HasSubstr("no kind"));
  EXPECT_THAT(input_error([] { parse(head + head); }), HasSubstr("the name is taken"));
  EXPECT_THAT(input_error([] { parse(head + "z = []\n"); }), HasSubstr("g.toml:4: z is an empty list"));
  EXPECT_THAT(input_error([] { parse(head + "z = 2020-01-01\n"); }), HasSubstr("found a table or a date"));
  EXPECT_THAT(input_error([] { parse(head + "z = [\n"); }), HasSubstr("g.toml:"));
  std::string huge = head;
  for (const char* key : {"p", "q", "r", "s", "t", "u"})
    huge += std::string(key) + " = [1,2,3,4,5,6,7,8,9,10]\n";
  EXPECT_THAT(input_error([&] { parse(huge); }), HasSubstr("more than 100000 cells"));
}

struct Noun {
  double number = 1;
  int whole = 2;
  bool flag = false;
  std::string word = "w";
  std::vector<std::string> list{};
};

template <class Visitor>
void describe(Visitor& visit, Noun& n) {
  visit(Field{.key = "number", .low = 0, .high = 10}, n.number);
  visit(Field{.key = "whole", .low = 0, .high = 10}, n.whole);
  visit(Field{.key = "flag"}, n.flag);
  visit(Field{.key = "word"}, n.word);
  visit(Field{.key = "list"}, n.list);
}

TEST(NounJson, FieldsAreReadAndTheOthersStay) {
  const auto n = noun_from_json<Noun>({{"number", 3}, {"flag", true}, {"list", {"a", "b"}}}, "here");
  EXPECT_EQ(n.number, 3);
  EXPECT_EQ(n.whole, 2);
  EXPECT_TRUE(n.flag);
  EXPECT_EQ(n.word, "w");
  EXPECT_EQ(n.list.size(), 2u);
  EXPECT_EQ(noun_from_json<Noun>({{"list", "a"}}, "here").list.size(), 1u);
}

TEST(NounJson, BadValuesAreNamed) {
  const auto says = [](const nlohmann::json& json) {
    return input_error([&] { noun_from_json<Noun>(json, "here"); });
  };
  EXPECT_THAT(says({{"numbr", 3}}), HasSubstr("here: unknown key \"numbr\", did you mean \"number\"?"));
  EXPECT_THAT(says({{"number", 11}}), HasSubstr("number is 11, expected a number, 0 to 10"));
  EXPECT_THAT(says({{"whole", 1.5}}), HasSubstr("whole is 1.5"));
  EXPECT_THAT(says({{"flag", 1}}), HasSubstr("true or false"));
  EXPECT_THAT(says({{"list", {1, 2}}}), HasSubstr("list of strings"));
}

}  // namespace
}  // namespace laterna
