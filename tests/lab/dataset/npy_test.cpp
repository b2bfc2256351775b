#include "apps/lab/dataset/npy.h"

#include "sim/text_file.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <cstring>

namespace laterna {
namespace {

// By NumPy's own description of the format: magic, version 1.0, the header's length in two bytes, the header,
// which ends with a line feed at a multiple of 64.
TEST(Npy, HeaderByHand) {
  const std::string header = npy_header({2, 3});
  ASSERT_EQ(header.size(), 128u);
  EXPECT_EQ(header.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  EXPECT_EQ(header.substr(8, 2), std::string("\x76\x00", 2));  // 118 = 128 - 10
  EXPECT_THAT(header.substr(10),
              ::testing::StartsWith("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), } "));
  EXPECT_EQ(header.back(), '\n');
}

// A tuple of one needs its comma: (3) is a number to Python.
TEST(Npy, OneDimensionIsATuple) { EXPECT_THAT(npy_header({3}), ::testing::HasSubstr("'shape': (3,), }")); }

TEST(Npy, ValuesStandBehindTheHeader) {
  const testing::ScratchFolder folder;
  const std::vector<float> values{1, -2.5f, 3e-20f, 4, 5, 6};
  write_npy(folder / "a.npy", values, {2, 3});
  const std::string bytes = read_text(folder / "a.npy", 1 << 20);
  ASSERT_EQ(bytes.size(), 128 + 6 * sizeof(float));
  EXPECT_EQ(bytes.substr(0, 128), npy_header({2, 3}));
  std::vector<float> stored(6);
  std::memcpy(stored.data(), bytes.data() + 128, 6 * sizeof(float));
  EXPECT_EQ(stored, values);
}

TEST(Npy, AnEmptyTableIsAFileToo) {
  const testing::ScratchFolder folder;
  write_npy(folder / "a.npy", {}, {0, 8});
  EXPECT_EQ(read_text(folder / "a.npy", 1 << 20), npy_header({0, 8}));
}

TEST(Npy, AShapeOfAnotherSizeIsRefusedAndLeavesNothing) {
  const testing::ScratchFolder folder;
  const std::vector<float> values(5);
  EXPECT_THAT(testing::input_error([&] {
                write_npy(folder / "a.npy", values, {2, 3});
              }),
              ::testing::HasSubstr("5 numbers for an array of 2 × 3, expected 6"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.npy"));
}

}  // namespace
}  // namespace laterna
