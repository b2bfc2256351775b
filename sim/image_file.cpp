#include "sim/image_file.h"

#include "sim/error.h"
#include "sim/safe_write.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <array>
#include <memory>
#include <set>

namespace laterna {

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t most_pixels = std::int64_t{1} << 30;

/// Threads are started in sim/parallel.h alone: OpenImageIO gets none of its own.
void start_oiio() {
  static const bool started = OIIO::attribute("threads", 1) && OIIO::attribute("exr_threads", -1);
  (void)started;
}

[[noreturn]] void refuse(const fs::path& path, const std::string& reason) {
  throw InputError(fmt::format("{}: {}", path.string(), reason));
}

/// The first line of a library's message, or a word where it has none.
std::string first_line(const std::string& message) {
  return message.empty() ? "it ends too early" : message.substr(0, message.find('\n'));
}

// ---- writing

struct Format {
  const char* extension;
  bool holds_bytes, holds_words, holds_floats, holds_layers;
};

constexpr std::array<Format, 7> formats{
    {{".png", true, true, false, false},
     {".tif", true, true, true, false},
     {".tiff", true, true, true, false},
     {".pgm", true, false, false, false},  // OpenImageIO 2.4 cuts 16 bits to 8
     {".ppm", true, false, false, false},
     {".pnm", true, false, false, false},
     {".exr", false, false, true, true}}};

const Format& format_of(const fs::path& path) {
  for (const Format& format : formats)
    if (path.extension() == format.extension) return format;
  refuse(path, fmt::format("its extension is \"{}\", expected .png, .tif, .pgm or .exr",
                           path.extension().string()));
}

OIIO::TypeDesc type_of(PixelType type) {
  if (type == PixelType::f32) return OIIO::TypeFloat;
  return type == PixelType::u8 ? OIIO::TypeUInt8 : OIIO::TypeUInt16;
}

/// Throws where the format of `path` does not hold the picture.
void validate(const fs::path& path, const PictureView& picture) {
  const Format& format = format_of(path);
  if (picture.data == nullptr || picture.width < 1 || picture.height < 1 || picture.channels < 1)
    refuse(path, "the picture to be written is empty, expected pixels");
  if (picture.type == PixelType::f32 && !format.holds_floats)
    refuse(path, fmt::format("the picture to be written holds floats, {} does not; expected .exr or .tif",
                             format.extension));
  if (picture.type == PixelType::u8 && !format.holds_bytes)
    refuse(path,
           fmt::format("the picture to be written holds integers, {} does not; expected .png, .tif or .pgm",
                       format.extension));
  if (picture.type == PixelType::u16 && !format.holds_words)
    refuse(path,
           fmt::format("the picture to be written holds 16-bit integers, {} does not; expected .png or .tif",
                       format.extension));
  if (!format.holds_layers && picture.channels != 1 && picture.channels != 3)
    refuse(path, fmt::format("the picture to be written has {} channels, expected 1 or 3", picture.channels));
  const std::set<std::string> names(picture.channel_names.begin(), picture.channel_names.end());
  const bool named = names.size() == std::size_t(picture.channels) && !names.contains("");
  if (!picture.channel_names.empty() && !(named && names.size() == picture.channel_names.size()))
    refuse(path, "the names of the channels are empty, repeated or not one each, expected different names");
}

OIIO::ImageSpec spec_of(const PictureView& picture, const Format& format) {
  OIIO::ImageSpec spec(picture.width, picture.height, picture.channels, type_of(picture.type));
  if (!picture.channel_names.empty()) spec.channelnames = picture.channel_names;
  spec.alpha_channel = spec.z_channel = -1;
  spec.attribute("png:compressionLevel", 1);
  spec.attribute("compression", format.holds_layers ? "zip" : "none");
  spec.attribute("DateTime", "1970:01:01 00:00:00");  // not the clock's: the same picture is the same bytes
  spec.attribute("tiff:write_exif", 0);  // there is none, and OpenImageIO 2.4 takes that for an error
  return spec;
}

/// The bytes of the file, made in memory so that write_file alone meets the disk.
std::vector<unsigned char> encode(const fs::path& path, const PictureView& picture) {
  start_oiio();
  const auto output = OIIO::ImageOutput::create(path.string());
  if (!output) refuse(path, first_line(OIIO::geterror()));
  const OIIO::ImageSpec spec = spec_of(picture, format_of(path));
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput sink(bytes);
  const bool written = output->set_ioproxy(&sink) && output->open(path.string(), spec) &&
                       output->write_image(type_of(picture.type), picture.data);
  if (!output->close() || !written || output->has_error() || bytes.empty())
    refuse(path, "cannot be encoded: " + first_line(output->geterror()));
  return bytes;
}

template <class T>
PictureView view_of(const Image<T>& image, int channels, PixelType type) {
  return {image.values.data(), image.width, image.height, channels, type, {}};
}

// ---- reading

/// No file holds more values than this per byte: deflate packs 1032 bytes into one.
std::int64_t most_values(const std::string& format, std::int64_t file_bytes) {
  return (format == "pnm" ? 8 : 1100) * file_bytes;
}

/// Throws where the header claims what cannot be; before anything is allocated.
void validate(const fs::path& path, const OIIO::ImageInput& input) {
  const OIIO::ImageSpec& spec = input.spec();
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1 || spec.depth > 1)
    refuse(path, fmt::format("its header claims {}×{} pixels of {} channels, expected a picture", spec.width,
                             spec.height, spec.nchannels));
  const std::int64_t pixels = std::int64_t{spec.width} * spec.height;
  if (pixels > most_pixels)
    refuse(path, fmt::format("its header claims {}×{} pixels, expected at most {}", spec.width, spec.height,
                             most_pixels));
  const auto bytes = static_cast<std::int64_t>(fs::file_size(path));
  if (pixels * spec.nchannels > most_values(input.format_name(), bytes))
    refuse(path,
           fmt::format("its header claims {}×{} pixels of {} channels, more than a file of {} bytes holds",
                       spec.width, spec.height, spec.nchannels, bytes));
}

std::unique_ptr<OIIO::ImageInput> open(const fs::path& path) {
  start_oiio();
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (!fs::exists(status)) refuse(path, "no such file, expected a picture");
  if (!fs::is_regular_file(status)) refuse(path, "is no file, expected a picture");
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);  // colours as they are in the file
  auto input = OIIO::ImageInput::open(path.string(), &config);
  if (!input) refuse(path, "cannot be read as a picture: " + first_line(OIIO::geterror()));
  validate(path, *input);
  return input;
}

template <class T>
std::vector<T> read_values(const fs::path& path, OIIO::ImageInput& input) {
  const OIIO::ImageSpec spec = input.spec();
  std::vector<T> values(std::size_t(spec.width) * spec.height * spec.nchannels);
  const bool read = input.read_image(0, 0, 0, spec.nchannels, OIIO::BaseTypeFromC<T>::value, values.data());
  if (!read || input.has_error())
    refuse(path, "cannot be read as a picture: " + first_line(input.geterror()));
  return values;
}

int bits_of(const OIIO::ImageSpec& spec) {
  return spec.format == OIIO::TypeUInt8 ? 8 : spec.format == OIIO::TypeUInt16 ? 16 : 0;
}

}  // namespace

void write_picture(const fs::path& path, const PictureView& picture) {
  validate(path, picture);
  const std::vector<unsigned char> bytes = encode(path, picture);
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

Picture read_picture(const fs::path& path) {
  const auto input = open(path);
  Picture picture{input->spec().width, input->spec().height, input->spec().channelnames, {}};
  const int bits = bits_of(input->spec());
  if (bits == 8)
    picture.values = read_values<std::uint8_t>(path, *input);
  else if (bits == 16)
    picture.values = read_values<std::uint16_t>(path, *input);
  else
    picture.values = read_values<float>(path, *input);
  return picture;
}

}  // namespace laterna
