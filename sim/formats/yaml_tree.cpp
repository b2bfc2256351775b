#include "sim/error.h"
#include "sim/formats/tree.h"
#include "sim/text_file.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <optional>
#include <sstream>

namespace laterna {

namespace {

// Builds the tree from the parser's events, so that limits hold while it reads.
class Builder : public YAML::EventHandler {
 public:
  explicit Builder(std::string file_name) : file_name_(std::move(file_name)) {}
  Tree take() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { add(mark, nullptr); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    fail(mark, "an alias, expected plain values");
  }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string& value) override {
    if (!open_.empty() && open_.back().tree->is_object() && !open_.back().key) {
      if (open_.back().tree->contains(value)) fail(mark, fmt::format("a second \"{}\"", value));
      open_.back().key = value;
    } else {
      add(mark, value);
    }
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    open(mark, Tree::array());
  }
  void OnSequenceEnd() override { open_.pop_back(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    open(mark, Tree::object());
  }
  void OnMapEnd() override { open_.pop_back(); }

 private:
  struct Open {
    Tree* tree;
    std::optional<std::string> key;
  };

  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file_name_, mark.line + 1, what));
  }

  Tree* add(const YAML::Mark& mark, Tree value) {
    if (++values_ > most_tree_values) fail(mark, fmt::format("more than {} values", most_tree_values));
    if (open_.empty()) return &(root_ = std::move(value));
    Open& parent = open_.back();
    if (parent.tree->is_array()) return &parent.tree->emplace_back(std::move(value));
    if (!parent.key) fail(mark, "a key that is no text");
    Tree& entry = (*parent.tree)[*parent.key] = std::move(value);
    parent.key.reset();
    return &entry;
  }

  void open(const YAML::Mark& mark, Tree value) {
    if (open_.size() >= std::size_t(deepest_tree))
      fail(mark, fmt::format("nests deeper than {}, expected a calibration", deepest_tree));
    open_.push_back({add(mark, std::move(value)), {}});
  }

  std::string file_name_;
  Tree root_;
  std::vector<Open> open_;  // a parent grows only while its child is closed, so the pointers stand
  std::size_t values_ = 0;
};

// OpenCV begins with "%YAML:1.0", which is no YAML: the line is emptied, so that line numbers stand.
std::string without_directive(std::string text) {
  if (!text.starts_with("%YAML:")) return text;
  std::fill(text.begin(), text.begin() + std::ptrdiff_t(std::min(text.find('\n'), text.size())), ' ');
  return text;
}

// The scanner takes a token for each of these before an event can say how deep they nest.
void check_brackets(const std::string& text, const std::string& file_name) {
  int depth = 0;
  for (const char c : text) {
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > 1000)
      throw InputError(file_name + ": brackets nest deeper than 1000, expected a calibration");
  }
}

}  // namespace

Tree yaml_tree(const std::string& text, const std::string& file_name) {
  check_text(text, file_name);
  check_brackets(text, file_name);
  std::istringstream stream(without_directive(text));
  Builder builder(file_name);
  try {
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder)) throw InputError(file_name + ": empty, expected a calibration");
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}:{}: no YAML: {}", file_name, error.mark.line + 1, error.msg));
  }
  return builder.take();
}

}  // namespace laterna
