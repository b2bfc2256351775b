#include "apps/lab/capture_export.h"

#include "apps/lab/board_folders.h"
#include "apps/lab/capture_layouts.h"
#include "sim/capture_folder.h"
#include "sim/error.h"
#include "sim/image_file.h"
#include "sim/safe_write.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace laterna {

namespace {

namespace fs = std::filesystem;

// The one sequence that is asked for.
CaptureSequence sequence_of(const fs::path& folder, const CaptureExport& what) {
  std::vector<CaptureSequence> fitting;
  for (const CaptureSequence& s : read_manifest(folder).sequences)
    if ((what.camera.empty() || what.camera == s.camera) &&
        (what.projector.empty() || what.projector == s.projector))
      fitting.push_back(s);
  if (fitting.size() != 1)
    throw InputError(fmt::format("{}: {} sequences fit, expected one: --camera and --projector name it",
                                 folder.string(), fitting.size()));
  return fitting[0];
}

// Picture k in 8 bits: what the tools read.
Image<std::uint8_t> eight_bits(const CapturedStack& stack, int k, int bit_depth) {
  return std::visit(
      [&](const auto& pictures) {
        Image<std::uint8_t> picture(pictures.width, pictures.height);
        const auto values = pictures.picture(k);
        std::transform(values.begin(), values.end(), picture.values.begin(),
                       [&](auto value) { return std::uint8_t(value >> std::max(0, bit_depth - 8)); });
        return picture;
      },
      stack);
}

void export_place(const fs::path& from, const fs::path& to, const CaptureExport& what, Notes& notes) {
  const CaptureSequence sequence = sequence_of(from, what);
  const PatternSequence patterns{sequence.patterns, sequence.projector_size};
  if (what.layout != "slstudio" && sequence.patterns.kind != PatternKind::gray)
    throw InputError(fmt::format("{}: not Gray codes, which {} alone reads", from.string(), what.layout));
  const CapturedStack stack = read_pictures(from, sequence);
  const int pictures = std::visit([](const auto& s) { return s.count; }, stack);
  fs::create_directory(to);
  for (const NamedPicture& picture : layout_pictures(what.layout, patterns, notes)) {
    if (picture.index >= pictures)
      throw InputError(fmt::format("{}: {} pictures, expected more", from.string(), pictures));
    write_picture(to / picture.name, eight_bits(stack, picture.index, sequence.bit_depth));
  }
  if (what.layout == "scan3d")
    write_file(to / "projector_info.txt", std::string_view(projector_info(patterns)));
  if (sequence.bit_depth > 8)
    notes.push_back(
        fmt::format("{} takes 8 bits: the last {} are left out", what.layout, sequence.bit_depth - 8));
}

// What a device saw in a pose, point by point of the board: those it did not see have a level of "-".
std::string corners_of(const std::string& picture, const std::map<int, glm::dvec2>& seen, int points) {
  if (seen.empty()) return picture + " - - -\n";
  std::string rows;
  for (int k = 0; k < points; ++k) {
    const auto found = seen.find(k);
    rows += found == seen.end() ? fmt::format("{} 0 0 -\n", picture)
                                : fmt::format("{} {} {} 0\n", picture, found->second.x, found->second.y);
  }
  return rows;
}

Image<std::uint8_t> grey(const Image<float>& mean) {
  Image<std::uint8_t> picture(mean.width, mean.height);
  std::transform(mean.values.begin(), mean.values.end(), picture.values.begin(),
                 [](float value) { return std::uint8_t(std::clamp(value * 255 + 0.5f, 0.0f, 255.0f)); });
  return picture;
}

void export_corners(const fs::path& from, const fs::path& to, const CaptureExport& what, Notes& notes,
                    const Progress& progress) {
  if (what.board.empty()) throw InputError("vnl: --board is missing, expected such as chessboard,9x6,30mm");
  BoardFolderOptions options;
  options.boards = {parse_board(what.board)};
  options.camera = what.camera;
  const BoardFolders folders = read_board_folders({from}, options, progress);
  if (std::count_if(folders.capture.devices.begin(), folders.capture.devices.end(),
                    [](const BoardDevice& d) { return d.is_camera; }) > 1)
    throw InputError(
        fmt::format("{}: pictures by several cameras, expected --camera with one of them", from.string()));
  notes.insert(notes.end(), folders.warnings.begin(), folders.warnings.end());
  const BoardCapture& capture = folders.capture;
  const glm::ivec2 count = point_count(options.boards[0]);
  std::string table = "# filename x y level\n";
  for (std::size_t d = 0; d < capture.devices.size(); ++d) {
    const BoardDevice& device = capture.devices[d];
    for (int pose = 0; pose < capture.pose_count(); ++pose) {
      std::map<int, glm::dvec2> seen;
      for (const Sighting& s : capture.sightings)
        if (s.device == int(d) && s.pose == pose) seen[s.corner] = s.pixel;
      const std::string picture = fmt::format("{}{:03}.png", device.name, pose);
      table += corners_of(picture, seen, count.x * count.y);
      write_picture(to / picture, d == 0 ? grey(folders.placements[std::size_t(pose)].picture.mean)
                                         : Image<std::uint8_t>(device.size.x, device.size.y, 255));
    }
  }
  write_file(to / "corners.vnl", std::string_view(table));
}

}  // namespace

bool is_capture_layout(const std::string& name) {
  return name == "procam" || name == "scan3d" || name == "slstudio" || name == "vnl";
}

void export_capture(const fs::path& from, const fs::path& to, const CaptureExport& what, Notes& notes,
                    const Progress& progress) {
  PendingFolder folder(to);
  if (what.layout == "vnl") {
    export_corners(from, folder.path(), what, notes, progress);
  } else {
    const std::vector<fs::path> places = placement_folders({from});
    for (std::size_t i = 0; i < places.size(); ++i) {
      Notes of_place;
      export_place(places[i], folder.path() / layout_folder(what.layout, i), what, of_place);
      if (i == 0) notes.insert(notes.end(), of_place.begin(), of_place.end());
    }
  }
  folder.commit();
}

}  // namespace laterna
