// Board sightings of any number of devices as comma-separated text, one sighting a line.
#pragma once

#include "calib/boards/board_capture.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace laterna {

/// Whether a table names a column `device`: one sighting a line, and not a camera's and a projector's beside
/// each other (correspondence_csv.h).
bool is_sighting_csv(std::string_view text);

/// Reads a table with the columns device, pose, corner, board_x, board_y, board_z, x, y and, where it is
/// there, sigma_px (else 1), as correspondence_csv.h reads its own. `devices` name what may stand under
/// `device`, the first being the rig's. Throws InputError as there, for a device that is not among them, and
/// for a corner that comes twice in one device's pose.
BoardCapture parse_sighting_csv(std::string_view text, const std::string& file_name,
                                const std::vector<BoardDevice>& devices);

/// The table of a capture, numbers to the last bit; parse_sighting_csv() of it, with the same devices, has
/// the same sightings. What links a projector's pixel to the camera's at which it was read is lost.
std::string sighting_csv(const BoardCapture& capture);

}  // namespace laterna
