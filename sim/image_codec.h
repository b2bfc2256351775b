// What OpenImageIO does for sim/image_file.h, in a module that is loaded on first use: OpenImageIO brings
// some 250 shared libraries, which take a process 0.17 s to load.
#pragma once

#include "sim/image_file.h"

#include <filesystem>
#include <vector>

namespace laterna {

/// The module's functions, between pixels and bytes. Each throws InputError, naming the path, as image_file.h
/// says. What is written has been checked before: the extension's format holds it.
struct ImageCodec {
  /// The bytes of a file that holds the picture, in the format of the path's extension.
  std::vector<unsigned char> (*encode)(const std::filesystem::path& path, const PictureView& picture);
  /// Writes pages as one uncompressed TIFF file under `path`, and counts them. Gives the reason why that
  /// failed, or nothing.
  std::string (*write_tiff_pages)(const std::filesystem::path& path, const std::vector<PictureView>& pages);
  Picture (*read)(const std::filesystem::path& path, int page);
  int (*page_count)(const std::filesystem::path& path);
};

/// Loads the module laterna_pictures.so, which the build and the installation put where the program's run
/// path finds it, at the first call. Throws std::runtime_error with the loader's reason where it cannot be
/// loaded.
const ImageCodec& image_codec();

}  // namespace laterna
