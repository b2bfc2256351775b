#include "apps/lab/board_folders.h"

#include "apps/lab/decode_folder.h"
#include "sim/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace laterna {

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> subfolders(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_directory() && !entry.path().filename().string().starts_with('.'))
      names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end(), natural_less);
  std::vector<fs::path> paths;
  for (const std::string& name : names) paths.push_back(folder / name);
  return paths;
}

bool holds_pictures(const fs::path& folder) {
  if (fs::exists(folder / "manifest.json")) return true;
  return std::any_of(fs::directory_iterator(folder), fs::directory_iterator(),
                     [](const auto& entry) { return entry.is_regular_file() && is_picture(entry.path()); });
}

// The manifest's sequences of the one camera that is used.
std::vector<CaptureSequence> sequences_of(const fs::path& folder, const BoardFolderOptions& options) {
  const CaptureManifest manifest = manifest_or_pictures(folder, options.patterns);
  std::set<std::string> cameras;
  for (const CaptureSequence& s : manifest.sequences) cameras.insert(s.camera);
  if (options.camera.empty() && cameras.size() > 1)
    throw InputError(fmt::format("{}: pictures by {} cameras ({}), expected --camera with one of them",
                                 folder.string(), cameras.size(), fmt::join(cameras, ", ")));
  std::vector<CaptureSequence> chosen;
  for (const CaptureSequence& s : manifest.sequences)
    if (options.camera.empty() || s.camera == options.camera) chosen.push_back(s);
  if (chosen.empty())
    throw InputError(fmt::format("{}: no pictures by a camera \"{}\", expected one of {}", folder.string(),
                                 options.camera, fmt::join(cameras, ", ")));
  return chosen;
}

// The index of a device, added where it is new.
int device_index(BoardCapture& capture, const std::string& name, const glm::ivec2& size,
                 const fs::path& folder) {
  for (int d = 0; d < int(capture.devices.size()); ++d) {
    if (capture.devices[d].name != name) continue;
    if (capture.devices[d].size == size) return d;
    throw InputError(fmt::format("{}: \"{}\" has {}x{} pixels, expected {}x{} as in the folders before",
                                 folder.string(), name, size.x, size.y, capture.devices[d].size.x,
                                 capture.devices[d].size.y));
  }
  capture.devices.push_back({name, size});
  return int(capture.devices.size()) - 1;
}

void expect_dense(const CaptureSequence& sequence, const fs::path& folder) {
  if (sequence.patterns.kind == PatternKind::chessboard || sequence.patterns.kind == PatternKind::charuco)
    throw InputError(
        fmt::format("{}: a projected board tells single points only, expected Gray codes or fringes, "
                    "which tell the projector's pixel at any point of a printed board",
                    folder.string()));
}

/// One camera's pictures of one folder.
struct Placement {
  std::vector<DecodedSequence> sequences;
  PrintPicture picture;
};

Placement read_placement(const fs::path& folder, const BoardFolderOptions& options, BoardFolders& result) {
  Placement placement;
  for (const CaptureSequence& sequence : sequences_of(folder, options)) {
    expect_dense(sequence, folder);
    const CapturedStack pictures = read_pictures(folder, sequence);
    if (placement.sequences.empty()) placement.picture = print_picture(pictures);
    placement.sequences.push_back(decode_sequence(folder, sequence, pictures, options.decode));
    const auto seen = [&](const std::string& what) {
      return fmt::format("{}, \"{}\": {}", folder.string(), sequence.projector, what);
    };
    for (const std::string& flag : placement.sequences.back().report.flags)
      result.warnings.push_back(seen(flag));
    for (const std::string& doubt : placement.sequences.back().report.doubts)
      result.doubts.push_back(seen(doubt));
  }
  return placement;
}

// Boards with markers first: they are not mistaken for others, but others are for them.
std::vector<int> in_order(const std::vector<PrintedBoard>& boards) {
  std::vector<int> order(boards.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_partition(order.begin(), order.end(),
                        [&](int k) { return boards[std::size_t(k)].kind == BoardKind::charuco; });
  return order;
}

void sight(const fs::path& folder, const Placement& placement, PrintPicture& left, int board,
           const BoardFolderOptions& options, BoardFolders& result) {
  const PrintedBoard& printed = options.boards[std::size_t(board)];
  const std::vector<FoundPoint> found = find_board(left, printed);
  if (found.empty()) return;
  cover_board(left, found);
  BoardCapture& capture = result.capture;
  const int pose = capture.pose_count();
  capture.pose_labels.push_back(pose);
  BoardPlacement report{folder.string(), board, pose, placement.picture, found.size()};
  add_camera_sightings(found, printed, 0, pose, capture.sightings);
  for (const DecodedSequence& decoded : placement.sequences) {
    const CaptureSequence& s = decoded.sequence;
    const int device = device_index(capture, s.projector, s.projector_size, folder);
    report.projectors.push_back(
        {s.projector, add_projector_sightings(found, printed, decoded.map, device, pose, options.local,
                                              capture.sightings)});
  }
  result.placements.push_back(std::move(report));
}

}  // namespace

std::vector<fs::path> placement_folders(const std::vector<fs::path>& folders) {
  std::vector<fs::path> placements;
  for (const fs::path& folder : folders) {
    if (!fs::is_directory(folder))
      throw InputError(
          fmt::format("{}: no such folder, expected one of pictures of a board", folder.string()));
    const std::vector<fs::path> inner = holds_pictures(folder) ? std::vector{folder} : subfolders(folder);
    if (inner.empty())
      throw InputError(fmt::format("{}: holds neither pictures nor folders, expected pictures of a board",
                                   folder.string()));
    placements.insert(placements.end(), inner.begin(), inner.end());
  }
  return placements;
}

BoardFolders read_board_folders(const std::vector<fs::path>& folders, const BoardFolderOptions& options,
                                const Progress& progress) {
  BoardFolders result;
  for (const fs::path& folder : placement_folders(folders)) {
    if (progress) progress(fmt::format("looking for boards in {}", folder.string()));
    const Placement placement = read_placement(folder, options, result);
    device_index(result.capture, placement.sequences.front().sequence.camera,
                 {placement.picture.mean.width, placement.picture.mean.height}, folder);
    for (const DecodedSequence& s : placement.sequences)
      device_index(result.capture, s.sequence.projector, s.sequence.projector_size, folder);
    const std::size_t before = result.placements.size();
    PrintPicture left = placement.picture;
    for (const int board : in_order(options.boards)) sight(folder, placement, left, board, options, result);
    if (result.placements.size() == before)
      result.warnings.push_back(folder.string() + ": no board was found");
  }
  result.capture.extent = extent_of(result.capture.sightings);
  validate(result.capture);
  return result;
}

}  // namespace laterna
