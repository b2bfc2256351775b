// What is checked of an OpenEXR file's headers before OpenEXR reads them: it allocates what they claim.
#pragma once

#include <filesystem>

namespace laterna {

/// The most values in one scan line or tile row, over all channels: OpenEXR holds up to 256 lines at a time.
inline constexpr long long most_exr_line_values = 1 << 19;

/// Nothing for a file that does not begin as OpenEXR's do. Throws InputError, naming the path, where a header
/// is cut short; where an attribute claims more bytes than the file has, or another number than its type
/// takes; or where the windows, tiles and channels of a part claim lines of more than most_exr_line_values
/// values, or more pieces than the file's table of them could hold. Layout: "OpenEXR File Layout"
/// (openexr.com): magic, version, then for each part attributes (name, type, 32-bit size, value) up to an
/// empty name.
void check_exr_headers(const std::filesystem::path& path);

}  // namespace laterna
