// The writing half of sim/scene_file.h: a visitor of the description.
#include "sim/field_text.h"
#include "sim/scene_fields.h"
#include "sim/scene_file.h"

namespace laterna {

namespace {

template <Described T>
std::string lines_of(const T& noun) {
  std::string lines;
  for (const FieldText& field : changed_field_texts(noun)) lines += field.key + " = " + field.value + "\n";
  return lines;
}

/// The arrays of tables; all else is on the scene's own lines.
struct SceneWriter {
  std::string sections;

  template <class T>
  void operator()(const Field&, T&) {}
  template <Described T>
  void operator()(const Field& field, std::vector<T>& nouns) {
    for (const T& noun : nouns) sections += std::string("\n[[") + field.key + "]]\n" + lines_of(noun);
  }
};

}  // namespace

std::string scene_toml(const SceneSpec& spec) {
  SceneSpec visited = spec;
  SceneWriter writer;
  describe(writer, visited);
  return lines_of(spec) + writer.sections;
}

}  // namespace laterna
