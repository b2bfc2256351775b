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

// The manifest's sequences of the cameras that are used.
std::vector<CaptureSequence> sequences_of(const fs::path& folder, const BoardFolderOptions& options) {
  const CaptureManifest manifest = manifest_or_pictures(folder, options.patterns);
  std::set<std::string> cameras;
  for (const CaptureSequence& s : manifest.sequences) cameras.insert(s.camera);
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
struct BoardView {
  std::string camera;
  std::vector<DecodedSequence> sequences{};
  PrintPicture picture{};
};

BoardView& view_of(std::vector<BoardView>& views, const std::string& camera) {
  const auto found =
      std::find_if(views.begin(), views.end(), [&](const BoardView& v) { return v.camera == camera; });
  return found == views.end() ? views.emplace_back(BoardView{camera}) : *found;
}

std::vector<BoardView> read_views(const fs::path& folder, const BoardFolderOptions& options,
                                  BoardFolders& result) {
  std::vector<BoardView> views;
  for (const CaptureSequence& sequence : sequences_of(folder, options)) {
    expect_dense(sequence, folder);
    const CapturedStack pictures = read_pictures(folder, sequence);
    BoardView& view = view_of(views, sequence.camera);
    if (view.sequences.empty()) view.picture = print_picture(pictures);
    view.sequences.push_back(decode_sequence(folder, sequence, pictures, options.decode));
    const auto seen = [&](const std::string& what) {
      return fmt::format("{}, \"{}\": {}", folder.string(), sequence.projector, what);
    };
    for (const std::string& flag : view.sequences.back().report.flags) result.warnings.push_back(seen(flag));
    for (const std::string& doubt : view.sequences.back().report.doubts) result.doubts.push_back(seen(doubt));
  }
  return views;
}

// Boards with markers first: they are not mistaken for others, but others are for them.
std::vector<int> in_order(const std::vector<PrintedBoard>& boards) {
  std::vector<int> order(boards.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_partition(order.begin(), order.end(),
                        [&](int k) { return boards[std::size_t(k)].kind == BoardKind::charuco; });
  return order;
}

// What one camera sees of a board that stands in pose `pose`.
void sight(const fs::path& folder, const BoardView& view, const std::vector<FoundPoint>& found, int board,
           int pose, const BoardFolderOptions& options, BoardFolders& result) {
  const PrintedBoard& printed = options.boards[std::size_t(board)];
  BoardCapture& capture = result.capture;
  const glm::ivec2 size(view.picture.mean.width, view.picture.mean.height);
  const int camera = device_index(capture, view.camera, size, folder);
  BoardPlacement report{folder.string(), view.camera, board, pose, view.picture, found.size()};
  add_camera_sightings(found, printed, camera, pose, capture.sightings);
  for (const DecodedSequence& decoded : view.sequences) {
    const CaptureSequence& s = decoded.sequence;
    const int device = device_index(capture, s.projector, s.projector_size, folder);
    report.projectors.push_back(
        {s.projector, add_projector_sightings(found, printed, decoded.map, device, pose, options.local,
                                              capture.sightings, 0.45, camera)});
  }
  result.placements.push_back(std::move(report));
}

// One board in the pictures of all cameras; `left` is what boards found before leave of each.
void sight_by_all(const fs::path& folder, const std::vector<BoardView>& views,
                  std::vector<PrintPicture>& left, int board, const BoardFolderOptions& options,
                  BoardFolders& result) {
  const int pose = result.capture.pose_count();
  for (std::size_t v = 0; v < views.size(); ++v) {
    const std::vector<FoundPoint> found = find_board(left[v], options.boards[std::size_t(board)]);
    if (found.empty()) continue;
    cover_board(left[v], found);
    if (result.capture.pose_count() == pose) result.capture.pose_labels.push_back(pose);
    sight(folder, views[v], found, board, pose, options, result);
  }
}

// All devices of a folder, whether they see a board or not.
void add_devices(const fs::path& folder, const std::vector<BoardView>& views, BoardCapture& capture) {
  for (const BoardView& v : views) {
    const glm::ivec2 size(v.picture.mean.width, v.picture.mean.height);
    const int camera = device_index(capture, v.camera, size, folder);
    capture.devices[std::size_t(camera)].is_camera = true;
  }
  for (const BoardView& v : views)
    for (const DecodedSequence& s : v.sequences)
      device_index(capture, s.sequence.projector, s.sequence.projector_size, folder);
}

// Cameras first, of them the one that found most boards.
void put_cameras_first(BoardFolders& result) {
  std::vector<BoardDevice>& devices = result.capture.devices;
  const auto boards_of = [&](int d) {
    return std::count_if(result.placements.begin(), result.placements.end(),
                         [&](const BoardPlacement& p) { return p.camera == devices[std::size_t(d)].name; });
  };
  std::vector<int> order(devices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto projectors = std::stable_partition(order.begin(), order.end(),
                                                [&](int d) { return devices[std::size_t(d)].is_camera; });
  const auto most =
      std::max_element(order.begin(), projectors, [&](int a, int b) { return boards_of(a) < boards_of(b); });
  std::rotate(order.begin(), most, most + 1);
  std::vector<BoardDevice> sorted;
  std::vector<int> place(order.size());
  for (const int d : order) {
    place[std::size_t(d)] = int(sorted.size());
    sorted.push_back(devices[std::size_t(d)]);
  }
  devices = std::move(sorted);
  for (Sighting& s : result.capture.sightings) {
    s.device = place[std::size_t(s.device)];
    if (s.read_at) s.read_at->device = place[std::size_t(s.read_at->device)];
  }
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
    const std::vector<BoardView> views = read_views(folder, options, result);
    add_devices(folder, views, result.capture);
    const std::size_t before = result.placements.size();
    std::vector<PrintPicture> left;
    for (const BoardView& v : views) left.push_back(v.picture);
    for (const int board : in_order(options.boards))
      sight_by_all(folder, views, left, board, options, result);
    if (result.placements.size() == before)
      result.warnings.push_back(folder.string() + ": no board was found");
  }
  put_cameras_first(result);
  result.capture.extent = extent_of(result.capture.sightings);
  validate(result.capture);
  return result;
}

}  // namespace laterna
