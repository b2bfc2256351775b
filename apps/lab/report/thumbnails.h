// Small pictures of large ones, as bytes that a page can hold.
#pragma once

#include "calib/decoded_map.h"
#include "sim/image.h"
#include "sim/pattern_sequence.h"

#include <glm/glm.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace laterna {

/// Every picture of a stack, shrunk by whole boxes to at most `width_px` columns, 0 to 255 of `full_scale`.
/// Each box gives its mean; boxes that stick out over the edge give the mean of what is inside.
std::vector<Image<std::uint8_t>> thumbnails(const CapturedStack& stack, int full_scale, int width_px = 384);

/// picture_name() of every picture of a sequence; "picture 3" for those that come from files.
std::vector<std::string> frame_labels(const PatternSequence& sequence, int count);

/// A map in viridis from `low` to `high`, shrunk to at most `width_px` columns by taking the middle pixel of
/// each box; values that are not finite are grey.
Image<glm::u8vec3> map_picture(const Image<double>& map, double low, double high, int width_px = 512);

/// "data:image/png;base64,..." of a picture.
std::string data_uri(const Image<std::uint8_t>& picture);
std::string data_uri(const Image<glm::u8vec3>& picture);

/// The same of a PNG file. Throws InputError where it cannot be read or has more than 64 MB.
std::string data_uri_of_file(const std::string& path);

/// RFC 4648, with padding.
std::string base64(std::string_view bytes);

/// The bytes that data_uri() encoded. Throws InputError where the text is none of its.
std::string bytes_of_data_uri(std::string_view uri);

}  // namespace laterna
