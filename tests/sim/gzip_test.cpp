#include "sim/gzip.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using testing::input_error;

/// `printf laterna | gzip -n`
const std::string packed(
    "\x1f\x8b\x08\x00\x00\x00\x00\x00\x00\x03\xcb\x49\x2c\x49\x2d\xca\x4b\x04\x00\xf7\xcf\xc6\x84\x07\x00\x00"
    "\x00",
    27);

std::string refusal(const std::string& bytes, std::size_t limit = 100) {
  return input_error([&] { gunzip(bytes, "a.gz", limit); });
}

TEST(Gzip, UnpacksOneMemberOrSeveral) {
  EXPECT_EQ(gunzip(packed, "a.gz"), "laterna");
  EXPECT_EQ(gunzip(packed + packed, "a.gz"), "laternalaterna");
}

TEST(Gzip, UnpacksManySmallMembers) {
  std::string many, expected;
  for (int i = 0; i < 5000; ++i) many += packed, expected += "laterna";
  EXPECT_EQ(gunzip(many, "a.gz"), expected);
}

TEST(Gzip, RefusesAStreamCutAtAnyByte) {
  for (std::size_t size = 0; size < packed.size(); ++size)
    EXPECT_EQ(refusal(packed.substr(0, size)), "a.gz: the gzip stream ends early: the file is truncated")
        << size;
}

TEST(Gzip, RefusesDamageTrailersAndTooMuch) {
  std::string damaged = packed;
  damaged[12] ^= 1;
  EXPECT_THAT(refusal(damaged), HasSubstr("a.gz: the gzip stream is corrupt ("));
  EXPECT_EQ(refusal("no gzip at all"), "a.gz: the gzip stream is corrupt (incorrect header check)");
  EXPECT_EQ(refusal(packed + "xy"), "a.gz: 2 bytes follow the gzip stream, expected the end of the file");
  EXPECT_EQ(refusal(packed, 6), "a.gz: unpacks to more than 6 bytes, the most that is read");
}

}  // namespace
}  // namespace laterna
