#include "apps/lab/dataset/named_files.h"

#include "sim/toml_guard.h"

#include <toml++/toml.h>

namespace laterna {

namespace {

namespace fs = std::filesystem;

/// Collects the strings that name files.
class Names {
 public:
  explicit Names(const fs::path& folder) : folder_(folder) {}

  void add(const toml::node& node) {
    if (const auto* text = node.as_string()) add(text->get());
    if (const auto* array = node.as_array())
      for (const toml::node& element : *array) add(element);
    if (const auto* table = node.as_table())
      for (const auto& [key, value] : *table) add(value);
  }
  void add(const nlohmann::json& json) {
    if (json.is_string()) add(json.get_ref<const std::string&>());
    if (json.is_structured())
      for (const nlohmann::json& inner : json) add(inner);
  }

  std::vector<fs::path> files;

 private:
  void add(const std::string& name) {
    std::error_code none;
    if (!name.empty() && fs::is_regular_file(folder_ / name, none)) files.push_back(folder_ / name);
  }
  fs::path folder_;
};

}  // namespace

std::vector<fs::path> named_files(const DatasetSpec& spec) {
  Names names(spec.scene_file.parent_path());
  check_toml_bytes(spec.scene_text, spec.scene_file.string());
  try {
    names.add(toml::parse(spec.scene_text));
  } catch (const toml::parse_error&) {
    return {};  // what is wrong with the scene is told where it is read
  }
  for (const RandomKey& key : spec.random) names.add(key.distribution);
  return names.files;
}

}  // namespace laterna
