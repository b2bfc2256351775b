// The module laterna_pictures.so: all that meets OpenImageIO.
#include "sim/codec/exr_header.h"
#include "sim/error.h"
#include "sim/image_codec.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <cstring>
#include <memory>

namespace laterna {

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t most_pixels = std::int64_t{1} << 30;

/// Threads are started in sim/parallel.h alone: OpenImageIO gets none of its own. A file is what its ending
/// says: bytes that are not are refused by one reader, and not shown to all of them.
void start_oiio() {
  static const bool started = OIIO::attribute("threads", 1) && OIIO::attribute("exr_threads", -1) &&
                              OIIO::attribute("try_all_readers", 0);
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

OIIO::TypeDesc type_of(PixelType type) {
  if (type == PixelType::f32) return OIIO::TypeFloat;
  return type == PixelType::u8 ? OIIO::TypeUInt8 : OIIO::TypeUInt16;
}

/// EXR has no small integers: whole numbers up to 2048 are exact in half precision, those up to 2²⁴ in
/// single.
OIIO::TypeDesc file_type_of(PixelType type, bool is_exr) {
  if (!is_exr) return type_of(type);
  return type == PixelType::u8 ? OIIO::TypeHalf : OIIO::TypeFloat;
}

// OpenImageIO's names of the header's cameraLabel, worldToCamera and worldToNDC.
constexpr const char *label_name = "cameraLabel", *camera_name = "worldtocamera", *window_name = "worldtoNDC";

/// GLM holds column vectors' matrices column by column, the file row vectors' row by row: the same numbers.
void add_camera(OIIO::ImageSpec& spec, const PictureCamera& camera) {
  if (!camera.name.empty()) spec.attribute(label_name, camera.name);
  if (camera.camera_from_world)
    spec.attribute(camera_name, OIIO::TypeMatrix, &(*camera.camera_from_world)[0][0]);
  if (camera.window_from_world)
    spec.attribute(window_name, OIIO::TypeMatrix, &(*camera.window_from_world)[0][0]);
}

OIIO::ImageSpec spec_of(const PictureView& picture, const fs::path& extension) {
  const bool is_exr = extension == ".exr", is_png = extension == ".png";
  const char* compression = is_exr ? "zip" : is_png ? "rle" : "none";
  OIIO::ImageSpec spec(picture.width, picture.height, picture.channels, file_type_of(picture.type, is_exr));
  if (!picture.channel_names.empty()) spec.channelnames = picture.channel_names;
  spec.alpha_channel = spec.z_channel = -1;
  if (is_exr) add_camera(spec, picture.camera);
  if (is_exr && picture.window.x > 0) spec.full_width = picture.window.x, spec.full_height = picture.window.y;
  spec.attribute("compression", compression);
  // A format's own word only to that format: the OpenEXR writer keeps others' in its header, unless something
  // in this process has made OpenImageIO list its formats before.
  if (is_png) {
    spec.attribute("png:compressionLevel", 1);
    constexpr int row_above = 32;  // subtracted: faster than choosing, and smaller on patterns
    spec.attribute("png:filter", row_above);
  }
  if (extension == ".tif" || extension == ".tiff")
    spec.attribute("tiff:write_exif", 0);  // there is none, and OpenImageIO 2.4 takes that for an error
  spec.attribute("DateTime", "1970:01:01 00:00:00");  // not the clock's: the same picture is the same bytes
  return spec;
}

std::size_t values_in(const PictureView& picture) {
  return std::size_t(picture.width) * picture.height * picture.channels;
}

/// The numbers themselves, where OpenImageIO would scale integers to [0, 1] on their way to floats.
template <class T>
std::vector<float> whole_numbers(const PictureView& picture) {
  const auto* values = static_cast<const T*>(picture.data);
  return {values, values + values_in(picture)};
}

bool write_values(OIIO::ImageOutput& output, const PictureView& picture, bool is_exr) {
  if (!is_exr || picture.type == PixelType::f32)
    return output.write_image(type_of(picture.type), picture.data);
  const std::vector<float> values = picture.type == PixelType::u8 ? whole_numbers<std::uint8_t>(picture)
                                                                  : whole_numbers<std::uint16_t>(picture);
  return output.write_image(OIIO::TypeFloat, values.data());
}

std::unique_ptr<OIIO::ImageOutput> create(const fs::path& path, const std::string& format) {
  start_oiio();
  auto output = OIIO::ImageOutput::create(format);
  if (!output) refuse(path, first_line(OIIO::geterror()));
  return output;
}

/// OpenImageIO writes these byte by byte: 20 times slower.
std::vector<unsigned char> encode_pnm(const PictureView& picture) {
  const std::string header =
      fmt::format("{}\n{} {}\n255\n", picture.channels == 1 ? "P5" : "P6", picture.width, picture.height);
  const auto* values = static_cast<const unsigned char*>(picture.data);
  std::vector<unsigned char> bytes(header.begin(), header.end());
  bytes.insert(bytes.end(), values, values + values_in(picture));
  return bytes;
}

std::vector<unsigned char> encode(const fs::path& path, const PictureView& picture) {
  const fs::path extension = path.extension();
  if (extension == ".pgm" || extension == ".ppm" || extension == ".pnm") return encode_pnm(picture);
  const auto output = create(path, path.string());
  const OIIO::ImageSpec spec = spec_of(picture, extension);
  std::vector<unsigned char> bytes;
  bytes.reserve(values_in(picture) * sizeof(float) + 4096);
  OIIO::Filesystem::IOVecOutput sink(bytes);
  const bool written = output->set_ioproxy(&sink) && output->open(path.string(), spec) &&
                       write_values(*output, picture, extension == ".exr");
  if (!output->close() || !written || output->has_error() || bytes.empty())
    refuse(path, "cannot be encoded: " + first_line(output->geterror()));
  return bytes;
}

// ---- reading

/// No file holds more values than this per byte: deflate packs 1032 bytes into one.
std::int64_t most_values(const std::string& format, std::int64_t file_bytes) {
  return (format == "pnm" ? 8 : 1100) * file_bytes;
}

/// Throws where a page's header claims what cannot be, before anything is allocated. Gives its values' count.
std::int64_t validate(const fs::path& path, const OIIO::ImageInput& input) {
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
  return pixels * spec.nchannels;
}

/// The reader of a format, opened; where none is named, that of the path's ending.
std::unique_ptr<OIIO::ImageInput> open(const fs::path& path, const std::string& format = {}) {
  start_oiio();
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (!fs::exists(status)) refuse(path, "no such file, expected a picture");
  if (!fs::is_regular_file(status)) refuse(path, "is no file, expected a picture");
  check_exr_headers(path);
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);  // colours as they are in the file
  auto input = OIIO::ImageInput::create(format.empty() ? path.string() : format, false);
  OIIO::ImageSpec ignored_spec;
  if (!input || !input->open(path.string(), ignored_spec, config))
    refuse(path, "cannot be read as a picture: " + first_line(input ? input->geterror() : OIIO::geterror()));
  return input;
}

/// In the file's own type, then converted: where it is told a type, even the file's, OpenImageIO takes 64 MiB
/// to convert in, however small the picture.
template <class T>
std::vector<T> read_values(const fs::path& path, OIIO::ImageInput& input, int page) {
  const OIIO::ImageSpec spec = input.spec();
  const OIIO::TypeDesc wanted = OIIO::BaseTypeFromC<T>::value;
  std::vector<T> values(std::size_t(spec.width) * spec.height * spec.nchannels);
  std::vector<std::byte> own(spec.format == wanted ? 0 : values.size() * spec.format.size());
  void* read_to = own.empty() ? static_cast<void*>(values.data()) : own.data();
  const OIIO::TypeDesc as_it_is = spec.channelformats.empty() ? OIIO::TypeUnknown : spec.format;
  const bool read = input.read_image(page, 0, 0, spec.nchannels, as_it_is, read_to);
  if (!read || input.has_error())
    refuse(path, "cannot be read as a picture: " + first_line(input.geterror()));
  if (!own.empty()) {
    constexpr auto packed = OIIO::AutoStride;
    OIIO::convert_image(spec.nchannels, spec.width, spec.height, 1, own.data(), spec.format, packed, packed,
                        packed, values.data(), wanted, packed, packed, packed);
  }
  return values;
}

std::optional<glm::mat4> matrix_in(const OIIO::ImageSpec& spec, const char* name) {
  const OIIO::ParamValue* found = spec.find_attribute(name, OIIO::TypeMatrix);
  if (found == nullptr) return std::nullopt;
  glm::mat4 matrix;
  std::memcpy(&matrix[0][0], found->data(), sizeof matrix);
  return matrix;
}

PictureCamera camera_in(const OIIO::ImageSpec& spec) {
  return {std::string(spec.get_string_attribute(label_name)), matrix_in(spec, camera_name),
          matrix_in(spec, window_name)};
}

Picture read_page(const fs::path& path, int page, const std::string& format) {
  const auto input = open(path, format);
  if (!input->seek_subimage(page, 0))
    refuse(path, fmt::format("page {} cannot be read: {}", page + 1, first_line(input->geterror())));
  validate(path, *input);
  const OIIO::ImageSpec& spec = input->spec();
  Picture picture{spec.width, spec.height, spec.channelnames, {}, spec.format == OIIO::TypeHalf};
  if (path.extension() == ".exr") picture.camera = camera_in(spec);
  picture.window = {spec.full_width, spec.full_height};
  if (spec.format == OIIO::TypeUInt8)
    picture.values = read_values<std::uint8_t>(path, *input, page);
  else if (spec.format == OIIO::TypeUInt16)
    picture.values = read_values<std::uint16_t>(path, *input, page);
  else
    picture.values = read_values<float>(path, *input, page);
  return picture;
}

Picture read(const fs::path& path, int page) { return read_page(path, page, {}); }

/// Pages may share their bytes in a forged file: all together hold no more values than one could.
int count_pages_of(const fs::path& path, const std::string& format) {
  const auto input = open(path, format);
  const auto bytes = static_cast<std::int64_t>(fs::file_size(path));
  std::int64_t values = 0;
  int pages = 0;
  do {
    values += validate(path, *input);
    if (values > most_values(input->format_name(), bytes))
      refuse(path,
             fmt::format("its first {} pages claim more than a file of {} bytes holds", pages + 1, bytes));
    ++pages;
  } while (input->seek_subimage(pages, 0));
  input->geterror();  // "no such page" is how the count ends
  return pages;
}

int page_count(const fs::path& path) { return count_pages_of(path, {}); }

bool same_values(const Picture& picture, const PictureView& page) {
  return std::visit(
      [&](const auto& values) {
        const std::size_t bytes = values.size() * sizeof(values[0]);
        return picture.width == page.width && picture.height == page.height &&
               int(picture.channel_names.size()) == page.channels &&
               std::memcmp(values.data(), page.data, bytes) == 0;
      },
      picture.values);
}

/// Reads back what was written under a name for the time being; nothing where it is all there.
std::string fault_in(const fs::path& path, const std::vector<PictureView>& pages) {
  try {
    if (const int found = count_pages_of(path, "tiff"); found != int(pages.size()))
      return fmt::format("{} of {} pages arrived; is the disk full?", found, pages.size());
    for (int k = 0; k < int(pages.size()); ++k)
      if (!same_values(read_page(path, k, "tiff"), pages[k]))
        return fmt::format("page {} did not arrive whole; is the disk full?", k + 1);
    return {};
  } catch (const InputError&) {
    return "it cannot be read back; is the disk full?";
  }
}

// OpenImageIO 2.4 loses all pages but the last of a TIFF file in memory; one on disk it continues page by
// page. Where the disk is full it loses pixels without a word: hence the reading back. page.
std::string write_tiff_pages(const fs::path& path, const std::vector<PictureView>& pages) {
  const auto output = create(path, "tiff");
  bool written = true;
  for (std::size_t k = 0; k < pages.size() && written; ++k) {
    const auto mode = k == 0 ? OIIO::ImageOutput::Create : OIIO::ImageOutput::AppendSubimage;
    written = output->open(path.string(), spec_of(pages[k], ".tif"), mode) &&
              write_values(*output, pages[k], false);
  }
  if (!output->close() || !written || output->has_error()) return first_line(output->geterror());
  return fault_in(path, pages);
}

}  // namespace

}  // namespace laterna

extern "C" __attribute__((visibility("default"))) const laterna::ImageCodec* laterna_image_codec() {
  static const laterna::ImageCodec codec{laterna::encode, laterna::write_tiff_pages, laterna::read,
                                         laterna::page_count};
  return &codec;
}
