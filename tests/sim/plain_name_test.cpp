#include "sim/plain_name.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

#include <vector>

namespace laterna {
namespace {

TEST(PlainName, TakesWhatPeopleWrite) {
  for (const char* name : {"projector", "left 2", "Werfer über Tür", "a.b", "-"}) check_plain_name(name, "x");
  SUCCEED();
}

TEST(PlainName, RefusesWhatLeadsElsewhere) {
  for (const std::string& name : std::vector<std::string>{"", "../evil", "/etc", "a/b", "a\\b", ".", "..",
                                                          ".hidden", "a\nb", std::string(65, 'a')}) {
    EXPECT_THAT(testing::input_error([&] { check_plain_name(name, "[[camera]]"); }),
                ::testing::HasSubstr("[[camera]]: name is"));
  }
}

TEST(InnerPath, StaysInside) {
  check_inner_path("camera/left/00.png", "x");
  for (const char* path : {"", "/etc/passwd", "../x.png", "a/../../x.png"}) {
    EXPECT_THAT(testing::input_error([&] { check_inner_path(path, "m.json"); }),
                ::testing::HasSubstr("inside the folder"));
  }
}

}  // namespace
}  // namespace laterna
