#include "apps/lab/capture_layouts.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace laterna {

namespace {

// What SLStudio's Gray codec takes of each axis.
constexpr int slstudio_bits[] = {10, 6};

// The first `bits` of an axis, most significant first, each with its inverse or without.
void add_bits(const PatternSequence& patterns, int axis, int bits, bool inverses, std::vector<int>& order) {
  for (const PatternGroup& group : pattern_groups(patterns)) {
    if (group.axis != axis || bits-- <= 0) continue;
    order.push_back(group.first);
    if (inverses) order.push_back(group.first + 1);
  }
}

int scan3d_bits(const PatternSequence& patterns) {
  return std::min(gray_bits(patterns.projector_size.x), gray_bits(patterns.projector_size.y));
}

void note_lost_bits(const char* tool, const char* axis, int lost, Notes& notes) {
  if (lost <= 0) return;
  const int m = 1 << lost;
  notes.push_back(
      fmt::format("{}'s bits are fewer: the projector's {} count in pixels of {}, c is pixel {}·c + {}", tool,
                  axis, m, m, (m - 1) / 2.0));
}

std::vector<int> scan3d_order(const PatternSequence& patterns, Notes& notes) {
  const int white = white_picture(patterns), bits = scan3d_bits(patterns);
  const glm::ivec2 size = patterns.projector_size;
  std::vector<int> order = {white, white + 1};
  for (const int axis : {0, 1}) add_bits(patterns, axis, bits, true, order);
  note_lost_bits("scan3d-capture", "columns", gray_bits(size.x) - bits, notes);
  note_lost_bits("scan3d-capture", "rows", gray_bits(size.y) - bits, notes);
  if (size != glm::ivec2(1 << bits))
    notes.push_back(
        fmt::format("projector_info.txt says {0} x {0} for {1} x {2}: scan3d-capture centres other sizes",
                    1 << bits, size.x, size.y));
  return order;
}

std::vector<int> slstudio_gray_order(const PatternSequence& patterns, Notes& notes) {
  const int white = white_picture(patterns);
  std::vector<int> order = {white, white + 1};
  for (const int axis : {0, 1}) {
    const char* name = axis == 0 ? "columns" : "rows";
    const int bits = gray_bits(patterns.projector_size[axis]);
    add_bits(patterns, axis, slstudio_bits[axis], false, order);
    note_lost_bits("SLStudio", name, bits - slstudio_bits[axis], notes);
    if (bits < slstudio_bits[axis])
      notes.push_back(fmt::format("SLStudio's Gray codec expects {} bits of {}: the projector has {}",
                                  slstudio_bits[axis], name, bits));
  }
  return order;
}

// Three steps of a sixteenth of the axis and three of all of it, of columns and rows.
bool fits_slstudio(const PatternSequence& patterns) {
  std::vector<std::pair<int, double>> found, expected;  // axis, pitch
  for (const PatternGroup& group : pattern_groups(patterns)) {
    if (group.kind != PatternGroup::Kind::fringe || group.count != 3) return false;
    found.emplace_back(group.axis, group.pitch_px);
  }
  for (const int axis : {0, 1})
    for (const double share : {16, 1}) expected.emplace_back(axis, patterns.projector_size[axis] / share);
  return found == expected;
}

std::vector<int> slstudio_fringe_order(const PatternSequence& patterns, Notes& notes) {
  if (!fits_slstudio(patterns))
    notes.push_back(
        "SLStudio's codec for calibration takes three steps of a sixteenth of the projector and three of all "
        "of "
        "it, along both axes: these fringes are others");
  std::vector<int> order;
  for (const PatternGroup& group : pattern_groups(patterns))
    for (int j = 0; j < group.count; ++j) order.push_back(group.first + (group.count - j) % group.count);
  return order;
}

std::vector<int> slstudio_order(const PatternSequence& patterns, Notes& notes) {
  const PatternKind kind = patterns.parameters.kind;
  if (kind == PatternKind::gray) return slstudio_gray_order(patterns, notes);
  if (kind == PatternKind::phase || kind == PatternKind::multi_frequency)
    return slstudio_fringe_order(patterns, notes);
  notes.push_back("SLStudio has no codec for this family: the pictures stand as they were taken");
  std::vector<int> order(std::size_t(picture_count(patterns)));
  std::iota(order.begin(), order.end(), 0);
  return order;
}

std::vector<int> procam_order(const PatternSequence& patterns) {
  std::vector<int> order(std::size_t(white_picture(patterns)) + 2);
  std::iota(order.begin(), order.end(), 0);
  return order;
}

}  // namespace

std::vector<NamedPicture> layout_pictures(const std::string& layout, const PatternSequence& patterns,
                                          Notes& notes) {
  const std::vector<int> order = layout == "procam"   ? procam_order(patterns)
                                 : layout == "scan3d" ? scan3d_order(patterns, notes)
                                                      : slstudio_order(patterns, notes);
  std::vector<NamedPicture> pictures;
  for (const int index : order) {
    const std::size_t place = pictures.size();
    pictures.push_back({index, layout == "procam"   ? fmt::format("graycode_{:02}.png", place)
                               : layout == "scan3d" ? fmt::format("cam_{:02}.png", place + 1)
                                                    : fmt::format("frameSeq_{:02}.bmp", place)});
  }
  return pictures;
}

std::string layout_folder(const std::string& layout, std::size_t place) {
  if (layout == "procam") return fmt::format("capture_{}", place);
  return fmt::format("{}_{:02}", layout == "scan3d" ? "set" : "frameSeq", place);
}

std::string projector_info(const PatternSequence& patterns) {
  return fmt::format("{0} {0}\n\n# width height\n", 1 << scan3d_bits(patterns));
}

}  // namespace laterna
