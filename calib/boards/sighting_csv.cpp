#include "calib/boards/sighting_csv.h"

#include "calib/csv.h"
#include "sim/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <tuple>

namespace laterna {

namespace {

const std::vector<std::string> required = {"device",  "pose",    "corner", "board_x",
                                           "board_y", "board_z", "x",      "y"};
enum Column { device, pose, corner, board_x, board_y, board_z, x, y, sigma_px };

int device_of(const CsvLine& line, const std::vector<BoardDevice>& devices) {
  const std::string name = line.text(device);
  const auto found =
      std::find_if(devices.begin(), devices.end(), [&](const BoardDevice& d) { return d.name == name; });
  if (found == devices.end()) {
    std::vector<std::string> names;
    for (const BoardDevice& d : devices) names.push_back(d.name);
    line.refuse(device, fmt::format("one of {}", fmt::join(names, ", ")).c_str());
  }
  return int(found - devices.begin());
}

}  // namespace

bool is_sighting_csv(std::string_view text) {
  const std::vector<std::string_view> names = split_trimmed(text.substr(0, text.find('\n')), ',');
  return std::find(names.begin(), names.end(), "device") != names.end();
}

BoardCapture parse_sighting_csv(std::string_view text, const std::string& file_name,
                                const std::vector<BoardDevice>& devices) {
  std::vector<std::string> columns;
  const std::vector<CsvLine> lines = csv_lines(text, file_name, required, {"sigma_px"}, columns);
  BoardCapture capture{devices, {}, {}, {}};
  std::set<std::tuple<int, int, int>> seen;
  for (const CsvLine& line : lines) {
    Sighting s{device_of(line, devices), line.whole(pose), line.whole(corner), {}, {}};
    s.x_board = {line.number(board_x), line.number(board_y), line.number(board_z)};
    s.pixel = {line.number(x), line.number(y)};
    if (!line.is_absent(sigma_px)) s.sigma_px = line.number(sigma_px);
    if (!seen.emplace(s.device, s.pose, s.corner).second)
      throw InputError(fmt::format("{}: {} has corner {} of pose {} twice, expected it once", line.place,
                                   devices[std::size_t(s.device)].name, s.corner, s.pose));
    capture.sightings.push_back(s);
  }
  complete_table(capture, file_name);
  return capture;
}

std::string sighting_csv(const BoardCapture& capture) {
  std::string text = fmt::format("{},sigma_px\n", fmt::join(required, ","));
  for (const Sighting& s : capture.sightings)
    text += fmt::format("{},{},{},{},{},{},{},{},{}\n", capture.devices[std::size_t(s.device)].name,
                        capture.pose_labels[std::size_t(s.pose)], s.corner, s.x_board.x, s.x_board.y,
                        s.x_board.z, s.pixel.x, s.pixel.y, s.sigma_px);
  return text;
}

}  // namespace laterna
