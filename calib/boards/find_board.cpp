#include "calib/boards/find_board.h"

#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace laterna {

namespace {

using Points = std::vector<cv::Point2f>;

// 8 bits of curve(value).
template <class Curve>
cv::Mat bytes_of(const Image<float>& picture, const Curve& curve) {
  cv::Mat bytes(picture.height, picture.width, CV_8UC1);
  for (std::size_t i = 0; i < picture.values.size(); ++i)
    bytes.data[i] = std::uint8_t(std::lround(255 * std::clamp(curve(double(picture.values[i])), 0.0, 1.0)));
  return bytes;
}

double value_at(const cv::Mat& picture, const cv::Point2d& at) {
  const cv::Point pixel(int(std::lround(at.x)), int(std::lround(at.y)));
  return cv::Rect({0, 0}, picture.size()).contains(pixel) ? picture.at<std::uint8_t>(pixel) : 0.0;
}

// Whether the square after the first corner is black: the one beside it is brighter then.
bool starts_black(const cv::Mat& picture, const Points& p, int columns) {
  const cv::Point2f right = p[1] - p[0], down = p[std::size_t(columns)] - p[0];
  return value_at(picture, p[0] + 0.5f * (right + down)) < value_at(picture, p[0] + 0.5f * (right - down));
}

// Rows to the right and columns down: x × y > 0 in the image.
void unmirror(Points& p, const glm::ivec2& count) {
  const cv::Point2f right = p[std::size_t(count.x) - 1] - p[0],
                    down = p[p.size() - std::size_t(count.x)] - p[0];
  if (right.cross(down) > 0) return;
  for (std::size_t row = 0; row < p.size(); row += std::size_t(count.x))
    std::reverse(p.begin() + std::ptrdiff_t(row), p.begin() + std::ptrdiff_t(row) + count.x);
}

int half_window(const Points& p) {
  const double step = cv::norm(p[1] - p[0]);
  return std::clamp(int(step / 4), 2, 15);
}

// OpenCV may say that it found a board and give no corners.
bool find_corners(const cv::Mat& picture, const cv::Size& size, Points& found) {
  const auto all = [&](bool said) { return said && found.size() == std::size_t(size.area()); };
  if (!all(cv::findChessboardCornersSB(
          picture, size, found,
          cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE | cv::CALIB_CB_ACCURACY)) &&
      !all(cv::findChessboardCorners(picture, size, found)))
    return false;
  const int half = half_window(found);
  cv::cornerSubPix(picture, found, {half, half}, {-1, -1},
                   {cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 50, 1e-4});
  return true;
}

std::vector<FoundPoint> numbered(const Points& points) {
  std::vector<FoundPoint> found;
  for (std::size_t k = 0; k < points.size(); ++k) found.push_back({int(k), {points[k].x, points[k].y}});
  return found;
}

std::vector<FoundPoint> find_chessboard(const cv::Mat& picture, const PrintedBoard& board) {
  Points found;
  if (!find_corners(picture, {board.count.x, board.count.y}, found)) return {};
  unmirror(found, board.count);
  if (!is_symmetric(board) && !starts_black(picture, found, board.count.x))
    std::reverse(found.begin(), found.end());
  return numbered(found);
}

std::vector<FoundPoint> find_charuco(const cv::Mat& picture, const PrintedBoard& board) {
  const auto dictionary = cv::aruco::getPredefinedDictionary(dictionary_id(board.dictionary));
  const auto layout = cv::aruco::CharucoBoard::create(board.count.x, board.count.y, float(board.spacing_m),
                                                      float(board.mark_m), dictionary);
  std::vector<Points> markers;
  std::vector<int> marker_ids, ids;
  Points corners;
  cv::aruco::detectMarkers(picture, dictionary, markers, marker_ids);
  if (marker_ids.empty()) return {};
  cv::aruco::interpolateCornersCharuco(markers, marker_ids, picture, layout, corners, ids);
  std::vector<FoundPoint> found;
  for (std::size_t k = 0; k < corners.size(); ++k) found.push_back({ids[k], {corners[k].x, corners[k].y}});
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.index < b.index; });
  return found;
}

// The centre of the ellipse as which the circle of that centre and radius (m) is seen, minus the image of its
// centre. C⁻¹ of a circle is [r² - c·cᵀ, -c; -cᵀ, -1] up to scale, and H·C⁻¹·Hᵀ is the dual conic of the
// image, whose last column is its centre.
cv::Point2d centre_bias(const cv::Matx33d& picture_from_board, const cv::Point2d& c, double radius) {
  const double rr = radius * radius;
  const cv::Matx33d dual(rr - c.x * c.x, -c.x * c.y, -c.x, -c.x * c.y, rr - c.y * c.y, -c.y, -c.x, -c.y, -1);
  const cv::Matx33d seen = picture_from_board * dual * picture_from_board.t();
  const cv::Vec3d centre = picture_from_board * cv::Vec3d(c.x, c.y, 1);
  return {seen(0, 2) / seen(2, 2) - centre[0] / centre[2], seen(1, 2) / seen(2, 2) - centre[1] / centre[2]};
}

cv::Ptr<cv::FeatureDetector> blob_detector(const cv::Mat& picture) {
  cv::SimpleBlobDetector::Params params;
  params.minArea = 12;
  params.maxArea = float(picture.total()) / 9;
  params.minDistBetweenBlobs = 3;
  return cv::SimpleBlobDetector::create(params);
}

std::vector<FoundPoint> find_circles(const cv::Mat& picture, const PrintedBoard& board) {
  Points found;
  const int grid =
      board.kind == BoardKind::circles ? cv::CALIB_CB_SYMMETRIC_GRID : cv::CALIB_CB_ASYMMETRIC_GRID;
  const auto detector = blob_detector(picture);
  const cv::Size size(board.count.x, board.count.y);
  const auto all = [&](bool said) { return said && found.size() == std::size_t(size.area()); };
  if (!all(cv::findCirclesGrid(picture, size, found, grid, detector)) &&
      !all(cv::findCirclesGrid(picture, size, found, grid | cv::CALIB_CB_CLUSTERING, detector)))
    return {};
  if (board.kind == BoardKind::circles) unmirror(found, board.count);
  std::vector<cv::Point2d> on_board, seen;
  for (const glm::dvec3& point : board_points(board)) on_board.emplace_back(point.x, point.y);
  for (const cv::Point2f& point : found) seen.emplace_back(point);
  const cv::Mat h = cv::findHomography(on_board, seen);
  if (h.empty()) return {};
  const cv::Matx33d picture_from_board(h);
  std::vector<FoundPoint> points = numbered(found);
  for (FoundPoint& point : points) {
    const cv::Point2d bias =
        centre_bias(picture_from_board, on_board[std::size_t(point.index)], board.mark_m / 2);
    point.pixel -= glm::dvec2(bias.x, bias.y);
  }
  return points;
}

bool alike(double a, double b, double contrast) { return std::abs(a - b) < 0.3 * contrast; }

// The four squares around a corner, from its neighbours along the row and the column.
bool is_corner_evenly_lit(const cv::Mat& picture, const cv::Point2d& at, const cv::Point2d& right,
                          const cv::Point2d& down) {
  const double a = value_at(picture, at + 0.3 * (right + down)),
               b = value_at(picture, at + 0.3 * (down - right));
  const double c = value_at(picture, at - 0.3 * (right + down)),
               d = value_at(picture, at + 0.3 * (right - down));
  const double contrast = std::abs(a + c - b - d) / 2;
  return alike(a, c, contrast) && alike(b, d, contrast);
}

// Paper around a circle, by less than half of what is between it and the next.
bool is_circle_evenly_lit(const cv::Mat& picture, const cv::Point2d& at, double radius) {
  constexpr int samples = 16;
  double low = 255, high = 0;
  for (int k = 0; k < samples; ++k) {
    const double angle = 2 * CV_PI * k / samples;
    const double value = value_at(picture, at + radius * cv::Point2d(std::cos(angle), std::sin(angle)));
    low = std::min(low, value), high = std::max(high, value);
  }
  return alike(low, high, high - value_at(picture, at));
}

/// Found points by their place on the board.
struct Grid {
  glm::ivec2 count;
  std::vector<const FoundPoint*> at;
  Grid(const std::vector<FoundPoint>& found, const glm::ivec2& points)
      : count(points), at(std::size_t(points.x * points.y)) {
    for (const FoundPoint& p : found) at[std::size_t(p.index)] = &p;
  }
  // The step along a board axis at a point, from either neighbour; none without one.
  std::optional<cv::Point2d> step(int i, int j, int di, int dj) const {
    const glm::dvec2 here = at[std::size_t(j * count.x + i)]->pixel;
    for (const int sign : {1, -1}) {
      const int x = i + sign * di, y = j + sign * dj;
      if (x < 0 || y < 0 || x >= count.x || y >= count.y || !at[std::size_t(y * count.x + x)]) continue;
      const glm::dvec2 d = double(sign) * (at[std::size_t(y * count.x + x)]->pixel - here);
      return cv::Point2d(d.x, d.y);
    }
    return {};
  }
};

std::vector<FoundPoint> evenly_lit(const cv::Mat& picture, const PrintedBoard& board,
                                   const std::vector<FoundPoint>& found) {
  const Grid grid(found, point_count(board));
  const bool circles = board.kind == BoardKind::circles || board.kind == BoardKind::asymmetric_circles;
  // On the asymmetric grid a row's circles are two spacings apart.
  const double ring =
      (board.mark_m / board.spacing_m + 1) / 4 / (board.kind == BoardKind::asymmetric_circles ? 2 : 1);
  std::vector<FoundPoint> kept;
  for (const FoundPoint& p : found) {
    const int i = p.index % grid.count.x, j = p.index / grid.count.x;
    const auto right = grid.step(i, j, 1, 0), down = grid.step(i, j, 0, 1);
    if (!right || !down) continue;
    const cv::Point2d at(p.pixel.x, p.pixel.y);
    if (circles ? is_circle_evenly_lit(picture, at, ring * cv::norm(*right))
                : is_corner_evenly_lit(picture, at, *right, *down))
      kept.push_back(p);
  }
  return kept;
}

std::vector<FoundPoint> find_any(const cv::Mat& view, const PrintedBoard& board) {
  std::vector<FoundPoint> found = board.kind == BoardKind::chessboard ? find_chessboard(view, board)
                                  : board.kind == BoardKind::charuco  ? find_charuco(view, board)
                                                                      : find_circles(view, board);
  std::erase_if(found,
                [](const FoundPoint& p) { return !std::isfinite(p.pixel.x) || !std::isfinite(p.pixel.y); });
  return evenly_lit(view, board, found);
}

template <class T>
Image<float> stretched_mean(const ImageStack<T>& stack) {
  Image<float> mean(stack.width, stack.height, 0.0f);
  for (int k = 0; k < stack.count; ++k)
    for (std::size_t i = 0; i < mean.values.size(); ++i) mean.values[i] += float(stack.picture(k)[i]);
  const float most = mean.values.empty() ? 0 : *std::max_element(mean.values.begin(), mean.values.end());
  if (most > 0)
    for (float& value : mean.values) value /= most;
  return mean;
}

}  // namespace

std::vector<FoundPoint> find_board(const Image<float>& picture, const PrintedBoard& board) {
  if (picture.values.empty()) return {};
  std::vector<FoundPoint> found = find_any(bytes_of(picture, [](double v) { return v; }), board);
  if (found.size() < 4)
    found =
        find_any(bytes_of(picture, [](double v) { return std::log1p(500 * v) / std::log1p(500.0); }), board);
  if (found.size() < 4) found.clear();
  return found;
}

Image<float> mean_picture(const CapturedStack& stack) {
  return std::visit([](const auto& s) { return stretched_mean(s); }, stack);
}

}  // namespace laterna
