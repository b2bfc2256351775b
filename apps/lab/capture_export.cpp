#include "apps/lab/capture_export.h"

#include "apps/lab/board_folders.h"
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

struct NamedPicture {
  int index;  ///< into the sequence
  std::string name;
};

// The first `bits` of an axis, most significant first, each with its inverse.
void add_pairs(const PatternSequence& patterns, int axis, int bits, std::vector<int>& order) {
  for (const PatternGroup& group : pattern_groups(patterns))
    if (group.axis == axis && bits-- > 0) order.insert(order.end(), {group.first, group.first + 1});
}

std::vector<NamedPicture> procam_order(const PatternSequence& patterns) {
  std::vector<NamedPicture> order;
  for (int k = 0; k < white_picture(patterns) + 2; ++k)
    order.push_back({k, fmt::format("graycode_{:02}.png", k)});
  return order;
}

int scan3d_bits(const PatternSequence& patterns) {
  return std::min(gray_bits(patterns.projector_size.x), gray_bits(patterns.projector_size.y));
}

std::vector<NamedPicture> scan3d_order(const PatternSequence& patterns) {
  const int white = white_picture(patterns), bits = scan3d_bits(patterns);
  std::vector<int> order = {white, white + 1};
  for (const int axis : {0, 1}) add_pairs(patterns, axis, bits, order);
  std::vector<NamedPicture> named;
  for (std::size_t i = 0; i < order.size(); ++i)
    named.push_back({order[i], fmt::format("cam_{:02}.png", i + 1)});
  return named;
}

std::vector<NamedPicture> slstudio_order(int pictures) {
  std::vector<NamedPicture> order;
  for (int k = 0; k < pictures; ++k) order.push_back({k, fmt::format("frameSeq_{:02}.png", k)});
  return order;
}

void note_scan3d(const PatternSequence& patterns, Notes& notes) {
  const int bits = scan3d_bits(patterns);
  const glm::ivec2 size = patterns.projector_size;
  for (const auto& [axis, bits_here] :
       {std::pair("columns", gray_bits(size.x)), std::pair("rows", gray_bits(size.y))})
    if (bits_here > bits)
      notes.push_back(
          fmt::format("scan3d-capture has as many bits for rows as for columns: the projector's {} count in "
                      "pixels of {}",
                      axis, 1 << (bits_here - bits)));
  if (size != glm::ivec2(1 << bits))
    notes.push_back(
        fmt::format("projector_info.txt says {0} x {0} for {1} x {2}: scan3d-capture centres other sizes",
                    1 << bits, size.x, size.y));
}

std::string folder_name(const std::string& layout, std::size_t place) {
  if (layout == "procam") return fmt::format("capture_{}", place);
  return layout == "scan3d" ? fmt::format("set_{:02}", place) : fmt::format("frameSeq_{:02}", place);
}

void export_place(const fs::path& from, const fs::path& to, const CaptureExport& what, Notes* notes) {
  const CaptureSequence sequence = sequence_of(from, what);
  const PatternSequence patterns{sequence.patterns, sequence.projector_size};
  if (what.layout != "slstudio" && sequence.patterns.kind != PatternKind::gray)
    throw InputError(fmt::format("{}: not Gray codes, which {} alone reads", from.string(), what.layout));
  const CapturedStack stack = read_pictures(from, sequence);
  const int pictures = std::visit([](const auto& s) { return s.count; }, stack);
  const std::vector<NamedPicture> order = what.layout == "procam"   ? procam_order(patterns)
                                          : what.layout == "scan3d" ? scan3d_order(patterns)
                                                                    : slstudio_order(pictures);
  fs::create_directory(to);
  for (const NamedPicture& picture : order) {
    if (picture.index >= pictures)
      throw InputError(fmt::format("{}: {} pictures, expected more", from.string(), pictures));
    write_picture(to / picture.name, eight_bits(stack, picture.index, sequence.bit_depth));
  }
  if (what.layout == "scan3d")
    write_file(to / "projector_info.txt",
               std::string_view(fmt::format("{0} {0}\n\n# width height\n", 1 << scan3d_bits(patterns))));
  if (!notes) return;
  if (sequence.bit_depth > 8)
    notes->push_back(
        fmt::format("{} takes 8 bits: the last {} are left out", what.layout, sequence.bit_depth - 8));
  if (what.layout == "scan3d") note_scan3d(patterns, *notes);
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
    for (std::size_t i = 0; i < places.size(); ++i)
      export_place(places[i], folder.path() / folder_name(what.layout, i), what, i == 0 ? &notes : nullptr);
  }
  folder.commit();
}

}  // namespace laterna
