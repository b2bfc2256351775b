#include "calib/boards/find_board.h"

#include "calib/median.h"

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

void refine(const cv::Mat& picture, Points& corners, int half_window) {
  cv::cornerSubPix(picture, corners, {half_window, half_window}, {-1, -1},
                   {cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 50, 1e-4});
}

// OpenCV may say that it found a board and give no corners.
bool find_corners(const cv::Mat& picture, const cv::Size& size, Points& found) {
  const auto all = [&](bool said) { return said && found.size() == std::size_t(size.area()); };
  constexpr int old_flags =
      cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK;
  if (!all(cv::findChessboardCornersSB(picture, size, found, cv::CALIB_CB_NORMALIZE_IMAGE)) &&
      !all(cv::findChessboardCorners(picture, size, found, old_flags)))
    return false;
  refine(picture, found, std::clamp(int(cv::norm(found[1] - found[0]) / 4), 2, 15));
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

// Picture pixels per square: the median over pairs of corners one after the other.
double spacing_px(const Points& corners, const std::vector<int>& ids, const PrintedBoard& board) {
  const std::vector<glm::dvec3> points = board_points(board);
  std::vector<double> per_square;
  for (std::size_t k = 1; k < corners.size(); ++k)
    per_square.push_back(cv::norm(corners[k] - corners[k - 1]) * board.spacing_m /
                         glm::distance(points[std::size_t(ids[k])], points[std::size_t(ids[k - 1])]));
  return median(per_square);
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
  if (corners.size() < 4) return {};
  // The white beside the markers is narrow: OpenCV's own window is too, and it leaves half a pixel in both
  // coordinates.
  const int half =
      std::max(2, int(spacing_px(corners, ids, board) * (1 - board.mark_m / board.spacing_m) / 2));
  refine(picture, corners, half);
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

// The centroid of what is darker than paper, each pixel weighted by how much, within a disc that holds one
// circle.
void refine_circle(const cv::Mat& picture, cv::Point2f& centre, double radius) {
  double paper = 0, ink = 255;
  const int reach = int(std::ceil(radius));
  const cv::Point middle(int(std::lround(centre.x)), int(std::lround(centre.y)));
  const auto each = [&](const auto& visit) {
    for (int y = middle.y - reach; y <= middle.y + reach; ++y)
      for (int x = middle.x - reach; x <= middle.x + reach; ++x)
        if (x >= 0 && y >= 0 && x < picture.cols && y < picture.rows &&
            std::hypot(x - centre.x, y - centre.y) < radius)
          visit(x, y, double(picture.at<std::uint8_t>(y, x)));
  };
  each([&](int, int, double v) { paper = std::max(paper, v), ink = std::min(ink, v); });
  double sum = 0;
  cv::Point2d moment(0, 0);
  each([&](int x, int y, double v) {
    const double weight = std::clamp((0.9 * paper + 0.1 * ink - v) / (0.8 * (paper - ink)), 0.0, 1.0);
    sum += weight, moment += weight * cv::Point2d(x, y);
  });
  if (sum > 0) centre = moment / sum;
}

cv::Ptr<cv::FeatureDetector> blob_detector(const cv::Mat& picture) {
  cv::SimpleBlobDetector::Params params;
  params.minArea = 12;
  params.maxArea = float(picture.total()) / 9;
  params.minDistBetweenBlobs = 3;
  return cv::SimpleBlobDetector::create(params);
}

// Each within half the distance to the nearest other.
void refine_circles(const cv::Mat& picture, Points& centres) {
  const Points before = centres;
  for (std::size_t k = 0; k < before.size(); ++k) {
    double nearest = picture.cols;
    for (std::size_t other = 0; other < before.size(); ++other)
      if (other != k) nearest = std::min(nearest, cv::norm(before[k] - before[other]));
    refine_circle(picture, centres[k], nearest / 2);
  }
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
  refine_circles(picture, found);
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

/// Found points by their place on the board.
struct Grid {
  glm::ivec2 count;
  std::vector<glm::dvec3> board;
  std::vector<const FoundPoint*> at;

  Grid(const std::vector<FoundPoint>& found, const PrintedBoard& printed)
      : count(point_count(printed)), board(board_points(printed)), at(board.size()) {
    for (const FoundPoint& p : found) at[std::size_t(p.index)] = &p;
  }

  // A neighbour's index, to either side of a point along the row or the column; none without one.
  std::optional<std::size_t> neighbour(int index, const glm::ivec2& along) const {
    const glm::ivec2 here(index % count.x, index / count.x);
    for (const int sign : {1, -1}) {
      const glm::ivec2 there = here + sign * along;
      if (there.x < 0 || there.y < 0 || there.x >= count.x || there.y >= count.y) continue;
      const std::size_t k = std::size_t(there.y) * std::size_t(count.x) + std::size_t(there.x);
      if (at[k]) return k;
    }
    return {};
  }

  // Picture pixels per board metre at a point; none without a neighbour along each axis.
  std::optional<glm::dmat2> picture_from_board(int index) const {
    const auto right = neighbour(index, {1, 0}), down = neighbour(index, {0, 1});
    if (!right || !down) return {};
    const glm::dvec2 here = at[std::size_t(index)]->pixel, origin(board[std::size_t(index)]);
    const glm::dmat2 pixels(at[*right]->pixel - here, at[*down]->pixel - here);
    return pixels *
           glm::inverse(glm::dmat2(glm::dvec2(board[*right]) - origin, glm::dvec2(board[*down]) - origin));
  }
};

/// The picture around a point, by board coordinates relative to it.
struct Around {
  const cv::Mat& picture;
  glm::dvec2 pixel;
  glm::dmat2 picture_from_board;
  double operator()(const glm::dvec2& x_board) const {
    const glm::dvec2 at = pixel + picture_from_board * x_board;
    return value_at(picture, cv::Point2f(float(at.x), float(at.y)));
  }
};

// The four squares around a corner, beside the markers where there are any.
bool is_corner_evenly_lit(const Around& around, const PrintedBoard& board) {
  const double d = board.spacing_m * std::min(0.3, (1 - board.mark_m / board.spacing_m) / 3);
  const double a = around({d, d}), b = around({-d, d}), c = around({-d, -d}), e = around({d, -d});
  const double contrast = std::abs(a + c - b - e) / 2;
  return alike(a, c, contrast) && alike(b, e, contrast);
}

// A ring of paper around a circle, halfway to where the next may begin.
bool is_circle_evenly_lit(const Around& around, const PrintedBoard& board) {
  constexpr int samples = 16;
  const double nearest =
      board.spacing_m * (board.kind == BoardKind::asymmetric_circles ? std::sqrt(2.0) : 1.0);
  double low = 255, high = 0;
  for (int k = 0; k < samples; ++k) {
    const double angle = 2 * CV_PI * k / samples;
    const double value = around(nearest / 2 * glm::dvec2(std::cos(angle), std::sin(angle)));
    low = std::min(low, value), high = std::max(high, value);
  }
  return alike(low, high, high - around(glm::dvec2(0.0)));
}

std::vector<FoundPoint> evenly_lit(const cv::Mat& picture, const PrintedBoard& board,
                                   const std::vector<FoundPoint>& found) {
  const Grid grid(found, board);
  const bool circles = board.kind == BoardKind::circles || board.kind == BoardKind::asymmetric_circles;
  std::vector<FoundPoint> kept;
  for (const FoundPoint& p : found) {
    const auto map = grid.picture_from_board(p.index);
    if (!map) continue;
    const Around around{picture, p.pixel, *map};
    if (circles ? is_circle_evenly_lit(around, board) : is_corner_evenly_lit(around, board))
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
  const std::vector<FoundPoint> lit = evenly_lit(view, board, found);
  const bool whole = board.kind != BoardKind::charuco;
  return whole && 2 * lit.size() < found.size() ? std::vector<FoundPoint>{} : lit;
}

void stretch(Image<float>& picture) {
  const float most =
      picture.values.empty() ? 0 : *std::max_element(picture.values.begin(), picture.values.end());
  if (most > 0)
    for (float& value : picture.values) value /= most;
}

template <class T>
PrintPicture mean_and_darkest(const ImageStack<T>& stack) {
  PrintPicture picture{Image<float>(stack.width, stack.height),
                       Image<float>(stack.width, stack.height, 65535.0f)};
  for (int k = 0; k < stack.count; ++k) {
    for (std::size_t i = 0; i < stack.picture_size(); ++i) {
      const auto value = float(stack.picture(k)[i]);
      picture.mean.values[i] += value;
      picture.darkest.values[i] = std::min(picture.darkest.values[i], value);
    }
  }
  stretch(picture.mean), stretch(picture.darkest);
  return picture;
}

}  // namespace

std::vector<FoundPoint> find_board(const PrintPicture& picture, const PrintedBoard& board) {
  if (picture.mean.values.empty()) return {};
  const auto linear = [](double v) { return v; };
  const auto logarithm = [](double v) { return std::log1p(500 * v) / std::log1p(500.0); };
  std::vector<FoundPoint> found = find_any(bytes_of(picture.mean, linear), board);
  if (found.size() < 4) found = find_any(bytes_of(picture.mean, logarithm), board);
  if (found.size() < 4 && !picture.darkest.values.empty())
    found = find_any(bytes_of(picture.darkest, linear), board);
  if (found.size() < 4) found.clear();
  return found;
}

void cover_board(PrintPicture& picture, const std::vector<FoundPoint>& found) {
  if (found.empty() || picture.mean.values.empty()) return;
  glm::dvec2 centre(0.0);
  for (const FoundPoint& p : found) centre += p.pixel / double(found.size());
  Points corners, hull;
  for (const FoundPoint& p : found) {
    const glm::dvec2 outwards = centre + 1.5 * (p.pixel - centre);
    corners.emplace_back(float(outwards.x), float(outwards.y));
  }
  cv::convexHull(corners, hull);
  const std::vector<cv::Point> polygon(hull.begin(), hull.end());
  for (Image<float>* image : {&picture.mean, &picture.darkest}) {
    if (image->values.empty()) continue;
    std::vector<double> values;
    for (const FoundPoint& p : found) values.push_back((*image)(int(p.pixel.x), int(p.pixel.y)));
    cv::fillConvexPoly(cv::Mat(image->height, image->width, CV_32FC1, image->values.data()), polygon,
                       cv::Scalar(median(values)));
  }
}

PrintPicture print_picture(const CapturedStack& stack) {
  return std::visit([](const auto& s) { return mean_and_darkest(s); }, stack);
}

}  // namespace laterna
