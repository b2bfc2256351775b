// Memory of a large capture: what it must hold, and little beside it.
#include "tests/command/run_command.h"
#include "tests/testing.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace laterna {
namespace {

constexpr double mib = 1 << 20;

// 3840×2160 both ways: 50 Gray pictures of 8 bits with the whole sensor model.
const char* const scene = R"(
ambient_lx = 5
[[mesh]]
shape = "relief"
shape_size = [1.6, 1.0, 0.3]
detail = 200
[[projector]]
size = [3840, 2160]
throw_ratio = 1.2
position = [-0.4, 0, 2]
look_at = [0, 0, 0]
up = [0, 1, 0]
[[camera]]
size = [3840, 2160]
fx = 4800
position = [0.4, 0.1, 2]
look_at = [0, 0, 0]
up = [0, 1, 0]
sensor = { kind = "emva1288" }
)";

TEST(Memory, A4kCaptureHoldsItsPicturesAndAQuarterOfAGibibyte) {
  const testing::ScratchFolder folder;
  testing::write_text(folder / "s.toml", scene);
  const auto run = testing::laterna("capture s.toml -o c --format tif --no-truth", folder.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);  // of the largest child
  const double pictures_mib = 50.0 * 3840 * 2160 / mib;
  // The pattern stack is bits: a few kilobytes.
  EXPECT_LT(usage.ru_maxrss / 1024.0, pictures_mib + 256);
  EXPECT_GT(usage.ru_maxrss / 1024.0, pictures_mib);  // it did run
}

}  // namespace
}  // namespace laterna
