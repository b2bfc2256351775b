// Picture files: the one place that writes and reads them (with OpenImageIO, loaded on first use:
// image_codec.h).
#pragma once

#include "sim/image.h"

#include <glm/gtc/type_precision.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace laterna {

/// What one value of a picture is: a digital number of 8 or 16 bits, or a float.
enum class PixelType { u8, u16, f32 };

/// The camera of a picture as an EXR file's header holds it, in single precision; column vectors here, row
/// vectors there. sim/formats/exr_camera.h says what the frames are, and makes it from a Device and back.
struct PictureCamera {
  std::string name{};                            ///< "cameraLabel"; empty: none
  std::optional<glm::mat4> camera_from_world{};  ///< "worldToCamera"
  std::optional<glm::mat4> window_from_world{};  ///< "worldToNDC"
};

/// A picture to be written: the channels of a pixel side by side, pixels row by row from the top.
struct PictureView {
  const void* data = nullptr;  ///< width·height·channels values of `type`
  int width = 0, height = 0, channels = 0;
  PixelType type = PixelType::u8;
  std::vector<std::string> channel_names;  ///< empty, or one per channel; only EXR keeps them
  PictureCamera camera{};                  ///< only EXR keeps it
  glm::ivec2 window{0, 0};  ///< EXR's display window, of which these are the upper left pixels; 0: all of it
};

/// Writes a picture whole or not at all (sim/safe_write.h). The extension chooses the format:
///
///   .png              u8 or u16, 1 or 3 channels; fast compression (level 1)
///   .tif, .tiff       u8, u16 or f32, 1 or 3 channels; uncompressed
///   .pgm, .ppm, .pnm  u8, 1 or 3 channels; .bmp likewise, for tools that read nothing else
///   .exr              any channels, ZIP; a name such as "projector.u" is channel u of layer projector. f32
///   as
///                     floats; u8 as half and u16 as single floats of the same whole numbers: half is exact
///                     to 2048, single to 2²⁴, and every reader of EXR knows both, unlike its 32-bit integers
///
/// The values are written as they are: nothing is scaled or gamma-encoded. Throws InputError, naming the
/// path, for another extension, for a picture that the format does not hold, an empty one, or where writing
/// fails.
void write_picture(const std::filesystem::path& path, const PictureView& picture);
void write_picture(const std::filesystem::path& path, const Image<std::uint8_t>& image);
void write_picture(const std::filesystem::path& path, const Image<std::uint16_t>& image);
void write_picture(const std::filesystem::path& path, const Image<float>& image);
void write_picture(const std::filesystem::path& path, const Image<glm::u8vec3>& rgb);
void write_picture(const std::filesystem::path& path, const Image<glm::u16vec3>& rgb);
void write_picture(const std::filesystem::path& path, const Image<glm::vec3>& rgb);

/// Writes pages, in order, as one uncompressed TIFF file; otherwise as write_picture. Pages go to disk one by
/// one: no second copy is made in memory. Throws InputError as write_picture does, and for more than 4 GB, no
/// pages, and where fewer pages arrived than were sent.
void write_pages(const std::filesystem::path& path, const std::vector<PictureView>& pages);

/// A picture as it was read, in a PictureView's order. The values are those of the file, except that half
/// floats become floats, palettes colours, and a PNM with a smaller maximum is stretched to full scale.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::string> channel_names;
  std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>> values;
  bool half = false;        ///< whether the floats stand in the file in half precision
  PictureCamera camera{};   ///< of an EXR whose header says it
  glm::ivec2 window{0, 0};  ///< size of the whole picture, of which a cropped EXR holds a part
};

/// Reads a picture with OpenImageIO's reader for the path's ending, and no other. Every reader of this page
/// throws InputError, naming the path, where the file is missing, is no picture, is cut short, or where its
/// header claims no pixels, more than 2³⁰, or more values than a file of its size can hold (checked before
/// anything is allocated). `page` counts from 0 (the parts of a multi-part EXR are pages too).
Picture read_picture(const std::filesystem::path& path, int page = 0);

/// How many pages a picture file has. Throws as read_picture; the size check holds for all pages together.
int count_pages(const std::filesystem::path& path);

/// Writes what a camera took: one file per picture, encoded in parallel, or, where `files` is one .tif file,
/// one page per picture. Throws InputError as write_picture and write_pages do, and for another number of
/// files.
void write_stack(const std::vector<std::filesystem::path>& files, const CapturedStack& stack);

/// Reads what a camera took: pictures of 8 or of 16 bits, all of the same size and depth, in the given order.
/// A list of one file means each of its pages; of several files, the first page counts. Floats must be whole
/// numbers of the camera's scale: in half precision of 8 bits, in single of 16, as write_picture leaves them.
/// Colour becomes grey as the rounded mean of R, G and B, which for equal channels is that value; alpha is
/// ignored. Throws InputError that names the picture ("picture 7 of 42 is missing: …") where one is missing
/// or unreadable, has another size or depth than the first, is of neither 8 nor 16 bits, or where the list is
/// empty. Of several faults the first picture's is told.
CapturedStack read_stack(const std::vector<std::filesystem::path>& files);

/// What the integers in a file mean.
enum class Encoding {
  linear,  ///< value / full scale
  srgb     ///< the same, then the sRGB curve (IEC 61966-2-1) decoded to linear light; float files are linear
           ///< already
};

/// Reads a picture as one linear value per pixel: the mean of R, G and B where it has colour (after
/// decoding). Integers become [0, 1]; floats stay. Throws InputError, beyond read_picture, for values that
/// are not finite and for channels other than 1 to 4.
Image<float> read_grey_float(const std::filesystem::path& path, Encoding encoding);

/// Reads a picture as linear RGB; grey becomes three equal channels. Otherwise as read_grey_float.
Image<glm::vec3> read_rgb_float(const std::filesystem::path& path, Encoding encoding);

/// Named planes of one size, such as "projector.u", "projector.v", "depth".
struct ExrLayers {
  std::vector<std::string> names;
  std::vector<Image<float>> planes;  ///< one per name
  PictureCamera camera{};            ///< whose pixels they are
};

/// Writes planes as channels of one EXR file (32-bit float, ZIP). Throws InputError as write_picture does,
/// and where sizes differ or names are missing, empty or repeated.
void write_exr_layers(const std::filesystem::path& path, const ExrLayers& layers);

/// Reads them back; the order of the names may differ. NaN stays NaN.
ExrLayers read_exr_layers(const std::filesystem::path& path);

}  // namespace laterna
