#include "sim/codec/exr_header.h"

#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>

namespace laterna {

namespace fs = std::filesystem;

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as OpenEXR has them");

constexpr std::uint32_t magic = 20000630, multi_part = 0x1000;
constexpr std::size_t longest_name = 255;
constexpr std::int64_t most_lines_of_a_piece = 256, most_tile_values = std::int64_t{1} << 27;

/// Types whose values OpenEXR reads without a look at the claimed size.
struct FixedType {
  std::string_view name;
  int bytes;
};
constexpr auto fixed_types = std::to_array<FixedType>({{"box2i", 16},
                                                       {"box2f", 16},
                                                       {"chromaticities", 32},
                                                       {"compression", 1},
                                                       {"deepImageState", 1},
                                                       {"double", 8},
                                                       {"envmap", 1},
                                                       {"float", 4},
                                                       {"int", 4},
                                                       {"keycode", 28},
                                                       {"lineOrder", 1},
                                                       {"m33f", 36},
                                                       {"m33d", 72},
                                                       {"m44f", 64},
                                                       {"m44d", 128},
                                                       {"rational", 8},
                                                       {"tiledesc", 9},
                                                       {"timecode", 8},
                                                       {"v2i", 8},
                                                       {"v2f", 8},
                                                       {"v2d", 16},
                                                       {"v3i", 12},
                                                       {"v3f", 12},
                                                       {"v3d", 24}});

/// What one part's header claims, as far as OpenEXR allocates by it.
struct Claim {
  std::int64_t width = 1, height = 1, channels = 0, tile_width = 0, tile_height = 0;
};

class Headers {
 public:
  explicit Headers(const fs::path& path)
      : path_(path), bytes_(std::int64_t(fs::file_size(path))), file_(path, std::ios::binary) {}

  void check() {
    if (bytes_ < 8 || number<std::uint32_t>() != magic) return;
    const bool several = (number<std::uint32_t>() & multi_part) != 0;
    do check_part();
    while (several && file_.peek() != 0);
  }

 private:
  [[noreturn]] void refuse(const std::string& reason) const {
    throw InputError(
        fmt::format("{}: cannot be read as a picture: its OpenEXR header {}", path_.string(), reason));
  }

  template <class T>
  T number() {
    T value{};
    if (!file_.read(reinterpret_cast<char*>(&value), sizeof value)) refuse("is cut short");
    return value;
  }

  std::string name() {
    std::string text;
    for (char c = number<char>(); c != '\0'; c = number<char>()) {
      if (text.size() == longest_name) refuse("has a name of more than 255 letters");
      text += c;
    }
    return text;
  }

  void check_part() {
    Claim claim;
    for (std::string key = name(); !key.empty(); key = name()) {
      const std::string type = name();
      const auto size = number<std::int32_t>();
      const auto begin = std::int64_t(file_.tellg());
      if (size < 0 || size > bytes_ - begin)
        refuse(fmt::format("claims {} bytes for \"{}\", the file has {} more", size, key, bytes_ - begin));
      if (const std::int64_t used = bytes_of(key, type, size, claim); used != size)
        refuse(fmt::format("claims {} bytes for \"{}\", a {} of {} bytes", size, key, type, used));
      file_.seekg(begin + size);
    }
    check(claim);
  }

  /// How many bytes OpenEXR will read as the value, whatever size the file claims for it.
  std::int64_t bytes_of(const std::string& key, const std::string& type, std::int32_t size, Claim& claim) {
    for (const FixedType& fixed : fixed_types)
      if (type == fixed.name) return take(key, type, fixed.bytes, size, claim);
    if (type == "chlist") return channel_list(claim);
    if (type == "stringvector") return string_list(size);
    if (type != "preview") return size;
    if (size < 8) return 8;
    const auto extent = number<std::array<std::uint32_t, 2>>();
    return std::int64_t(8 + 4 * std::min<std::uint64_t>(std::uint64_t{extent[0]} * extent[1], 1u << 31));
  }

  std::int64_t take(const std::string& key, const std::string& type, int bytes, std::int32_t size,
                    Claim& claim) {
    if (bytes != size) return bytes;
    if (type == "box2i" && key == "dataWindow") {
      const auto box = number<std::array<std::int32_t, 4>>();
      claim.width = std::int64_t{box[2]} - box[0] + 1;
      claim.height = std::int64_t{box[3]} - box[1] + 1;
    } else if (type == "tiledesc") {
      const auto tile = number<std::array<std::uint32_t, 2>>();
      claim.tile_width = tile[0], claim.tile_height = tile[1];
    }
    return bytes;
  }

  std::int64_t channel_list(Claim& claim) {
    std::int64_t bytes = 1;
    for (std::string channel = name(); !channel.empty(); channel = name()) {
      number<std::array<char, 16>>();
      bytes += std::int64_t(channel.size()) + 17;
      ++claim.channels;
    }
    return bytes;
  }

  std::int64_t string_list(std::int32_t size) {
    std::int64_t bytes = 0;
    while (bytes < size) {
      const auto length = number<std::int32_t>();
      if (length < 0 || length > size) return bytes + 4 + std::uint32_t(length);
      file_.seekg(length, std::ios::cur);
      bytes += 4 + length;
    }
    return bytes;
  }

  void check(const Claim& claim) const {
    if (claim.width < 1 || claim.height < 1 || claim.channels < 1)
      refuse(fmt::format("claims {}×{} pixels of {} channels, expected a picture", claim.width, claim.height,
                         claim.channels));
    if (claim.width > most_exr_line_values / claim.channels)
      refuse(fmt::format("claims lines of {} pixels of {} channels, expected at most {} values", claim.width,
                         claim.channels, most_exr_line_values));
    const bool tiled = claim.tile_width > 0 && claim.tile_height > 0;
    if (tiled && claim.tile_width * claim.channels > most_tile_values / claim.tile_height)
      refuse(fmt::format("claims tiles of {}×{} pixels of {} channels, expected at most {} values",
                         claim.tile_width, claim.tile_height, claim.channels, most_tile_values));
    // The file's table has eight bytes for each piece: a tile, or up to 256 lines.
    const std::int64_t pieces =
        tiled ? (claim.width / claim.tile_width + 1) * (claim.height / claim.tile_height + 1)
              : claim.height / most_lines_of_a_piece;
    if (pieces > bytes_ / 8 + 1)
      refuse(fmt::format("claims {}×{} pixels in {} pieces, more than a file of {} bytes holds", claim.width,
                         claim.height, pieces, bytes_));
  }

  fs::path path_;
  std::int64_t bytes_;
  std::ifstream file_;
};

}  // namespace

void check_exr_headers(const fs::path& path) { Headers(path).check(); }

}  // namespace laterna
