#include "sim/image_file.h"

#include "sim/error.h"
#include "sim/image_codec.h"
#include "sim/safe_write.h"

#include <fmt/format.h>

#include <array>
#include <set>

namespace laterna {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const fs::path& path, const std::string& reason) {
  throw InputError(fmt::format("{}: {}", path.string(), reason));
}

struct Format {
  const char* extension;
  bool holds_words, holds_floats, holds_layers;
};

constexpr std::array<Format, 8> formats{{{".png", true, false, false},
                                         {".tif", true, true, false},
                                         {".tiff", true, true, false},
                                         {".pgm", false, false, false},  // OpenImageIO 2.4 cuts 16 bits to 8
                                         {".ppm", false, false, false},
                                         {".pnm", false, false, false},
                                         {".bmp", false, false, false},
                                         {".exr", true, true, true}}};

const Format& format_of(const fs::path& path) {
  for (const Format& format : formats)
    if (path.extension() == format.extension) return format;
  refuse(path, fmt::format("its extension is \"{}\", expected .png, .tif, .pgm or .exr",
                           path.extension().string()));
}

/// Throws where the format of `path` does not hold the picture.
void validate(const fs::path& path, const PictureView& picture) {
  const Format& format = format_of(path);
  if (picture.data == nullptr || picture.width < 1 || picture.height < 1 || picture.channels < 1)
    refuse(path, "the picture to be written is empty, expected pixels");
  if (picture.type == PixelType::f32 && !format.holds_floats)
    refuse(path, fmt::format("the picture to be written holds floats, {} does not; expected .exr or .tif",
                             format.extension));
  if (picture.type == PixelType::u16 && !format.holds_words)
    refuse(path,
           fmt::format(
               "the picture to be written holds 16-bit integers, {} does not; expected .png, .tif or .exr",
               format.extension));
  if (!format.holds_layers && picture.channels != 1 && picture.channels != 3)
    refuse(path, fmt::format("the picture to be written has {} channels, expected 1 or 3", picture.channels));
  const std::set<std::string> names(picture.channel_names.begin(), picture.channel_names.end());
  const bool named = names.size() == std::size_t(picture.channels) && !names.contains("");
  if (!picture.channel_names.empty() && !(named && names.size() == picture.channel_names.size()))
    refuse(path, "the names of the channels are empty, repeated or not one each, expected different names");
}

int value_bytes(PixelType type) { return type == PixelType::u8 ? 1 : type == PixelType::u16 ? 2 : 4; }

template <class T>
PictureView view_of(const Image<T>& image, int channels, PixelType type) {
  return {image.values.data(), image.width, image.height, channels, type, {}};
}

}  // namespace

void write_picture(const fs::path& path, const PictureView& picture) {
  validate(path, picture);
  const std::vector<unsigned char> bytes = image_codec().encode(path, picture);
  write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

void write_picture(const fs::path& path, const Image<std::uint8_t>& image) {
  write_picture(path, view_of(image, 1, PixelType::u8));
}
void write_picture(const fs::path& path, const Image<std::uint16_t>& image) {
  write_picture(path, view_of(image, 1, PixelType::u16));
}
void write_picture(const fs::path& path, const Image<float>& image) {
  write_picture(path, view_of(image, 1, PixelType::f32));
}
void write_picture(const fs::path& path, const Image<glm::u8vec3>& rgb) {
  write_picture(path, view_of(rgb, 3, PixelType::u8));
}
void write_picture(const fs::path& path, const Image<glm::u16vec3>& rgb) {
  write_picture(path, view_of(rgb, 3, PixelType::u16));
}
void write_picture(const fs::path& path, const Image<glm::vec3>& rgb) {
  write_picture(path, view_of(rgb, 3, PixelType::f32));
}

void write_pages(const fs::path& path, const std::vector<PictureView>& pages) {
  if (path.extension() != ".tif" && path.extension() != ".tiff")
    refuse(path, fmt::format("its extension is \"{}\", expected .tif for several pages",
                             path.extension().string()));
  if (pages.empty()) refuse(path, "there are no pages to be written, expected at least one");
  constexpr double most_bytes = 4e9;  // TIFF counts bytes in 32 bits
  double bytes = 0;
  for (const PictureView& page : pages) {
    validate(path, page);
    bytes += double(page.width) * page.height * page.channels * value_bytes(page.type);
  }
  if (bytes > most_bytes)
    refuse(path, fmt::format("the pages hold {:.3g} GB, more than a TIFF file; expected one file each",
                             bytes / 1e9));
  write_file(path, [&](const fs::path& temporary) {
    const std::string fault = image_codec().write_tiff_pages(temporary, pages);
    if (!fault.empty()) refuse(path, "cannot be written: " + fault);
  });
}

Picture read_picture(const fs::path& path, int page) { return image_codec().read(path, page); }

int count_pages(const fs::path& path) { return image_codec().page_count(path); }

}  // namespace laterna
