// Stacks of pictures, made of read_picture, write_picture and write_pages.
#include "sim/error.h"
#include "sim/image_file.h"
#include "sim/parallel.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <exception>
#include <functional>

namespace laterna {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const fs::path& path, const std::string& reason) {
  throw InputError(fmt::format("{}: {}", path.string(), reason));
}

/// One picture of a sequence.
struct Place {
  fs::path path;
  int page = 0;
};

int bits_of(const Picture& picture) {
  constexpr std::array bits{8, 16};
  return bits.at(picture.values.index());
}

template <class T>
std::vector<T> whole_numbers(const fs::path& path, const Picture& picture) {
  const auto& values = std::get<std::vector<float>>(picture.values);
  std::vector<T> integers(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(values[i] >= 0 && values[i] <= float(T(-1)) && values[i] == std::floor(values[i])))
      refuse(path,
             fmt::format("holds floats such as {}, expected whole numbers from 0 to {}", values[i], T(-1)));
    integers[i] = T(values[i]);
  }
  return integers;
}

/// A camera's picture: its floats become the integers that they stand for.
Picture read_integers(const Place& place) {
  Picture picture = read_picture(place.path, place.page);
  if (!std::holds_alternative<std::vector<float>>(picture.values)) return picture;
  if (picture.half)
    picture.values = whole_numbers<std::uint8_t>(place.path, picture);
  else
    picture.values = whole_numbers<std::uint16_t>(place.path, picture);
  return picture;
}

/// Throws where a picture cannot stand in one stack with the first.
void validate_like(const Picture& first, const fs::path& path, const Picture& picture) {
  if (picture.width != first.width || picture.height != first.height)
    refuse(path, fmt::format("is {}×{} pixels, expected {}×{} as the first picture", picture.width,
                             picture.height, first.width, first.height));
  if (picture.values.index() != first.values.index())
    refuse(path, fmt::format("holds {} bits, expected {} bits as the first picture", bits_of(picture),
                             bits_of(first)));
}

template <class T>
void make_grey(const fs::path& path, const Picture& picture, std::span<T> grey) {
  const std::size_t channels = picture.channel_names.size();
  if (channels < 1 || channels > 4)
    refuse(path,
           fmt::format("has {} channels, expected 1 to 4 (grey or RGB, with or without alpha)", channels));
  const T* v = std::get<std::vector<T>>(picture.values).data();
  for (T& value : grey) {
    value = channels >= 3 ? static_cast<T>((v[0] + v[1] + v[2] + 1) / 3) : v[0];
    v += channels;
  }
}

/// "picture 7 of 42: …" before what `action` has to say about picture k.
void naming_picture(std::size_t k, std::size_t count, const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    throw InputError(fmt::format("picture {} of {}: {}", k + 1, count, error.what()));
  }
}

/// Reads all pictures at the same time; of several faults the first picture's is thrown.
template <class T>
ImageStack<T> read_all(const std::vector<Place>& places, const Picture& first) {
  ImageStack<T> stack(first.width, first.height, int(places.size()));
  std::vector<std::exception_ptr> faults(places.size());
  parallel_for(places.size(), [&](std::size_t k) {
    try {
      naming_picture(k, places.size(), [&] {
        const Picture picture = k == 0 ? first : read_integers(places[k]);
        validate_like(first, places[k].path, picture);
        make_grey(places[k].path, picture, stack.picture(int(k)));
      });
    } catch (...) {
      faults[k] = std::current_exception();
    }
  });
  for (const std::exception_ptr& fault : faults)
    if (fault) std::rethrow_exception(fault);
  return stack;
}

void expect_all_present(const std::vector<fs::path>& files) {
  if (files.empty()) throw InputError("no pictures, expected at least one");
  for (std::size_t k = 0; k < files.size(); ++k) {
    std::error_code ignored;
    if (!fs::exists(files[k], ignored))
      throw InputError(
          fmt::format("picture {} of {} is missing: {}", k + 1, files.size(), files[k].string()));
  }
}

/// One file alone: its pages. Several files: the first page of each.
std::vector<Place> places_in(const std::vector<fs::path>& files) {
  std::vector<Place> places;
  if (files.size() == 1) {
    naming_picture(0, 1, [&] {
      for (int page = 0, pages = count_pages(files[0]); page < pages; ++page)
        places.push_back({files[0], page});
    });
    return places;
  }
  for (const fs::path& file : files) places.push_back({file, 0});
  return places;
}

}  // namespace

CapturedStack read_stack(const std::vector<fs::path>& files) {
  expect_all_present(files);
  const std::vector<Place> places = places_in(files);
  Picture first;
  naming_picture(0, places.size(), [&] { first = read_integers(places[0]); });
  if (bits_of(first) == 8) return read_all<std::uint8_t>(places, first);
  return read_all<std::uint16_t>(places, first);
}

void write_stack(const std::vector<fs::path>& files, const CapturedStack& stack) {
  std::vector<PictureView> views;
  std::visit(
      [&](const auto& pictures) {
        using Value = typename std::decay_t<decltype(pictures)>::value_type;
        const PixelType type = sizeof(Value) == 1 ? PixelType::u8 : PixelType::u16;
        for (int k = 0; k < pictures.count; ++k)
          views.push_back({pictures.picture(k).data(), pictures.width, pictures.height, 1, type, {"Y"}});
      },
      stack);
  if (files.size() == views.size()) {
    parallel_for(files.size(), [&](std::size_t k) { write_picture(files[k], views[k]); });
    return;
  }
  if (files.size() != 1)
    throw InputError(fmt::format("{} files for {} pictures, expected one each or one for all", files.size(),
                                 views.size()));
  write_pages(files[0], views);
}

}  // namespace laterna
