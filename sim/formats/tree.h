// The text of foreign calibration files as one kind of tree, whatever they are written in, and careful ways
// to take numbers out of it.
//
// Mappings are objects, lists arrays. YAML's and XML's scalars stay strings (number_of() reads them as well
// as JSON's numbers). A matrix of OpenCV's (`!!opencv-matrix`, type_id="opencv-matrix") is an object of rows,
// cols, dt and data; XML's elements named `_` are a list's entries, its text of several words is a list of
// scalars.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace laterna {

using Tree = nlohmann::json;

/// The largest file read, how deep it may nest, and how many values it may hold.
inline constexpr std::size_t most_tree_bytes = std::size_t(16) << 20;
inline constexpr int deepest_tree = 32;
inline constexpr std::size_t most_tree_values = 2'000'000;

/// One YAML document; OpenCV's `%YAML:1.0` is passed over. Each throws InputError, beginning with
/// `file_name`, for text that is not UTF-8, is no such language, or goes beyond the limits above; YAML's
/// aliases are refused, and so is a key said twice.
Tree yaml_tree(const std::string& text, const std::string& file_name);

/// An XML file of OpenCV's: what stands in <opencv_storage>.
Tree xml_tree(const std::string& text, const std::string& file_name);

Tree json_tree(const std::string& text, const std::string& file_name);

/// By its first character: `<` XML, `{` or `[` JSON, else YAML.
Tree any_tree(const std::string& text, const std::string& file_name);

/// A node with its place for messages: `file: key.key`. Each function throws InputError, `PLACE: found ...,
/// expected
/// ...`, where the node is not what its name says.
struct Place {
  const Tree* tree;
  std::string name;

  bool has(const char* key) const { return tree->is_object() && tree->contains(key); }
  Place at(const std::string& key) const;
  Place at(std::size_t index) const;
  std::size_t size() const;  ///< of a list

  double number() const;  ///< finite
  int whole_number() const;
  std::string text() const;
  /// A list's numbers, row by row where its entries are lists; `count` of them unless that is 0.
  std::vector<double> numbers(std::size_t count) const;
  /// Two whole numbers.
  glm::ivec2 size_px() const;
};

/// Throws InputError, "PLACE: found FOUND, expected EXPECTED".
[[noreturn]] void fail_at(const Place& place, const std::string& expected);

/// A finite number of decimal text, the whole of it; none otherwise.
bool read_number(std::string_view text, double& number);

/// Whether a number is one that an int holds (within ±2e9).
bool is_whole(double number);

}  // namespace laterna
