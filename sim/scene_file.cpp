#include "sim/scene_file.h"

#include "sim/error.h"
#include "sim/field_text.h"
#include "sim/scene_fields.h"
#include "sim/text_file.h"
#include "sim/toml_guard.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <utility>

namespace laterna {

namespace {

constexpr std::size_t most_bytes = std::size_t(16) << 20;

/// A short row of numbers as it is written; empty for another array.
std::string row_text(const toml::array& array) {
  if (array.size() > 4 ||
      !std::all_of(array.begin(), array.end(), [](const toml::node& n) { return n.is_number(); }))
    return "";
  std::string text;
  for (const toml::node& n : array)
    text += fmt::format("{}{}", text.empty() ? "" : ", ", n.value<double>().value_or(0));
  return "[" + text + "]";
}

/// What stands in the file, in words.
std::string found_text(const toml::node& node) {
  if (const auto* text = node.as_string()) {
    const std::string& s = text->get();
    return s.size() <= 40 ? "the string " + toml_text(s) : fmt::format("a string of {} characters", s.size());
  }
  if (const auto* integer = node.as_integer()) return std::to_string(integer->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* boolean = node.as_boolean()) return boolean->get() ? "true" : "false";
  if (const auto* array = node.as_array()) {
    const std::string row = row_text(*array);
    return row.empty() ? fmt::format("an array of {}", array->size()) : row;
  }
  return node.is_table() ? "a table" : "a date or time";
}

/// Where in the file a table stands, for messages.
struct Place {
  std::string file, heading;  ///< "scene.toml", "[[mesh]]"; no heading: the top level
  std::string in() const { return heading.empty() ? " at the top level" : " in " + heading; }
  std::string of(const char* key) const {
    return heading.empty() ? key : std::string(key) + " of " + heading;
  }
  [[noreturn]] void fail(const toml::node& node, const std::string& sentence) const {
    const toml::source_region& source = node.source();
    if (source.path && *source.path != file)  // an override, which stands in no line
      throw InputError(fmt::format("{}: {}", *source.path, sentence));
    throw InputError(fmt::format("{}:{}: {}", file, source.begin.line, sentence));
  }
};

template <Described T>
void read_table(const toml::table& table, const Place& place, T& noun);

/// The visitor that fills a noun from its table.
class Reader {
 public:
  Reader(const toml::table& table, const Place& place) : table_(table), place_(place) {}

  template <class T>
  void operator()(const Field& field, T& value) {
    const toml::node* node = table_.get(field.key);
    if (!node) return;
    if (!read(*node, field, value)) {
      place_.fail(*node, fmt::format("{}{} is {}, expected {}", field.key, place_.in(), found_text(*node),
                                     expected_text<T>(field)));
    }
  }

 private:
  // Each read() tells whether the node holds a value of its type and in its range.
  static bool read(const toml::node& node, const Field& field, double& value) {
    if (!node.is_number()) return false;
    value = node.value<double>().value_or(0.0);
    return in_range(field, value);
  }
  template <std::integral T>
  static bool read(const toml::node& node, const Field& field, T& value) {
    const auto* integer = node.as_integer();
    if (!integer || !std::in_range<T>(integer->get()) || !in_range(field, double(integer->get())))
      return false;
    value = T(integer->get());
    return true;
  }
  static bool read(const toml::node& node, const Field&, bool& value) {
    if (!node.is_boolean()) return false;
    value = node.value<bool>().value_or(false);
    return true;
  }
  static bool read(const toml::node& node, const Field&, std::string& value) {
    const auto* text = node.as_string();
    if (!text) return false;
    value = text->get();
    const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
    return std::none_of(value.begin(), value.end(), is_control);
  }
  template <Named T>
  static bool read(const toml::node& node, const Field&, T& value) {
    const auto names = names_of(value);
    const auto* text = node.as_string();
    if (!text) return false;
    const auto name = std::find(names.begin(), names.end(), text->get());
    if (name == names.end()) return false;
    value = T(name - names.begin());
    return true;
  }
  template <class T>
  static bool read_list(const toml::node& node, const Field& field, T* values, std::size_t count) {
    const auto* array = node.as_array();
    if (!array || array->size() != count) return false;
    for (std::size_t i = 0; i < count; ++i)
      if (!read((*array)[i], field, values[i])) return false;
    return true;
  }
  template <glm::length_t n, class T>
  static bool read(const toml::node& node, const Field& field, glm::vec<n, T>& value) {
    return read_list(node, field, &value[0], n);
  }
  static bool read(const toml::node& node, const Field& field, std::array<double, 4>& value) {
    return read_list(node, field, value.data(), value.size());
  }
  static bool read(const toml::node& node, const Field& field, Matrix3x4& value) {
    return read_list(node, field, value.data(), value.size());
  }
  template <class T>
    requires std::is_same_v<T, double> || std::is_same_v<T, std::string>
  static bool read(const toml::node& node, const Field& field, std::vector<T>& value) {
    value.assign(node.is_array() ? node.as_array()->size() : 0, T{});
    return read_list(node, field, value.data(), value.size());
  }
  template <class T>
  static bool read(const toml::node& node, const Field& field, std::optional<T>& value) {
    return read(node, field, value.emplace());
  }
  template <Described T>
  bool read(const toml::node& node, const Field& field, T& noun) const {
    if (!node.is_table()) return false;
    const bool top = place_.heading.empty();
    read_table(*node.as_table(), {place_.file, top ? fmt::format("[{}]", field.key) : place_.of(field.key)},
               noun);
    return true;
  }
  template <Described T>
  bool read(const toml::node& node, const Field& field, std::vector<T>& nouns) const {
    const Place place{place_.file, fmt::format("[[{}]]", field.key)};
    if (node.is_table())
      place_.fail(node, fmt::format("[{}] is one table, expected {}", field.key, place.heading));
    if (!node.is_array()) return false;
    for (const toml::node& element : *node.as_array()) {
      if (!element.is_table()) return false;
      read_table(*element.as_table(), place, nouns.emplace_back());
    }
    return true;
  }

  const toml::table& table_;
  const Place& place_;
};

template <Described T>
void read_table(const toml::table& table, const Place& place, T& noun) {
  const std::vector<std::string> known = keys_of<T>();
  for (const auto& [key, node] : table) {
    if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
    const std::string name = key.str().size() <= 64 ? std::string(key.str()) : "(a long one)";
    place.fail(node, fmt::format("unknown key {}{}, did you mean \"{}\"?", toml_text(name), place.in(),
                                 nearest_key(key.str(), known)));
  }
  Reader reader(table, place);
  describe(reader, noun);
  if constexpr (requires { check(noun); }) {
    try {
      check(noun);
    } catch (const InputError& error) {
      if (place.heading.empty()) throw InputError(place.file + ": " + error.what());
      place.fail(table, error.what());
    }
  }
}

toml::table parse_toml(std::string_view text, const std::string& file_name) {
  try {
    return toml::parse(text, file_name);
  } catch (const toml::parse_error& error) {
    throw InputError(
        fmt::format("{}:{}: {}", file_name, error.source().begin.line, std::string(error.description())));
  }
}

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> keys;
  for (std::size_t at = 0; at <= path.size();) {
    const std::size_t dot = std::min(path.find('.', at), path.size());
    keys.push_back(path.substr(at, dot - at));
    at = dot + 1;
  }
  return keys;
}

/// Walks from a table down a path, through arrays by index or to their first entry.
class Override {
 public:
  explicit Override(const std::string& text) : name_("--set " + text.substr(0, text.find('='))) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) fail("expected KEY=VALUE");
    keys_ = split(text.substr(0, equals));
    for (const std::string& key : keys_)
      if (key.empty()) fail("expected keys joined by single dots");
    value_ = parsed(text.substr(equals + 1));
  }

  void apply(toml::table& root) {
    toml::table* table = &root;
    for (std::size_t k = 0; k + 1 < keys_.size(); ++k) table = step(*table, k);
    table->insert_or_assign(keys_.back(), std::move(*value_.get("value")));  // a copy forgets its source
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", name_, what));
  }
  // {"value": what the text says}; its nodes name this override as their source.
  toml::table parsed(const std::string& value) const {
    try {
      return toml::parse("value = " + value, name_);
    } catch (const toml::parse_error& error) {
      fail(fmt::format("\"{}\" is no TOML value: {}", value.size() <= 40 ? value : "(a long text)",
                       error.description()));
    }
  }
  static bool is_index(const std::string& key) {
    return !key.empty() && key.size() < 7 && key.find_first_not_of("0123456789") == std::string::npos;
  }
  // The table under keys_[k]; an index after it is passed over by leaving k on it.
  toml::table* step(toml::table& table, std::size_t& k) const {
    toml::node* node = table.get(keys_[k]);
    if (!node) node = &table.insert_or_assign(keys_[k], std::move(*parsed("{}").get("value"))).first->second;
    toml::array* array = node->as_array();
    if (!array)
      return node->is_table() ? node->as_table() : (fail(fmt::format("{} is no table", keys_[k])), nullptr);
    const bool indexed = k + 2 < keys_.size() && is_index(keys_[k + 1]);
    const std::size_t at = indexed ? std::stoul(keys_[k + 1]) : 0;
    if (at >= array->size() || !array->get(at)->is_table())
      fail(fmt::format("{} has {} entries", keys_[k], array->size()));
    k += indexed;
    return array->get(at)->as_table();
  }

  std::string name_;  // "--set KEY"
  std::vector<std::string> keys_;
  toml::table value_;
};

}  // namespace

SceneSpec parse_scene(std::string_view text, const std::string& file_name) {
  return parse_scene(text, file_name, {});
}

SceneSpec parse_scene(std::string_view text, const std::string& file_name,
                      const std::vector<std::string>& overrides) {
  if (text.size() > most_bytes)
    throw InputError(fmt::format("{}: {} bytes, expected at most {}", file_name, text.size(), most_bytes));
  check_toml_bytes(text, file_name);
  toml::table table = parse_toml(text, file_name);
  for (const std::string& text_of_one : overrides) {
    check_toml_bytes(text_of_one, "--set");
    Override(text_of_one).apply(table);
  }
  SceneSpec spec;
  read_table(table, {file_name, ""}, spec);
  return spec;
}

SceneSpec read_scene_spec(const std::filesystem::path& path) { return read_scene_spec(path, {}); }

SceneSpec read_scene_spec(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  return parse_scene(read_text(path, most_bytes), path.string(), overrides);
}

Scene load_scene(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  const SceneSpec spec = read_scene_spec(path, overrides);
  try {
    return build_scene(spec, path.parent_path());
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

}  // namespace laterna
