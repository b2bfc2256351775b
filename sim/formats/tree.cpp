#include "sim/formats/tree.h"

#include "sim/error.h"
#include "sim/text_file.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace laterna {

namespace {

constexpr std::string_view blanks = " \t\r\n";

std::string shown(const Tree& tree) {
  const std::string text =
      tree.is_null() ? "nothing" : tree.dump(-1, ' ', false, Tree::error_handler_t::replace);
  return text.size() <= 60 ? text : text.substr(0, 57) + "...";
}

void add_numbers(const Place& place, std::vector<double>& values) {
  if (!place.tree->is_array()) {
    values.push_back(place.number());
    return;
  }
  for (std::size_t i = 0; i < place.size(); ++i) add_numbers(place.at(i), values);
}

}  // namespace

bool read_number(std::string_view text, double& number) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(number);
}

bool is_whole(double number) { return number == std::floor(number) && std::abs(number) <= 2e9; }

void fail_at(const Place& place, const std::string& expected) {
  throw InputError(fmt::format("{}: found {}, expected {}", place.name, shown(*place.tree), expected));
}

Place Place::at(const std::string& key) const {
  if (!tree->is_object()) fail_at(*this, fmt::format("a mapping with \"{}\"", key));
  const auto found = tree->find(key);
  if (found == tree->end()) throw InputError(fmt::format("{}: \"{}\" is missing", name, key));
  return {&*found, fmt::format("{}{}{}", name, name.find(": ") == name.npos ? ": " : ".", key)};
}

Place Place::at(std::size_t index) const {
  if (index >= size()) throw InputError(fmt::format("{}: holds {} entries, expected more", name, size()));
  return {&(*tree)[index], fmt::format("{}[{}]", name, index)};
}

std::size_t Place::size() const {
  if (!tree->is_array()) fail_at(*this, "a list");
  return tree->size();
}

double Place::number() const {
  double value = 0;
  if (tree->is_number() && std::isfinite(tree->get<double>())) return tree->get<double>();
  if (tree->is_string() && read_number(tree->get_ref<const std::string&>(), value)) return value;
  fail_at(*this, "a finite number");
}

int Place::whole_number() const {
  const double value = number();
  if (!is_whole(value)) fail_at(*this, "a whole number");
  return int(value);
}

std::string Place::text() const {
  if (!tree->is_string()) fail_at(*this, "text");
  return tree->get<std::string>();
}

std::vector<double> Place::numbers(std::size_t count) const {
  std::vector<double> values;
  if (!tree->is_array())
    fail_at(*this, count ? fmt::format("a list of {} numbers", count) : "a list of numbers");
  add_numbers(*this, values);
  if (count && values.size() != count)
    throw InputError(fmt::format("{}: found {} numbers, expected {}", name, values.size(), count));
  return values;
}

glm::ivec2 Place::size_px() const {
  if (!tree->is_array() || tree->size() != 2) fail_at(*this, "width and height");
  return {at(std::size_t(0)).whole_number(), at(std::size_t(1)).whole_number()};
}

Tree json_tree(const std::string& text, const std::string& file_name) {
  check_text(text, file_name);
  std::size_t values = 0;
  const auto within_limits = [&](int depth, Tree::parse_event_t, Tree&) {
    if (depth > deepest_tree)
      throw InputError(
          fmt::format("{}: nests deeper than {}, expected a calibration", file_name, deepest_tree));
    if (++values > most_tree_values)
      throw InputError(fmt::format("{}: holds more than {} values", file_name, most_tree_values));
    return true;
  };
  try {
    return Tree::parse(text, within_limits);
  } catch (const Tree::exception& error) {
    const std::string message = error.what();
    throw InputError(fmt::format("{}: no JSON: {}", file_name, message.substr(message.find("] ") + 2)));
  }
}

Tree any_tree(const std::string& text, const std::string& file_name) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == text.npos) throw InputError(file_name + ": empty, expected a calibration");
  if (text[first] == '<') return xml_tree(text, file_name);
  if (text[first] == '{' || text[first] == '[') return json_tree(text, file_name);
  return yaml_tree(text, file_name);
}

}  // namespace laterna
