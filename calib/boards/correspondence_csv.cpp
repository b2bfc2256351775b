#include "calib/boards/correspondence_csv.h"

#include "calib/csv.h"
#include "sim/error.h"
#include "sim/text_file.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <set>

namespace laterna {

namespace {

const std::vector<std::string> table_columns = {"pose",  "corner", "board_x", "board_y", "board_z",
                                                "cam_x", "cam_y",  "proj_x",  "proj_y",  "valid"};
enum Column { pose, corner, board_x, board_y, board_z, cam_x, cam_y, proj_x, proj_y, valid };

void append(const CsvLine& line, int pose_label, std::vector<Sighting>& sightings) {
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

}  // namespace

BoardCapture parse_correspondence_csv(std::string_view text, const std::string& file_name,
                                      glm::ivec2 camera_size, glm::ivec2 projector_size) {
  std::vector<std::string> columns;
  const std::vector<CsvLine> lines = csv_lines(text, file_name, table_columns, {}, columns);
  BoardCapture capture{{{"camera", camera_size}, {"projector", projector_size}}, {}, {}, {}};
  std::set<std::pair<int, int>> seen;
  for (const CsvLine& line : lines) {
    const int label = line.whole(pose);
    if (!seen.emplace(label, line.whole(corner)).second) {
      throw InputError(fmt::format("{}: pose {} has corner {} twice, expected it once", line.place, label,
                                   line.whole(corner)));
    }
    append(line, label, capture.sightings);
  }
  complete_table(capture, file_name);
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
