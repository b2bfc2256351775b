#include "calib/decode_board.h"

#include "sim/error.h"
#include "sim/pattern_board.h"

#include <fmt/format.h>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace laterna {

namespace {

constexpr double corner_sigma_px = 0.1;  // of OpenCV's corners, camera pixels
constexpr double least_contrast = 10 / 255.0;

/// The inner corners of a board, camera pixels, row by row.
struct Corners {
  glm::ivec2 count{0, 0};
  std::vector<std::optional<glm::dvec2>> camera_px;

  const std::optional<glm::dvec2>& at(int i, int j) const { return camera_px[std::size_t(j) * count.x + i]; }
};

template <class T>
bool is_lit(const ImageStackView<T>& stack, std::size_t i) {
  return stack.picture(1)[i] - stack.picture(2)[i] > least_contrast * (sizeof(T) == 1 ? 255 : 65535);
}

/// The board's picture between black (0) and white (255); grey where nothing is lit.
template <class T>
cv::Mat flat_picture(const ImageStackView<T>& stack) {
  cv::Mat flat(stack.height, stack.width, CV_8UC1, cv::Scalar(255));
  for (std::size_t i = 0; i < stack.picture_size(); ++i) {
    if (!is_lit(stack, i)) continue;
    const double black = stack.picture(2)[i],
                 share = (stack.picture(0)[i] - black) / (stack.picture(1)[i] - black);
    flat.data[i] = std::uint8_t(std::lround(255 * std::clamp(share, 0.0, 1.0)));
  }
  return flat;
}

/// Whether the square before the first corner is black, as it is on the board.
bool starts_black(const cv::Mat& picture, const std::vector<cv::Point2f>& corners, int columns) {
  const cv::Point2f middle =
      corners[0] - 0.5f * (corners[1] - corners[0]) - 0.5f * (corners[columns] - corners[0]);
  const cv::Point pixel(int(std::lround(middle.x)), int(std::lround(middle.y)));
  return cv::Rect({0, 0}, picture.size()).contains(pixel) && picture.at<std::uint8_t>(pixel) < 128;
}

void find_chessboard(const cv::Mat& picture, Corners& corners) {
  std::vector<cv::Point2f> found;
  if (!cv::findChessboardCornersSB(picture, {corners.count.x, corners.count.y}, found)) return;
  if (!starts_black(picture, found, corners.count.x)) std::reverse(found.begin(), found.end());
  for (std::size_t i = 0; i < found.size(); ++i) corners.camera_px[i] = {found[i].x, found[i].y};
}

void find_charuco(const cv::Mat& picture, const BoardLayout& layout, Corners& corners) {
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_1000);
  const auto board =
      cv::aruco::CharucoBoard::create(layout.squares.x, layout.squares.y, 1, 0.75f, dictionary);
  std::vector<std::vector<cv::Point2f>> markers;
  std::vector<int> marker_ids, ids;
  std::vector<cv::Point2f> found;
  cv::aruco::detectMarkers(picture, dictionary, markers, marker_ids);
  if (marker_ids.empty()) return;
  cv::aruco::interpolateCornersCharuco(markers, marker_ids, picture, board, found, ids);
  for (std::size_t k = 0; k < found.size(); ++k) {
    corners.camera_px[std::size_t(ids[k])] = {found[k].x, found[k].y};
  }
}

/// Camera pixels per square along a board axis at a corner, from its neighbours there.
std::optional<glm::dvec2> per_square(const Corners& corners, glm::ivec2 at, glm::ivec2 along) {
  const auto get = [&](glm::ivec2 c) -> std::optional<glm::dvec2> {
    const bool inside = c.x >= 0 && c.y >= 0 && c.x < corners.count.x && c.y < corners.count.y;
    return inside ? corners.at(c.x, c.y) : std::nullopt;
  };
  const auto here = get(at), next = get(at + along), last = get(at - along);
  if (next && last) return (*next - *last) / 2.0;
  if (next) return *next - *here;
  if (last) return *here - *last;
  return {};
}

void set_corner(const Corners& corners, const BoardLayout& layout, int i, int j, DecodedMap& map) {
  const auto right = per_square(corners, {i, j}, {1, 0}), down = per_square(corners, {i, j}, {0, 1});
  if (!right || !down) return;
  const glm::dmat2 camera_from_square(*right, *down);
  if (std::abs(glm::determinant(camera_from_square)) < 1) return;  // seen edge-on
  const glm::dmat2 projector_from_camera = glm::inverse(camera_from_square) * double(layout.square_px);
  const glm::dvec2 corner = *corners.at(i, j), pixel = glm::round(corner);
  if (pixel.x < 0 || pixel.y < 0 || pixel.x >= map.width || pixel.y >= map.height) return;
  const glm::dvec2 place = layout.corner_px(i, j) + projector_from_camera * (pixel - corner);
  const std::size_t at = std::size_t(pixel.y) * map.width + std::size_t(pixel.x);
  const double squared = glm::dot(projector_from_camera[0], projector_from_camera[0]) +
                         glm::dot(projector_from_camera[1], projector_from_camera[1]);
  map.u_px.values[at] = place.x, map.v_px.values[at] = place.y;
  map.sigma_px.values[at] = float(corner_sigma_px * std::sqrt(squared / 2));
  map.valid.values[at] = 1, map.confidence.values[at] = 1, map.why.values[at] = Reject::none;
}

}  // namespace

DecodedMap decode_board(const CapturedView& pictures, const PatternSequence& sequence) {
  validate(sequence);
  return std::visit(
      [&](const auto& stack) {
        if (stack.count != 3 || stack.picture_size() == 0)
          throw InputError(fmt::format("board: {} pictures of {}×{}, expected board, white and black",
                                       stack.count, stack.width, stack.height));
        DecodedMap map(stack.width, stack.height);
        for (std::size_t i = 0; i < map.valid.values.size(); ++i)
          reject(map, i, is_lit(stack, i) ? Reject::pair : Reject::dim);
        const BoardLayout layout = board_layout(sequence);
        Corners corners{layout.squares - 1, {}};
        corners.camera_px.resize(std::size_t(corners.count.x) * corners.count.y);
        const cv::Mat picture = flat_picture(stack);
        if (sequence.parameters.kind == PatternKind::charuco)
          find_charuco(picture, layout, corners);
        else
          find_chessboard(picture, corners);
        for (int j = 0; j < corners.count.y; ++j)
          for (int i = 0; i < corners.count.x; ++i)
            if (corners.at(i, j)) set_corner(corners, layout, i, j, map);
        return map;
      },
      pictures);
}

}  // namespace laterna
