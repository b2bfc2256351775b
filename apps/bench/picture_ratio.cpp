#include "apps/bench/picture_ratio.h"

#include "apps/bench/timing.h"
#include "sim/image_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <random>
#include <string>

namespace laterna {

namespace {

namespace fs = std::filesystem;

/// Stripes, as a camera sees them: finer from picture to picture, with noise of a few DN.
ImageStack<std::uint8_t> striped_stack(int width, int height, int count) {
  ImageStack<std::uint8_t> stack(width, height, count);
  std::minstd_rand random(1);
  for (int k = 0; k < count; ++k) {
    const int shift = 10 - (k / 2) % 10;
    std::uint8_t* value = stack.picture(k).data();
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        *value++ = std::uint8_t((((k < count / 2 ? x : y) >> shift) & 1 ? 160 : 20) + (random() >> 8) % 5);
  }
  return stack;
}

/// A folder that goes with this object.
struct Folder {
  fs::path path = fs::temp_directory_path() / fmt::format("laterna-bench-{}", ::getpid());
  Folder() { fs::create_directory(path); }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  std::vector<fs::path> files(int count, const char* extension) const {
    std::vector<fs::path> files;
    for (int k = 0; k < count; ++k) files.push_back(path / fmt::format("{:02}.{}", k, extension));
    return files;
  }
};

}  // namespace

PictureTimes time_pictures(int repeats) {
  const CapturedStack stack = striped_stack(1280, 800, 44);
  const auto& values = std::get<ImageStack<std::uint8_t>>(stack).values;
  std::vector<std::uint8_t> copy(values.size());
  std::vector<double> png, tif, pages;
  for (int i = 0; i <= repeats; ++i) {
    const Folder folder;
    const double base = seconds([&] { std::memcpy(copy.data(), values.data(), values.size()); });
    const double p = seconds([&] { write_stack(folder.files(44, "png"), stack); });
    const double t = seconds([&] { write_stack(folder.files(44, "tif"), stack); });
    const double m = seconds([&] { write_stack(folder.files(1, "tif"), stack); });
    if (i == 0) continue;  // loads what is loaded on first use
    png.push_back(p / base), tif.push_back(t / base), pages.push_back(m / base);
  }
  return {median(png), median(tif), median(pages)};
}

}  // namespace laterna
