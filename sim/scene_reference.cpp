#include "sim/scene_reference.h"

#include "sim/field_text.h"
#include "sim/scene_fields.h"

#include <fmt/format.h>

#include <algorithm>

namespace laterna {

namespace {

using Sections = std::vector<std::string>;

void add_section(Sections& sections, const std::string& section) {
  if (std::find(sections.begin(), sections.end(), section) == sections.end()) sections.push_back(section);
}

/// Adds the section of T, then those of the tables among its fields; what projector and camera share, once.
template <Described T>
void add_sections(Sections& sections, const std::string& heading, const std::string& sentence,
                  bool top_level);

/// Writes a row for each field, and the sections of the tables among them.
struct ReferenceWriter {
  bool top_level = false;
  std::string rows{};
  Sections sections{};

  template <class T>
  void operator()(const Field& field, T& value) {
    row(field, expected_text<T>(field), toml_text(value));
    if constexpr (Described<T>) add_sections<T>(sections, heading(field), field.sentence, false);
  }
  template <Described T>
  void operator()(const Field& field, std::vector<T>&) {
    row(field, "an array of tables", "");
    add_sections<T>(sections, fmt::format("[[{}]]", field.key), field.sentence, false);
  }
  std::string heading(const Field& field) const {
    return top_level ? fmt::format("[{}]", field.key) : fmt::format("{} = {{ ... }}", field.key);
  }
  void row(const Field& field, const std::string& value, const std::string& unchanged) {
    const bool none = unchanged.empty() || unchanged == "\"\"" || unchanged == "[]";
    rows += fmt::format("| `{}` | {} | {} | {} | {} |\n", field.key, field.unit, value,
                        none ? "" : "`" + unchanged + "`", field.sentence);
  }
};

template <Described T>
void add_sections(Sections& sections, const std::string& heading, const std::string& sentence,
                  bool top_level) {
  ReferenceWriter writer{.top_level = top_level};
  T noun{};
  describe(writer, noun);
  add_section(
      sections,
      fmt::format("\n## {}\n{}\n\n| key | unit | value | default | meaning |\n|---|---|---|---|---|\n{}",
                  heading, sentence, writer.rows));
  for (const std::string& section : writer.sections) add_section(sections, section);
}

}  // namespace

std::string scene_reference_markdown() {
  Sections sections;
  add_sections<SceneSpec>(sections, "Top level",
                          "`name`, `ambient_lx` and `believe_truth` stand before the first table.", true);
  std::string page =
      "# The scene file\n"
      "<!-- Made by `laterna info --scene-reference > data/scene-reference.md`; edit sim/fields and "
      "sim/scene_fields.h. "
      "-->\n\n"
      "A scene is a TOML file. Lengths are metres and angles radians unless a key says otherwise. Pixels "
      "have\n"
      "their centres at integer coordinates, (0, 0) is the first, v points down. Devices look along +z, "
      "with x\n"
      "right and y down. A key without a default is absent unless given. An unknown key is an error.\n\n"
      "A device takes its intrinsics in exactly one way (`fx`; `throw_ratio`; `fov_y_deg`; `fov_x_deg`;\n"
      "`cameramodel`) and its placement in exactly one way (`device_from_world`; `position` and "
      "`look_at`;\n"
      "`rotation_vector_rad` or `quaternion_wxyz` and `translation`; `cameramodel`). `laterna new` prints "
      "a\n"
      "scene to begin with.\n";
  for (const std::string& section : sections) page += section;
  return page;
}

}  // namespace laterna
