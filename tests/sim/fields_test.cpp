#include "sim/fields.h"

#include "sim/field_text.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <limits>

namespace laterna {
namespace {

enum class Colour { red, green };
std::span<const char* const> names_of(Colour) {
  static constexpr const char* names[] = {"red", "green"};
  return names;
}

struct Small {
  double width = 1.5;
  std::optional<glm::dvec2> at;
  Colour colour = Colour::red;
};
template <class Visitor>
void describe(Visitor& visit, Small& small) {
  visit(Field{.key = "width", .unit = "m", .low = 0, .low_excluded = true}, small.width);
  visit(Field{.key = "at"}, small.at);
  visit(Field{.key = "colour"}, small.colour);
}

TEST(Fields, KeysComeInTheOrderOfTheDescription) {
  EXPECT_THAT(keys_of<Small>(), ::testing::ElementsAre("width", "at", "colour"));
}

TEST(Fields, RangesExcludeWhatTheySay) {
  const double inf = std::numeric_limits<double>::infinity();
  const Field above{.key = "", .low = 0, .low_excluded = true}, closed{.key = "", .low = 0, .high = 1},
      any{.key = ""};
  EXPECT_FALSE(in_range(above, 0));
  EXPECT_TRUE(in_range(above, 1e-300));
  EXPECT_TRUE(in_range(closed, 0));
  EXPECT_TRUE(in_range(closed, 1));
  EXPECT_FALSE(in_range(closed, std::nextafter(1, 2)));
  for (const Field& field : {above, closed, any}) {
    EXPECT_FALSE(in_range(field, inf));
    EXPECT_FALSE(in_range(field, -inf));
    EXPECT_FALSE(in_range(field, std::nan("")));
  }
  EXPECT_EQ(range_text(above), "above 0");
  EXPECT_EQ(range_text(closed), "0 to 1");
  EXPECT_EQ(range_text(any), "");
}

TEST(Fields, EditDistancesByHand) {
  EXPECT_EQ(edit_distance("albedo", "albedo"), 0);
  EXPECT_EQ(edit_distance("albdo", "albedo"), 1);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("abc", ""), 3);
}

TEST(Fields, EditDistanceIsAMetric) {
  auto random = testing::generator();
  const auto word = [&] {
    std::string text(random() % 8, 'a');
    for (char& c : text) c = char('a' + random() % 3);
    return text;
  };
  for (int i = 0; i < 300; ++i) {
    const std::string a = word(), b = word(), c = word();
    EXPECT_EQ(edit_distance(a, b), edit_distance(b, a));
    EXPECT_EQ(edit_distance(a, b) == 0, a == b);
    EXPECT_LE(edit_distance(a, c), edit_distance(a, b) + edit_distance(b, c));
  }
}

TEST(Fields, NearestKey) {
  const std::vector<std::string> known = {"file", "albedo", "albedo_map"};
  EXPECT_EQ(nearest_key("albdo", known), "albedo");
  EXPECT_EQ(nearest_key("albedomap", known), "albedo_map");
  EXPECT_EQ(nearest_key(std::string(100000, 'x'), known).empty(), false);
  EXPECT_EQ(nearest_key("x", {}), "");
  const std::vector<std::string> keys{"fx", "fov_x_deg"};
  EXPECT_EQ(nearest_key("fov_x", keys), "fov_x_deg");  // what it begins, though fx is three letters away
}

TEST(FieldText, NumbersReadBackToTheSameBits) {
  auto random = testing::generator();
  int tried = 0;
  for (int i = 0; i < 20000; ++i) {
    const double number = std::bit_cast<double>(random());
    if (!std::isfinite(number)) continue;
    const std::string text = toml_text(number);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(std::strtod(text.c_str(), nullptr)),
              std::bit_cast<std::uint64_t>(number));
    EXPECT_NE(text.find_first_of(".e"), std::string::npos) << text;
    ++tried;
  }
  EXPECT_GT(tried, 10000);
  EXPECT_EQ(toml_text(2.0), "2.0");
  EXPECT_EQ(toml_text(-0.0), "-0.0");
}

TEST(FieldText, StringsAreEscaped) { EXPECT_EQ(toml_text(std::string("a\"b\\c\n")), R"("a\"b\\c\u000A")"); }

TEST(FieldText, OnlyWhatDiffersFromTheDefault) {
  Small small;
  EXPECT_TRUE(changed_field_texts(small).empty());
  EXPECT_EQ(toml_text(small), "");
  small.at = glm::dvec2(1, 2);
  small.colour = Colour::green;
  EXPECT_EQ(toml_text(small), R"({ at = [1.0, 2.0], colour = "green" })");
}

TEST(FieldText, ExpectedTextsNameTypeAndRange) {
  const Field field{.key = "", .low = 0, .high = 1};
  EXPECT_EQ(expected_text<std::optional<double>>(field), "a number (0 to 1)");
  EXPECT_EQ(expected_text<glm::dvec3>(field), "3 numbers (0 to 1)");
  EXPECT_EQ(expected_text<Colour>(field), R"(one of "red", "green")");
  EXPECT_EQ(expected_text<std::vector<Small>>(field), "an array of tables");
}

}  // namespace
}  // namespace laterna
