// Board correspondences of a camera and a projector as comma-separated text.
#pragma once

#include "calib/boards/board_capture.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace laterna {

/// Reads a table with the columns pose, corner, board_x, board_y, board_z, cam_x, cam_y, proj_x, proj_y,
/// valid, named in its first line, in any order; other columns are passed over, and so are empty lines.
///
/// pose and corner are whole numbers from 0; board coordinates are in any one unit of length; pixels have
/// integer coordinates at pixel centres. valid is 1 where the projector's pixel was decoded; with 0, proj_x
/// and proj_y do not count, and the corner still counts for the camera. Both camera coordinates empty or nan:
/// the camera does not see the corner. Device 0 of the result is "camera", device 1 "projector"; poses are
/// sorted by number, sigmas are 1.
///
/// Throws InputError, beginning with the file and the line, for text that check_text() refuses, a missing or
/// repeated column, a wrong number of cells, a cell that is no such number, a corner that comes twice in a
/// pose, or what validate() refuses.
BoardCapture parse_correspondence_csv(std::string_view text, const std::string& file_name,
                                      glm::ivec2 camera_size, glm::ivec2 projector_size);

/// The same from a file of at most 256 MiB.
BoardCapture read_correspondence_csv(const std::filesystem::path& path, glm::ivec2 camera_size,
                                     glm::ivec2 projector_size);

/// The table of a capture by one camera and one projector, numbers to the last bit; where the projector has
/// not sighted a corner, valid is 0. parse_correspondence_csv() of it has the same sightings (sigmas but 1,
/// and corners that only the projector sights, are lost). Throws InputError for another number of devices.
std::string correspondence_csv(const BoardCapture& capture);

}  // namespace laterna
