#include "sim/image_file.h"

#include "tests/testing.h"

#include <gmock/gmock.h>
#include <sys/mount.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

namespace laterna {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::input_error;
using testing::ScratchFolder;
using testing::write_text;

template <class T>
Image<T> random_image(int width, int height, std::mt19937_64 random) {
  Image<T> image(width, height);
  for (T& value : image.values) value = T(random());
  return image;
}

template <class T>
const std::vector<T>& values_of(const Picture& picture) {
  return std::get<std::vector<T>>(picture.values);
}

TEST(WritePicture, ComesBackBitForBitFromEveryIntegerFormat) {
  const ScratchFolder folder;
  const auto bytes = random_image<std::uint8_t>(13, 7, testing::generator());
  const auto words = random_image<std::uint16_t>(13, 7, testing::generator());
  for (const char* name : {"x.png", "x.tif", "x.pgm", "x.pnm"}) {
    write_picture(folder / name, bytes);
    const Picture read = read_picture(folder / name);
    EXPECT_EQ(read.width, 13);
    EXPECT_EQ(read.height, 7);
    EXPECT_EQ(read.channel_names.size(), 1u);
    EXPECT_EQ(values_of<std::uint8_t>(read), bytes.values) << name;
  }
  for (const char* name : {"x.png", "x.tif"}) {
    write_picture(folder / name, words);
    EXPECT_EQ(values_of<std::uint16_t>(read_picture(folder / name)), words.values) << name;
  }
}

template <class T>
ImageStack<T> random_stack(int width, int height, int count) {
  ImageStack<T> stack(width, height, count);
  auto random = testing::generator();
  for (T& value : stack.values) value = T(random());
  for (int k = 0; k < count; ++k) stack.picture(k)[0] = k % 2 ? T(-1) : T(0);
  return stack;
}

TEST(WriteStack, ComesBackBitForBitFromEveryFormat) {
  const ScratchFolder folder;
  const auto round_trip = [&](const CapturedStack& stack, const std::vector<std::string>& names) {
    std::vector<fs::path> files;
    for (const std::string& name : names) files.push_back(folder / name);
    write_stack(files, stack);
    const CapturedStack read = read_stack(files);
    std::visit(
        [&](const auto& expected) {
          const auto& found = std::get<std::decay_t<decltype(expected)>>(read);
          EXPECT_EQ(found.count, expected.count) << names[0];
          EXPECT_EQ(found.values, expected.values) << names[0];
        },
        stack);
  };
  const CapturedStack bytes = random_stack<std::uint8_t>(37, 21, 3);
  const CapturedStack words = random_stack<std::uint16_t>(37, 21, 3);
  for (const std::string e : {".png", ".tif", ".pgm", ".exr"}) round_trip(bytes, {"0" + e, "1" + e, "2" + e});
  for (const std::string e : {".png", ".tif", ".exr"}) round_trip(words, {"0" + e, "1" + e, "2" + e});
  round_trip(bytes, {"pages.tif"});
  round_trip(words, {"pages.tif"});  // in place of the old one
  EXPECT_EQ(count_pages(folder / "pages.tif"), 3);
  EXPECT_EQ(count_pages(folder / "0.png"), 1);
}

TEST(WriteStack, RefusesWhatDoesNotFit) {
  const ScratchFolder folder;
  const CapturedStack stack = random_stack<std::uint8_t>(2, 2, 3);
  EXPECT_THAT(input_error([&] {
                write_stack({folder / "0.png", folder / "1.png"}, stack);
              }),
              HasSubstr("2 files for 3 pictures"));
  EXPECT_THAT(input_error([&] { write_stack({folder / "0.png"}, stack); }), HasSubstr("expected .tif"));
  EXPECT_THAT(input_error([&] { write_pages(folder / "0.tif", {}); }), HasSubstr("no pages"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(ReadStack, TakesThePagesOfOneFileAloneAndNamesAMissingOne) {
  const ScratchFolder folder;
  const ImageStack<std::uint8_t> stack = random_stack<std::uint8_t>(8, 8, 4);
  write_stack({folder / "a.tif"}, stack);
  write_stack({folder / "b.tif"}, stack);
  const auto firsts = std::get<ImageStack<std::uint8_t>>(read_stack({folder / "a.tif", folder / "b.tif"}));
  EXPECT_EQ(firsts.count, 2);
  EXPECT_TRUE(std::equal(firsts.picture(1).begin(), firsts.picture(1).end(), stack.picture(0).begin()));
  EXPECT_THAT(input_error([&] { read_picture(folder / "a.tif", 4); }),
              AllOf(HasSubstr("a.tif"), HasSubstr("page 5")));
}

TEST(WritePicture, KeepsTheOrderOfColours) {
  const ScratchFolder folder;
  Image<glm::u8vec3> bytes(2, 1);
  bytes.values = {{1, 2, 3}, {250, 251, 252}};
  Image<glm::u16vec3> words(1, 1, {1, 300, 65535});
  for (const char* name : {"x.png", "x.tif", "x.ppm"}) {
    write_picture(folder / name, bytes);
    EXPECT_THAT(values_of<std::uint8_t>(read_picture(folder / name)), ElementsAre(1, 2, 3, 250, 251, 252))
        << name;
  }
  for (const char* name : {"x.png", "x.tif"}) {
    write_picture(folder / name, words);
    EXPECT_THAT(values_of<std::uint16_t>(read_picture(folder / name)), ElementsAre(1, 300, 65535)) << name;
  }
}

TEST(WritePicture, KeepsFloatsBitForBit) {
  const ScratchFolder folder;
  Image<float> image(3, 1);
  image.values = {-1.5e-30f, 3.1415927f, 1e30f};
  for (const char* name : {"x.exr", "x.tif"}) {
    write_picture(folder / name, image);
    EXPECT_EQ(values_of<float>(read_picture(folder / name)), image.values) << name;
  }
}

TEST(WritePicture, RefusesWhatAFormatDoesNotHold) {
  const ScratchFolder folder;
  const Image<std::uint8_t> bytes(2, 2);
  EXPECT_THAT(input_error([&] { write_picture(folder / "x.png", Image<float>(2, 2)); }),
              AllOf(HasSubstr("x.png"), HasSubstr("floats")));
  EXPECT_THAT(input_error([&] { write_picture(folder / "x.pgm", Image<std::uint16_t>(2, 2)); }),
              HasSubstr("16-bit integers, .pgm does not"));
  EXPECT_THAT(input_error([&] { write_picture(folder / "x.jpg", bytes); }),
              HasSubstr("\".jpg\", expected .png"));
  EXPECT_THAT(input_error([&] { write_picture(folder / "x.png", Image<std::uint8_t>()); }),
              HasSubstr("empty"));
  EXPECT_THAT(input_error([&] {
                write_picture(folder / "x.png", {bytes.values.data(), 2, 1, 2, PixelType::u8, {}});
              }),
              HasSubstr("2 channels, expected 1 or 3"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

/// A disk of 64 KiB, or none where this user may not mount one.
struct SmallDisk {
  explicit SmallDisk(const fs::path& where)
      : path(where), mounted(::mount("tmpfs", where.c_str(), "tmpfs", 0, "size=64k") == 0) {}
  ~SmallDisk() {
    if (mounted) ::umount2(path.c_str(), MNT_DETACH);
  }
  fs::path path;
  bool mounted;
};

TEST(WritePicture, SaysThatTheDiskIsFullForEveryFormat) {
  const ScratchFolder folder;
  const SmallDisk disk(folder.path());
  if (!disk.mounted) GTEST_SKIP() << "this user may not mount a small disk";
  const auto words = random_image<std::uint16_t>(400, 400, testing::generator());
  const auto bytes = random_image<std::uint8_t>(400, 400, testing::generator());
  Image<float> floats(400, 400);
  std::copy(words.values.begin(), words.values.end(), floats.values.begin());
  const auto expect_full = [&](const std::string& name, auto&& write) {
    EXPECT_THAT(input_error(write), AllOf(HasSubstr("/" + name), HasSubstr("No space left on device")));
    EXPECT_TRUE(fs::is_empty(folder.path())) << name;
  };
  expect_full("x.png", [&] { write_picture(folder / "x.png", words); });
  expect_full("x.tif", [&] { write_picture(folder / "x.tif", words); });
  expect_full("x.pgm", [&] { write_picture(folder / "x.pgm", bytes); });
  expect_full("x.exr", [&] { write_picture(folder / "x.exr", floats); });
}

TEST(WritePages, SaysThatTheDiskIsFullWhereverThatHappens) {
  const ScratchFolder folder;
  const SmallDisk disk(folder.path());
  if (!disk.mounted) GTEST_SKIP() << "this user may not mount a small disk";
  int failed = 0, written = 0;
  // From 12 to 20 pages of some 3.8 kB: the disk ends in pixels, in a page's header, or not at all.
  for (int pages = 12; pages <= 20; ++pages) {
    for (const int height : {30, 31, 32}) {
      const ImageStack<std::uint8_t> stack = random_stack<std::uint8_t>(125, height, pages);
      try {
        write_stack({folder / "x.tif"}, stack);
        ++written;
        EXPECT_EQ(std::get<ImageStack<std::uint8_t>>(read_stack({folder / "x.tif"})).values, stack.values);
        fs::remove(folder / "x.tif");
      } catch (const InputError& error) {
        ++failed;
        EXPECT_THAT(error.what(), AllOf(HasSubstr("/x.tif: "), HasSubstr("cannot be written")));
        EXPECT_TRUE(fs::is_empty(folder.path()));
      }
    }
  }
  EXPECT_GT(failed, 0);
  EXPECT_GT(written, 0);
}

TEST(ReadPicture, RefusesWhatIsNoPicture) {
  const ScratchFolder folder;
  EXPECT_THAT(input_error([&] { read_picture(folder / "x.png"); }), HasSubstr("x.png: no such file"));
  EXPECT_THAT(input_error([&] { read_picture(folder.path()); }), HasSubstr("is no file"));
  for (const char* name : {"x.png", "x.tif", "x.pgm", "x.exr", "x.txt"}) {
    write_text(folder / name, "this is no picture");
    EXPECT_THAT(
        input_error([&] { read_picture(folder / name); }),
        AllOf(HasSubstr(name), HasSubstr("cannot be read as a picture"), ::testing::Not(HasSubstr("\n"))));
    write_text(folder / name, "");
    EXPECT_THAT(input_error([&] { read_picture(folder / name); }), HasSubstr("cannot be read as a picture"));
  }
}

TEST(ReadPicture, RefusesWhatIsCutShort) {
  const ScratchFolder folder;
  const auto bytes = random_image<std::uint8_t>(40, 30, testing::generator());
  Image<float> floats(40, 30);
  std::copy(bytes.values.begin(), bytes.values.end(), floats.values.begin());
  for (const char* name : {"x.png", "x.tif", "x.pgm", "x.exr"}) {
    if (std::string(name) == "x.exr")
      write_picture(folder / name, floats);
    else
      write_picture(folder / name, bytes);
    fs::resize_file(folder / name, fs::file_size(folder / name) * 2 / 3);
    EXPECT_THAT(input_error([&] { read_picture(folder / name); }), HasSubstr("cannot be read as a picture"))
        << name;
  }
}

TEST(ReadPicture, RefusesHeadersThatClaimTooMuch) {
  const ScratchFolder folder;
  const auto claim = [&](const std::string& header) {
    return input_error([&] { read_picture(write_text(folder / "x.pgm", header)); });
  };
  EXPECT_THAT(claim("P5 100000 100000 255\n"), HasSubstr("claims 100000×100000 pixels, expected at most"));
  EXPECT_THAT(claim("P5 20000 20000 255\nab"), HasSubstr("more than a file of 21 bytes holds"));
  EXPECT_THAT(claim("P5 -4 4 255\nabcdefghijklmnop"), HasSubstr("claims -4×4"));
  EXPECT_THAT(claim("P5 0 4 255\n"), HasSubstr("x.pgm"));
}

TEST(ReadStack, KeepsOrderAndDepth) {
  const ScratchFolder folder;
  std::vector<fs::path> files;
  for (int k = 0; k < 5; ++k) {
    files.push_back(folder / (std::to_string(k) + ".png"));
    write_picture(files.back(), Image<std::uint8_t>(4, 3, std::uint8_t(10 * k)));
  }
  const auto stack = std::get<ImageStack<std::uint8_t>>(read_stack(files));
  EXPECT_EQ(stack.width, 4);
  EXPECT_EQ(stack.height, 3);
  ASSERT_EQ(stack.count, 5);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(stack.picture(k)[11], 10 * k);
  write_picture(folder / "w.png", Image<std::uint16_t>(4, 3, 40000));
  EXPECT_EQ(std::get<ImageStack<std::uint16_t>>(read_stack({folder / "w.png"})).picture(0)[0], 40000);
}

TEST(ReadStack, TakesTheMeanOfColours) {
  const ScratchFolder folder;
  Image<glm::u16vec3> image(3, 1);
  image.values = {{65535, 65535, 65535}, {1, 2, 4}, {7, 7, 7}};  // 7/3 is 2
  write_picture(folder / "x.png", image);
  EXPECT_THAT(std::get<ImageStack<std::uint16_t>>(read_stack({folder / "x.png"})).values,
              ElementsAre(65535, 2, 7));
}

TEST(ReadStack, NamesThePictureAtFault) {
  const ScratchFolder folder;
  const fs::path a = folder / "a.png", b = folder / "b.png", c = folder / "c.png";
  write_picture(a, Image<std::uint8_t>(4, 3));
  write_picture(b, Image<std::uint8_t>(4, 4));
  write_picture(c, Image<std::uint16_t>(4, 3));
  write_picture(folder / "d.exr", Image<float>(4, 3, 0.5f));
  const auto fault = [](const std::vector<fs::path>& files) {
    return input_error([&] { read_stack(files); });
  };
  EXPECT_THAT(fault({a, a, folder / "none.png", b}), HasSubstr("picture 3 of 4 is missing: "));
  EXPECT_THAT(fault({a, a, b, c}), AllOf(HasSubstr("picture 3 of 4"), HasSubstr("4×4 pixels, expected 4×3")));
  EXPECT_THAT(fault({a, c, b}), AllOf(HasSubstr("picture 2 of 3"), HasSubstr("16 bits, expected 8 bits")));
  EXPECT_THAT(fault({a, folder / "d.exr"}), AllOf(HasSubstr("picture 2 of 2"), HasSubstr("floats")));
  EXPECT_THAT(fault({folder / "d.exr"}),
              HasSubstr("floats such as 0.5, expected whole numbers from 0 to 65535"));
  EXPECT_THAT(fault({a, write_text(folder / "x.png", "x")}),
              AllOf(HasSubstr("picture 2 of 2"), HasSubstr("x.png")));
  EXPECT_THAT(fault({}), HasSubstr("no pictures"));
}

TEST(ReadFloat, DecodesSrgbByHand) {
  const ScratchFolder folder;
  Image<std::uint8_t> image(4, 1);
  image.values = {0, 10, 128, 255};
  write_picture(folder / "x.png", image);
  const float tolerance = 1e-6f;  // a few float roundings
  const Image<float> srgb = read_grey_float(folder / "x.png", Encoding::srgb);
  EXPECT_EQ(srgb.values[0], 0.0f);
  EXPECT_NEAR(srgb.values[1], 10 / 255.0 / 12.92, tolerance);
  EXPECT_NEAR(srgb.values[2], 0.2158605, tolerance);  // IEC 61966-2-1
  EXPECT_EQ(srgb.values[3], 1.0f);
  EXPECT_NEAR(read_grey_float(folder / "x.png", Encoding::linear).values[2], 128 / 255.0, tolerance);
}

TEST(ReadFloat, TakesColoursAndFloatsAsTheyAre) {
  const ScratchFolder folder;
  write_picture(folder / "x.tif", Image<glm::vec3>(1, 1, {0.25f, 0.5f, 3.0f}));
  EXPECT_EQ(read_rgb_float(folder / "x.tif", Encoding::srgb).values[0], glm::vec3(0.25f, 0.5f, 3.0f));
  EXPECT_FLOAT_EQ(read_grey_float(folder / "x.tif", Encoding::linear).values[0], 1.25f);
  write_picture(folder / "g.png", Image<std::uint16_t>(1, 1, 65535));
  EXPECT_EQ(read_rgb_float(folder / "g.png", Encoding::linear).values[0], glm::vec3(1.0f));
}

TEST(ReadFloat, RefusesWhatIsNotFinite) {
  const ScratchFolder folder;
  Image<float> image(2, 2);
  image(1, 1) = std::numeric_limits<float>::quiet_NaN();
  write_picture(folder / "x.exr", image);
  EXPECT_THAT(input_error([&] { read_grey_float(folder / "x.exr", Encoding::linear); }),
              HasSubstr("pixel (1, 1) holds a value that is not finite"));
}

TEST(ExrLayers, ComeBackByName) {
  const ScratchFolder folder;
  ExrLayers layers;
  for (const char* name : {"projector.u", "projector.v", "depth.Z", "normal.x", "lit.A", "R"}) {
    layers.names.emplace_back(name);
    layers.planes.emplace_back(3, 2, float(layers.names.size()));
  }
  layers.planes[0](2, 1) = 0.1f;
  layers.planes[1](0, 0) = std::numeric_limits<float>::quiet_NaN();
  write_exr_layers(folder / "truth.exr", layers);
  const ExrLayers read = read_exr_layers(folder / "truth.exr");
  ASSERT_THAT(read.names, ::testing::UnorderedElementsAreArray(layers.names));
  for (std::size_t i = 0; i < layers.names.size(); ++i) {
    const auto at = std::find(read.names.begin(), read.names.end(), layers.names[i]) - read.names.begin();
    for (std::size_t p = 0; p < 6; ++p) {
      const float expected = layers.planes[i].values[p], found = read.planes[at].values[p];
      EXPECT_TRUE(found == expected || (std::isnan(found) && std::isnan(expected))) << layers.names[i];
    }
  }
}

TEST(ExrLayers, RefuseWhatDoesNotFit) {
  const ScratchFolder folder;
  const Image<float> plane(3, 2);
  const auto fault = [&](const ExrLayers& layers) {
    return input_error([&] { write_exr_layers(folder / "x.exr", layers); });
  };
  EXPECT_THAT(fault({{"a", "b"}, {plane}}), HasSubstr("2 names for 1 planes"));
  EXPECT_THAT(fault({{"a", "b"}, {plane, Image<float>(2, 2)}}),
              HasSubstr("plane b is 2×2 pixels, expected 3×2"));
  EXPECT_THAT(fault({{"a", "a"}, {plane, plane}}), HasSubstr("repeated"));
  EXPECT_THAT(fault({{"a", ""}, {plane, plane}}), HasSubstr("empty"));
  EXPECT_THAT(fault({}), HasSubstr("0 names"));
  write_picture(folder / "x.png", Image<std::uint8_t>(1, 1));
  EXPECT_THAT(input_error([&] { read_exr_layers(folder / "x.png"); }), HasSubstr("expected an EXR"));
}

}  // namespace
}  // namespace laterna
