#include "sim/pattern_board.h"

#include <opencv2/aruco/charuco.hpp>

namespace laterna {

namespace {

Image<std::uint8_t> chessboard(const BoardLayout& layout, const glm::ivec2& size) {
  Image<std::uint8_t> image(size.x, size.y, 255);
  for (int y = 0; y < layout.squares.y * layout.square_px; ++y) {
    for (int x = 0; x < layout.squares.x * layout.square_px; ++x) {
      if ((x / layout.square_px + y / layout.square_px) % 2 == 0)
        image(layout.first_px.x + x, layout.first_px.y + y) = 0;
    }
  }
  return image;
}

Image<std::uint8_t> charuco(const BoardLayout& layout, const glm::ivec2& size) {
  Image<std::uint8_t> image(size.x, size.y, 255);
  cv::Mat all(size.y, size.x, CV_8UC1, image.values.data());
  const cv::Size board_px(layout.squares.x * layout.square_px, layout.squares.y * layout.square_px);
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_1000);
  cv::Mat drawn;
  cv::aruco::CharucoBoard::create(layout.squares.x, layout.squares.y, 1, 0.75f, dictionary)
      ->draw(board_px, drawn);
  drawn.copyTo(all(cv::Rect({layout.first_px.x, layout.first_px.y}, board_px)));
  return image;
}

}  // namespace

BoardLayout board_layout(const PatternSequence& sequence) {
  const glm::ivec2 size = sequence.projector_size;
  const int square = sequence.parameters.square_px;
  glm::ivec2 squares = size / square - 1;
  if ((squares.x + squares.y) % 2 == 0) --squares.x;
  return {squares, (size - squares * square) / 2, square};
}

Image<std::uint8_t> board_picture(const PatternSequence& sequence) {
  const BoardLayout layout = board_layout(sequence);
  return sequence.parameters.kind == PatternKind::charuco ? charuco(layout, sequence.projector_size)
                                                          : chessboard(layout, sequence.projector_size);
}

}  // namespace laterna
