#include "apps/lab/dataset/dataset_spec.h"

#include "apps/lab/noun_json.h"
#include "apps/lab/toml_text.h"
#include "sim/error.h"
#include "sim/plain_name.h"
#include "sim/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <sstream>

namespace laterna {

namespace {

using Json = nlohmann::json;

constexpr std::size_t most_bytes = std::size_t(16) << 20;

[[noreturn]] void fail(const std::string& file, const toml::node& node, const std::string& sentence) {
  throw InputError(fmt::format("{}:{}: {}", file, node.source().begin.line, sentence));
}

Json json_of(const toml::node& node, const std::string& file) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* integer = node.as_integer()) return integer->get();
  if (const auto* boolean = node.as_boolean()) return boolean->get();
  if (const auto* number = node.as_floating_point(); number && std::isfinite(number->get()))
    return number->get();
  Json json;
  if (const auto* array = node.as_array()) {
    json = Json::array();
    for (const toml::node& element : *array) json.push_back(json_of(element, file));
  } else if (const auto* table = node.as_table()) {
    json = Json::object();
    for (const auto& [key, value] : *table) json[std::string(key.str())] = json_of(value, file);
  } else {
    fail(file, node, "found a date or a number that is not finite, expected a value of a scene");
  }
  return json;
}

/// A table of the top level, taken out of it; empty where there is none.
toml::table take_table(toml::table& top, const char* key, const std::string& file) {
  toml::node* node = top.get(key);
  if (!node) return {};
  if (!node->is_table()) fail(file, *node, fmt::format("{} is no table, expected [{}]", key, key));
  toml::table table = std::move(*node->as_table());  // a copy would forget the lines
  top.erase(key);
  return table;
}

// Distributions inside a chosen table, at any depth.
void check_nested(const Json& value, const std::string& place) {
  if (is_distribution(value)) check_distribution(value, place);
  if (!value.is_structured()) return;
  for (const Json& inner : value) check_nested(inner, place);
}

/// A path without the index 0, which a path may leave out.
std::string without_zeros(const std::string& path) {
  std::istringstream words(path);
  std::string result;
  for (std::string word; std::getline(words, word, '.');)
    if (word != "0") result += "." + word;
  return result;
}

void check_different(const std::vector<RandomKey>& keys) {
  std::map<std::string, std::string> seen;
  for (const RandomKey& key : keys)
    if (const auto [first, is_new] = seen.emplace(without_zeros(key.path), key.path); !is_new)
      throw InputError(fmt::format("{}: is the same key as \"{}\"", key.place, first->second));
}

std::vector<RandomKey> random_keys(const toml::table& table, const std::string& file) {
  std::vector<std::pair<std::uint32_t, RandomKey>> keys;
  for (const auto& [key, node] : table) {
    const std::string path(key.str());
    const auto line = node.source().begin.line;
    const std::string place = fmt::format("{}:{}: random \"{}\"", file, line, path);
    if (path.empty() || path.find_first_of("= \t\n") != std::string::npos)
      throw InputError(place + ": expected a path of keys such as \"camera.fov_x_deg\"");
    const Json distribution = json_of(node, file);
    check_distribution(distribution, place);
    check_nested(distribution, place);
    keys.emplace_back(line, RandomKey{path, distribution, place});
  }
  std::stable_sort(keys.begin(), keys.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<RandomKey> sorted;
  for (auto& [line, key] : keys) sorted.push_back(std::move(key));
  check_different(sorted);
  return sorted;
}

std::vector<PresentKey> present_keys(const toml::table& table, const std::string& file) {
  std::vector<PresentKey> keys;
  for (const auto& [key, node] : table) {
    int mesh = -1, used = 0;
    const std::string path(key.str());
    if (std::sscanf(path.c_str(), "mesh.%5d%n", &mesh, &used) != 1 || used != int(path.size()) || mesh < 0)
      fail(file, node, fmt::format("present \"{}\", expected \"mesh.INDEX\"", path));
    const double share = node.value<double>().value_or(-1);
    if (!node.is_number() || !(share >= 0 && share <= 1))
      fail(file, node, fmt::format("present \"{}\" is no share, expected a number from 0 to 1", path));
    if (std::any_of(keys.begin(), keys.end(), [&](const PresentKey& k) { return k.mesh == mesh; }))
      fail(file, node, fmt::format("present \"{}\" says again what becomes of mesh {}", path, mesh));
    keys.push_back({mesh, share});
  }
  std::sort(keys.begin(), keys.end(), [](const auto& a, const auto& b) { return a.mesh < b.mesh; });
  return keys;
}

}  // namespace

DatasetSpec parse_dataset_spec(std::string_view text, const std::string& file) {
  toml::table top = parse_toml(text, file);
  DatasetSpec spec;
  spec.text = text;
  spec.random = random_keys(take_table(top, "random", file), file);
  spec.present = present_keys(take_table(top, "present", file), file);
  spec.reject =
      noun_from_json<RejectSettings>(json_of(take_table(top, "reject", file), file), file + ": [reject]");
  spec.settings = noun_from_json<DatasetSettings>(json_of(top, file), file);
  if (spec.settings.scene.empty()) throw InputError(file + ": no scene, expected the name of a scene file");
  check_plain_name(spec.settings.name, file + ": name");
  return spec;
}

DatasetSpec read_dataset_spec(const std::filesystem::path& path) {
  DatasetSpec spec = parse_dataset_spec(read_text(path, most_bytes), path.string());
  spec.scene_file = path.parent_path() / spec.settings.scene;
  spec.scene_text = read_text(spec.scene_file, most_bytes);
  return spec;
}

}  // namespace laterna
