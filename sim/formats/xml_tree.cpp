#include "sim/error.h"
#include "sim/formats/tree.h"
#include "sim/text_file.h"

#include <fmt/format.h>
#include <pugixml.hpp>

#include <cstring>

namespace laterna {

namespace {

// Words of a text: one alone is a scalar, several are a list. OpenCV quotes what holds blanks.
Tree words_of(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  Tree words = Tree::array();
  for (std::size_t at = text.find_first_not_of(blanks); at != text.npos;
       at = text.find_first_not_of(blanks, at)) {
    const bool quoted = text[at] == '"' && text.find('"', at + 1) != text.npos;
    const std::size_t end =
        quoted ? text.find('"', at + 1) + 1 : std::min(text.find_first_of(blanks, at), text.size());
    words.push_back(std::string(quoted ? text.substr(at + 1, end - at - 2) : text.substr(at, end - at)));
    at = end;
  }
  return words.size() == 1 ? words[0] : words;
}

class Reader {
 public:
  explicit Reader(std::string file_name) : file_name_(std::move(file_name)) {}

  Tree tree_of(const pugi::xml_node& element, int depth) {
    if (depth > deepest_tree)
      throw InputError(
          fmt::format("{}: nests deeper than {}, expected a calibration", file_name_, deepest_tree));
    if (!element.first_child() || element.first_child().type() != pugi::node_element) {
      Tree words = words_of(element.child_value());
      count(1 + words.size());
      // A matrix's data stay a list, however few.
      if (std::strcmp(element.name(), "data") == 0 && !words.is_array()) words = Tree::array({words});
      return words;
    }
    return entries_of(element, depth);
  }

 private:
  Tree entries_of(const pugi::xml_node& element, int depth) {
    const bool list = std::strcmp(element.first_child().name(), "_") == 0;
    Tree tree = list ? Tree::array() : Tree::object();
    for (const pugi::xml_node& child : element.children()) {
      if (child.type() != pugi::node_element) continue;
      count(1);
      if (list)
        tree.push_back(tree_of(child, depth + 1));
      else if (tree.contains(child.name()))
        throw InputError(fmt::format("{}: a second <{}> in <{}>", file_name_, child.name(), element.name()));
      else
        tree[child.name()] = tree_of(child, depth + 1);
    }
    return tree;
  }

  void count(std::size_t values) {
    values_ += values;
    if (values_ > most_tree_values)
      throw InputError(fmt::format("{}: holds more than {} values", file_name_, most_tree_values));
  }

  std::string file_name_;
  std::size_t values_ = 0;
};

}  // namespace

Tree xml_tree(const std::string& text, const std::string& file_name) {
  check_text(text, file_name);
  pugi::xml_document document;
  const pugi::xml_parse_result result =
      document.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result)
    throw InputError(
        fmt::format("{}: no XML at byte {}: {}", file_name, result.offset, result.description()));
  const pugi::xml_node root = document.child("opencv_storage");
  if (!root) throw InputError(file_name + ": no <opencv_storage>, expected a file of OpenCV's");
  return Reader(file_name).tree_of(root, 0);
}

}  // namespace laterna
