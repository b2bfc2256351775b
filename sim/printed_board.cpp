#include "sim/printed_board.h"

#include "sim/error.h"

#include <fmt/format.h>
#include <opencv2/aruco/charuco.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace laterna {

namespace {

constexpr std::array<std::pair<BoardKind, std::string_view>, 4> kinds{
    {{BoardKind::chessboard, "chessboard"},
     {BoardKind::charuco, "charuco"},
     {BoardKind::circles, "circles"},
     {BoardKind::asymmetric_circles, "acircles"}}};

constexpr std::array<std::pair<int, std::string_view>, 17> dictionaries{
    {{cv::aruco::DICT_4X4_50, "DICT_4X4_50"},
     {cv::aruco::DICT_4X4_100, "DICT_4X4_100"},
     {cv::aruco::DICT_4X4_250, "DICT_4X4_250"},
     {cv::aruco::DICT_4X4_1000, "DICT_4X4_1000"},
     {cv::aruco::DICT_5X5_50, "DICT_5X5_50"},
     {cv::aruco::DICT_5X5_100, "DICT_5X5_100"},
     {cv::aruco::DICT_5X5_250, "DICT_5X5_250"},
     {cv::aruco::DICT_5X5_1000, "DICT_5X5_1000"},
     {cv::aruco::DICT_6X6_50, "DICT_6X6_50"},
     {cv::aruco::DICT_6X6_100, "DICT_6X6_100"},
     {cv::aruco::DICT_6X6_250, "DICT_6X6_250"},
     {cv::aruco::DICT_6X6_1000, "DICT_6X6_1000"},
     {cv::aruco::DICT_7X7_50, "DICT_7X7_50"},
     {cv::aruco::DICT_7X7_100, "DICT_7X7_100"},
     {cv::aruco::DICT_7X7_250, "DICT_7X7_250"},
     {cv::aruco::DICT_7X7_1000, "DICT_7X7_1000"},
     {cv::aruco::DICT_ARUCO_ORIGINAL, "DICT_ARUCO_ORIGINAL"}}};

constexpr const char* forms =
    "chessboard,9x7,75mm or charuco,8x6,40mm,30mm,DICT_4X4_50 or circles,7x5,30mm,15mm or "
    "acircles,4x11,20mm,15mm";

std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    words.push_back(text.substr(at, comma - at));
    at = comma + 1;
  }
  return words;
}

// A number at the front of a word; the rest stays in it.
template <class Number>
bool take(std::string_view& word, Number& number) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc{}) return false;
  word.remove_prefix(std::size_t(end - word.data()));
  return true;
}

glm::ivec2 parse_count(std::string_view word) {
  glm::ivec2 count;
  std::string_view rest = word;
  const bool ok =
      take(rest, count.x) && rest.starts_with('x') && (rest.remove_prefix(1), take(rest, count.y));
  if (!ok || !rest.empty() || count.x < 2 || count.y < 2 || count.x > 200 || count.y > 200)
    throw InputError(
        fmt::format("board: \"{}\", expected columns and rows such as 9x7, from 2 to 200", word));
  return count;
}

double parse_length_m(std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, double>, 4> units{
      {{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1}, {"in", 0.0254}}};
  double length = 0;
  std::string_view rest = word;
  if (take(rest, length) && length > 0 && length <= 1e6)
    for (const auto& [unit, metres] : units)
      if (rest == unit) return length * metres;
  throw InputError(fmt::format("board: \"{}\", expected a length such as 75mm (mm, cm, m or in)", word));
}

void check(const PrintedBoard& board, std::string_view text) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("board \"{}\": {}", text, what));
  };
  const glm::ivec2 points = point_count(board);
  if (board.kind == BoardKind::charuco) {
    const int markers = board.count.x * board.count.y / 2;
    const int known = cv::aruco::getPredefinedDictionary(dictionary_id(board.dictionary))->bytesList.rows;
    if (markers > known) refuse(fmt::format("{} markers, but {} has {}", markers, board.dictionary, known));
    if (points.x < 2 || points.y < 2) refuse("expected at least 3x3 squares");
  } else if (points.x < 3 || points.y < 3) {
    refuse("expected at least 3 points in a row and in a column");
  }
  const double most = board.kind == BoardKind::asymmetric_circles ? std::sqrt(2.0) : 1.0;
  if (board.mark_m >= most * board.spacing_m)
    refuse(fmt::format("marks of {} m do not fit at a distance of {} m", board.mark_m, board.spacing_m));
}

// Pixels of the print per metre: 64 to a square, at most 4096 in all.
double pixels_per_metre(const PrintedBoard& board) {
  const glm::dvec2 size = board_size_m(board) / board.spacing_m;
  return std::floor(std::min(64.0, 4096 / std::max(size.x, size.y))) / board.spacing_m;
}

// From the print's upper left corner to the first point.
glm::dvec2 first_point_m(const PrintedBoard& board) {
  const bool squares = board.kind == BoardKind::chessboard || board.kind == BoardKind::charuco;
  return glm::dvec2((squares ? 2.0 : 1.5) * board.spacing_m);
}

void draw_squares(const PrintedBoard& board, int square_px, Image<float>& print) {
  const glm::ivec2 squares = point_count(board) + 1;
  for (int y = 0; y < squares.y * square_px; ++y)
    for (int x = 0; x < squares.x * square_px; ++x)
      if ((x / square_px + y / square_px) % 2 == 0) print(x + square_px, y + square_px) = 0;
}

void draw_charuco(const PrintedBoard& board, int square_px, Image<float>& print) {
  cv::Mat drawn;
  cv::aruco::CharucoBoard::create(board.count.x, board.count.y, float(board.spacing_m), float(board.mark_m),
                                  cv::aruco::getPredefinedDictionary(dictionary_id(board.dictionary)))
      ->draw({board.count.x * square_px, board.count.y * square_px}, drawn);
  for (int y = 0; y < drawn.rows; ++y)
    for (int x = 0; x < drawn.cols; ++x)
      print(x + square_px, y + square_px) = float(drawn.at<std::uint8_t>(y, x)) / 255;
}

void draw_circles(const PrintedBoard& board, double per_metre, Image<float>& print) {
  const double radius = board.mark_m / 2 * per_metre;
  const int reach = int(radius) + 2;
  for (const glm::dvec3& point : board_points(board)) {
    const glm::dvec2 centre = (first_point_m(board) + glm::dvec2(point)) * per_metre - 0.5;
    const glm::ivec2 middle(glm::round(centre));
    for (int y = middle.y - reach; y <= middle.y + reach; ++y)
      for (int x = middle.x - reach; x <= middle.x + reach; ++x)
        if (x >= 0 && y >= 0 && x < print.width && y < print.height)
          print(x, y) =
              std::min(print(x, y),
                       float(std::clamp(glm::distance(glm::dvec2(x, y), centre) - radius + 0.5, 0.0, 1.0)));
  }
}

}  // namespace

int dictionary_id(const std::string& name) {
  const auto* found = std::find_if(dictionaries.begin(), dictionaries.end(),
                                   [&](const auto& entry) { return entry.second == name; });
  if (found == dictionaries.end())
    throw InputError(
        fmt::format("board: no dictionary \"{}\", expected OpenCV's name such as DICT_5X5_100", name));
  return found->first;
}

PrintedBoard parse_board(std::string_view text) {
  const std::vector<std::string_view> words = split(text);
  const auto* kind =
      std::find_if(kinds.begin(), kinds.end(), [&](const auto& entry) { return entry.second == words[0]; });
  const bool charuco = kind != kinds.end() && kind->first == BoardKind::charuco;
  const std::size_t expected = kind == kinds.end() ? 0 : kind->first == BoardKind::chessboard ? 3 : 4;
  if (kind == kinds.end() || (words.size() != expected && !(charuco && words.size() == 5)))
    throw InputError(fmt::format("board \"{}\", expected {}", text, forms));
  PrintedBoard board{kind->first, parse_count(words[1]), parse_length_m(words[2])};
  if (expected == 4) board.mark_m = parse_length_m(words[3]);
  if (charuco) board.dictionary = words.size() == 5 ? std::string(words[4]) : "DICT_4X4_1000";
  check(board, text);
  return board;
}

std::string board_words(const PrintedBoard& board) {
  const auto* kind =
      std::find_if(kinds.begin(), kinds.end(), [&](const auto& entry) { return entry.first == board.kind; });
  std::string words =
      fmt::format("{},{}x{},{}m", kind->second, board.count.x, board.count.y, board.spacing_m);
  if (board.kind != BoardKind::chessboard) words += fmt::format(",{}m", board.mark_m);
  return board.kind == BoardKind::charuco ? words + "," + board.dictionary : words;
}

glm::ivec2 point_count(const PrintedBoard& board) {
  return board.kind == BoardKind::charuco ? board.count - 1 : board.count;
}

std::vector<glm::dvec3> board_points(const PrintedBoard& board) {
  const glm::ivec2 count = point_count(board);
  const bool shifted = board.kind == BoardKind::asymmetric_circles;
  std::vector<glm::dvec3> points;
  for (int j = 0; j < count.y; ++j)
    for (int i = 0; i < count.x; ++i)
      points.emplace_back(board.spacing_m * (shifted ? 2 * i + j % 2 : i), board.spacing_m * j, 0.0);
  return points;
}

bool is_symmetric(const PrintedBoard& board) {
  switch (board.kind) {
    case BoardKind::chessboard:
      return (board.count.x + board.count.y) % 2 == 0;
    case BoardKind::charuco:
      return false;
    case BoardKind::circles:
      return true;
    case BoardKind::asymmetric_circles:
      return board.count.y % 2 == 0;
  }
  return true;
}

glm::dvec2 board_size_m(const PrintedBoard& board) {
  glm::dvec2 last(0.0);
  for (const glm::dvec3& point : board_points(board)) last = glm::max(last, glm::dvec2(point));
  return last + 2.0 * first_point_m(board);
}

Image<float> board_print(const PrintedBoard& board) {
  const double per_metre = pixels_per_metre(board);
  const glm::ivec2 size(glm::round(board_size_m(board) * per_metre));
  Image<float> print(size.x, size.y, 1.0f);
  const int square_px = int(std::lround(board.spacing_m * per_metre));
  if (board.kind == BoardKind::chessboard)
    draw_squares(board, square_px, print);
  else if (board.kind == BoardKind::charuco)
    draw_charuco(board, square_px, print);
  else
    draw_circles(board, per_metre, print);
  return print;
}

}  // namespace laterna
