#include "apps/laterna/pattern_words.h"

#include "sim/pattern_json.h"
#include "sim/scene_fields.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace laterna {

namespace {

/// An option for each described field.
struct WordAdder {
  CLI::App& command;

  template <class T>
  void operator()(const Field& field, T& value) const {
    std::string name = std::string("--") + field.key;
    std::replace(name.begin(), name.end(), '_', '-');
    if constexpr (std::is_same_v<T, PatternKind>) {
      command.add_option_function<std::string>(
          name, [&value](const std::string& word) { value = patterns_of(word).kind; },
          std::string("Patterns. ") + field.sentence);
    } else if constexpr (std::is_same_v<T, bool>) {
      command.add_flag(name, value, field.sentence);
    } else {
      CLI::Option* option =
          command.add_option(name, value, field.sentence)->check(CLI::Range(field.low, field.high));
      if constexpr (!std::is_same_v<T, std::vector<double>>)
        option->capture_default_str();
      else
        option->delimiter(',');
    }
  }
};

}  // namespace

void add_pattern_words(CLI::App& command, PatternParameters& patterns) {
  WordAdder adder{command};
  describe(adder, patterns);
}

std::optional<PatternSequence> plain_patterns(const PatternParameters& patterns, const std::string& size) {
  if (size.empty()) return {};
  const auto parsed = parse_size(size, "--projector-size");
  return PatternSequence{patterns, {parsed[0], parsed[1]}};
}

}  // namespace laterna
