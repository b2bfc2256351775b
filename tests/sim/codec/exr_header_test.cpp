#include "sim/image_file.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cstring>
#include <fstream>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using Numbers = std::vector<std::int32_t>;

/// A file of 3×2 floats, whose attribute `key` of this type gets another size (where one is named) and other
/// first numbers.
std::string changed(const std::string& key, const std::string& type, std::optional<std::int32_t> size,
                    const Numbers& numbers = {}) {
  const testing::ScratchFolder folder;
  write_picture(folder / "x.exr", Image<float>(3, 2, 1.0f));
  std::ifstream file(folder / "x.exr", std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const std::string head = key + '\0' + type + '\0';
  const std::size_t at = bytes.find(head);
  EXPECT_NE(at, std::string::npos);
  char* value = bytes.data() + at + head.size();
  if (size) std::memcpy(value, &*size, sizeof *size);
  if (!numbers.empty()) std::memcpy(value + 4, numbers.data(), numbers.size() * sizeof numbers[0]);
  return bytes;
}

std::string error_of(const std::string& bytes) {
  const testing::ScratchFolder folder;
  return testing::input_error([&] { read_picture(testing::write_text(folder / "x.exr", bytes)); });
}

TEST(ExrHeader, AsItWasWrittenIsRead) {
  const std::string bytes = changed("dataWindow", "box2i", 16, {0, 0, 2, 1});
  const testing::ScratchFolder folder;
  const auto path = testing::write_text(folder / "x.exr", bytes);
  EXPECT_EQ(read_picture(path).width, 3);
}

TEST(ExrHeader, AttributesLargerThanTheFile) {
  const std::string large = error_of(changed("compression", "compression", 1634692198));
  EXPECT_THAT(large,
              HasSubstr("x.exr: cannot be read as a picture: its OpenEXR header claims 1634692198 bytes for "
                        "\"compression\", the file has "));
  EXPECT_THAT(error_of(changed("channels", "chlist", -1)), HasSubstr("claims -1 bytes for \"channels\""));
}

TEST(ExrHeader, AttributesOfAnotherSizeThanTheirTypeTakes) {
  EXPECT_THAT(error_of(changed("dataWindow", "box2i", 15)),
              HasSubstr("claims 15 bytes for \"dataWindow\", a box2i of 16"));
  EXPECT_THAT(error_of(changed("channels", "chlist", 5)),
              HasSubstr("claims 5 bytes for \"channels\", a chlist of "));
}

TEST(ExrHeader, WindowsThatNoFileHolds) {
  EXPECT_THAT(error_of(changed("dataWindow", "box2i", 16, {0, 0, 1 << 20, 1})),
              HasSubstr("claims lines of 1048577 pixels of 1 channels, expected at most 524288 values"));
  const std::string tall = error_of(changed("dataWindow", "box2i", 16, {0, -2147483647 - 1, 2, 2147483647}));
  EXPECT_THAT(tall, HasSubstr("claims 3×4294967296 pixels in 16777216 pieces, more than a file of "));
  EXPECT_THAT(error_of(changed("dataWindow", "box2i", 16, {2, 0, 0, 1})), HasSubstr("claims -1×2 pixels"));
}

TEST(ExrHeader, CutShortAnywhereIsRefused) {
  const std::string whole = changed("dataWindow", "box2i", 16, {0, 0, 2, 1});
  for (std::size_t length = 8; length < whole.size(); length += 7)
    EXPECT_THAT(error_of(whole.substr(0, length)), HasSubstr("x.exr: cannot be read as a picture"));
  EXPECT_GT(whole.size(), 100u);
}

}  // namespace
}  // namespace laterna
