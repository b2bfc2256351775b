#include "calib/boards/correspondence_csv.h"

#include "sim/error.h"
#include "sim/text_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace laterna {

namespace {

constexpr std::array<const char*, 10> table_columns = {"pose",  "corner", "board_x", "board_y", "board_z",
                                                       "cam_x", "cam_y",  "proj_x",  "proj_y",  "valid"};
enum Column { pose, corner, board_x, board_y, board_z, cam_x, cam_y, proj_x, proj_y, valid };

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(trimmed(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return parts;
}

// A line of the table: its cells by column, and where it stands.
struct Line {
  std::string place;  // "file.csv: line 3"
  std::array<std::string_view, table_columns.size()> cells;

  [[noreturn]] void refuse(Column c, const char* expected) const {
    throw InputError(
        fmt::format("{}: {} is \"{}\", expected {}", place, table_columns[c], cells[c], expected));
  }
  template <class T>
  bool parse(Column c, T& value) const {
    const std::string_view text = cells[c];
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
  }
  int whole(Column c) const {
    int value = -1;
    if (!parse(c, value) || value < 0) refuse(c, "a whole number from 0");
    return value;
  }
  double number(Column c) const {
    double value = 0;
    if (!parse(c, value) || !std::isfinite(value)) refuse(c, "a finite number");
    return value;
  }
  bool is_absent(Column c) const {
    double value = 0;
    return cells[c].empty() || (parse(c, value) && std::isnan(value));
  }
  bool flag(Column c) const {
    if (cells[c] != "0" && cells[c] != "1") refuse(c, "0 or 1");
    return cells[c] == "1";
  }
};

// For each known column, where it stands in the file.
std::array<std::size_t, table_columns.size()> columns_of(const std::vector<std::string_view>& header,
                                                         const std::string& place) {
  std::array<std::size_t, table_columns.size()> at{};
  for (std::size_t c = 0; c < table_columns.size(); ++c) {
    const auto found = std::find(header.begin(), header.end(), table_columns[c]);
    const auto count = std::count(header.begin(), header.end(), table_columns[c]);
    if (count != 1) {
      throw InputError(fmt::format("{}: the header has {} columns named \"{}\", expected one each of {}",
                                   place, count, table_columns[c], fmt::join(table_columns, ",")));
    }
    at[c] = std::size_t(found - header.begin());
  }
  return at;
}

void append(const Line& line, int pose_label, std::vector<Sighting>& sightings) {
  Sighting s{0, pose_label, line.whole(corner), {}, {}};
  s.x_board = {line.number(board_x), line.number(board_y), line.number(board_z)};
  const bool lit = line.flag(valid);
  if (!(line.is_absent(cam_x) && line.is_absent(cam_y))) {
    s.pixel = {line.number(cam_x), line.number(cam_y)};
    sightings.push_back(s);
  }
  if (!lit) return;
  s.device = 1;
  s.pixel = {line.number(proj_x), line.number(proj_y)};
  sightings.push_back(s);
}

// The file's own numbers become indices.
void index_poses(BoardCapture& capture) {
  std::map<int, int> index;
  for (const Sighting& s : capture.sightings) index.emplace(s.pose, 0);
  for (auto& [label, at] : index) {
    at = capture.pose_count();
    capture.pose_labels.push_back(label);
  }
  for (Sighting& s : capture.sightings) s.pose = index.at(s.pose);
}

}  // namespace

BoardCapture parse_correspondence_csv(std::string_view text, const std::string& file_name,
                                      glm::ivec2 camera_size, glm::ivec2 projector_size) {
  check_text(text, file_name);
  const std::vector<std::string_view> lines = split(text, '\n');
  const std::vector<std::string_view> header = split(lines.front(), ',');
  const auto at = columns_of(header, fmt::format("{}: line 1", file_name));
  BoardCapture capture{{{"camera", camera_size}, {"projector", projector_size}}, {}, {}, {}};
  std::set<std::pair<int, int>> seen;
  for (std::size_t n = 1; n < lines.size(); ++n) {
    if (lines[n].empty()) continue;
    Line line{fmt::format("{}: line {}", file_name, n + 1), {}};
    const std::vector<std::string_view> cells = split(lines[n], ',');
    if (cells.size() != header.size()) {
      throw InputError(fmt::format("{}: found {} cells, expected {} as in the header", line.place,
                                   cells.size(), header.size()));
    }
    for (std::size_t c = 0; c < at.size(); ++c) line.cells[c] = cells[at[c]];
    const int label = line.whole(pose);
    if (!seen.emplace(label, line.whole(corner)).second) {
      throw InputError(fmt::format("{}: pose {} has corner {} twice, expected it once", line.place, label,
                                   line.whole(corner)));
    }
    append(line, label, capture.sightings);
  }
  index_poses(capture);
  capture.extent = extent_of(capture.sightings);
  try {
    validate(capture);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file_name, error.what()));
  }
  return capture;
}

BoardCapture read_correspondence_csv(const std::filesystem::path& path, glm::ivec2 camera_size,
                                     glm::ivec2 projector_size) {
  return parse_correspondence_csv(read_text(path, std::size_t{256} << 20), path.string(), camera_size,
                                  projector_size);
}

std::string correspondence_csv(const BoardCapture& capture) {
  if (capture.devices.size() != 2)
    throw InputError(fmt::format("table of correspondences: {} devices, expected a camera and a projector",
                                 capture.devices.size()));
  std::map<std::pair<int, int>, std::array<const Sighting*, 2>> rows;
  for (const Sighting& s : capture.sightings) rows[{s.pose, s.corner}][std::size_t(s.device)] = &s;
  std::string text = fmt::format("{}\n", fmt::join(table_columns, ","));
  for (const auto& [key, row] : rows) {
    const auto& [camera, projector] = row;
    if (!camera) continue;
    const glm::dvec3& x = camera->x_board;
    text += fmt::format("{},{},{},{},{},{},{},", capture.pose_labels[std::size_t(key.first)], key.second, x.x,
                        x.y, x.z, camera->pixel.x, camera->pixel.y);
    text +=
        projector ? fmt::format("{},{},1\n", projector->pixel.x, projector->pixel.y) : std::string(",,0\n");
  }
  return text;
}

}  // namespace laterna
