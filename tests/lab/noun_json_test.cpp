#include "apps/lab/noun_json.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

namespace laterna {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

enum class Colour { red, green };
inline std::span<const char* const> names_of(Colour) {
  static constexpr const char* names[] = {"red", "green"};
  return names;
}

struct Leaf {
  std::string text;
  double number = 0;
};
template <class Visitor>
void describe(Visitor& visit, Leaf& leaf) {
  visit(Field{"text"}, leaf.text);
  visit(Field{"number"}, leaf.number);
}

struct Branch {
  Leaf leaf;
  std::vector<Leaf> leaves;
  std::optional<Leaf> absent, present = Leaf{"there", 2};
  Colour colour = Colour::green;
  std::vector<double> numbers{1, 2.5};
  glm::ivec2 size{640, 480};
  bool on = true;
  int count = -3;
};
template <class Visitor>
void describe(Visitor& visit, Branch& branch) {
  visit(Field{"leaf"}, branch.leaf);
  visit(Field{"leaves"}, branch.leaves);
  visit(Field{"absent"}, branch.absent);
  visit(Field{"present"}, branch.present);
  visit(Field{"colour"}, branch.colour);
  visit(Field{"numbers"}, branch.numbers);
  visit(Field{"size"}, branch.size);
  visit(Field{"on"}, branch.on);
  visit(Field{"count"}, branch.count);
}

std::string text_json(const std::string& text) { return noun_json(Leaf{text, 0})["text"].dump(); }
std::string number_json(double number) { return noun_json(Leaf{"", number})["number"].dump(); }

TEST(JsonWriter, WritesEveryFieldAndWhatIsInside) {
  Branch branch;
  branch.leaves = {{"a", 1}, {"b", -0.5}};
  EXPECT_EQ(noun_json(branch), json::parse(R"({
    "leaf": {"text": "", "number": 0.0}, "leaves": [{"text": "a", "number": 1.0}, {"text": "b", "number": -0.5}],
    "absent": null, "present": {"text": "there", "number": 2.0}, "colour": "green", "numbers": [1.0, 2.5],
    "size": [640, 480], "on": true, "count": -3})"));
}

TEST(JsonWriter, AnEmptyListIsAList) {
  EXPECT_EQ(noun_json(Branch{})["leaves"].dump(), "[]");
  Branch branch;
  branch.numbers.clear();
  EXPECT_EQ(noun_json(branch)["numbers"].dump(), "[]");
}

TEST(JsonWriter, EscapesWhatJsonEscapes) {
  EXPECT_EQ(text_json(R"(a "b" \c/)"), R"("a \"b\" \\c/")");
  EXPECT_EQ(text_json("\b\f\n\r\t"), R"("\b\f\n\r\t")");
}

TEST(JsonWriter, EscapesEveryControlCharacter) {
  for (int c = 0; c < 0x20; ++c) {
    const std::string text(1, char(c)), written = text_json(text);
    for (const char byte : written) EXPECT_GE(byte, 0x20) << c;
    EXPECT_EQ(json::parse(written).get<std::string>(), text) << c;
  }
  EXPECT_EQ(text_json(std::string("a\0b\x1f", 4)), R"("a\u0000b\u001f")");
}

TEST(JsonWriter, KeepsUtf8AsItIs) {
  const std::string text =
      "é ∂ 投影 🔦 \x7f";  // two, three and four bytes; DEL is no control character of JSON's
  EXPECT_EQ(text_json(text), "\"" + text + "\"");
}

TEST(JsonWriter, BytesThatAreNoUtf8AreAnError) {
  for (const char* bytes : {"\x80", "\xc3", "\xed\xa0\x80", "\xf5\x80\x80\x80", "\xc0\xaf"})
    EXPECT_THROW(text_json(bytes), json::type_error) << ::testing::PrintToString(bytes);
}

TEST(JsonWriter, WhatIsNotFiniteIsNull) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double number : {double(NAN), double(-NAN), infinity, -infinity})
    EXPECT_EQ(number_json(number), "null");
  Branch branch;
  branch.numbers = {1, NAN};
  EXPECT_EQ(noun_json(branch)["numbers"].dump(), "[1.0,null]");
}

TEST(JsonWriter, NumbersAreAsShortAsTheyCanBe) {
  EXPECT_EQ(number_json(0.1), "0.1");
  EXPECT_EQ(number_json(1.0 / 3), "0.3333333333333333");
  EXPECT_EQ(number_json(1), "1.0");
  EXPECT_EQ(number_json(-0.0), "-0.0");
  // The library's Grisu2 finds the shortest of all but one in a thousand: here 1e+23 would do.
  EXPECT_EQ(number_json(1e23), "9.999999999999999e+22");
  EXPECT_EQ(json::parse("9.999999999999999e+22").get<double>(), 1e23);
  EXPECT_EQ(number_json(5e-324), "5e-324");
  EXPECT_EQ(number_json(1.7976931348623157e308), "1.7976931348623157e+308");
}

TEST(JsonWriter, NumbersComeBackToTheBit) {
  auto random = testing::generator();
  for (int i = 0; i < 10000; ++i) {
    const double number = std::bit_cast<double>(random());
    if (!std::isfinite(number)) continue;
    const double read = json::parse(number_json(number)).get<double>();
    ASSERT_EQ(std::bit_cast<std::uint64_t>(read), std::bit_cast<std::uint64_t>(number)) << number;
  }
}

TEST(JsonWriter, WhatItWritesReadsBack) {
  const Leaf leaf = noun_from_json<Leaf>(noun_json(Leaf{"a\n\"é\"", 0.1}), "leaf");
  EXPECT_EQ(leaf.text, "a\n\"é\"");
  EXPECT_EQ(leaf.number, 0.1);
  EXPECT_THAT(testing::input_error([] {
                noun_from_json<Leaf>({{"number", nullptr}}, "leaf");
              }),
              HasSubstr("leaf: number is null, expected a number"));
}

}  // namespace
}  // namespace laterna
