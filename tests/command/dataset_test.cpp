// Data sets whose making is cut off: killed, or without room on the disk.
#include "tests/command/run_command.h"
#include "tests/lab/dataset/specs.h"
#include "tests/testing.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <random>

namespace laterna::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AnyOf;
using ::testing::HasSubstr;

const std::string words = "dataset spec.toml --count 4 --threads 2 -o ";

int shell(const std::string& line) {
  const int status = std::system(line.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// Under a final name stands nothing that is not whole.
void expect_nothing_partial(const fs::path& root) {
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    const std::string name = entry.path().filename().string();
    const bool is_sample = entry.is_directory() && name.size() == 8 && name[0] == '0';
    EXPECT_TRUE(!is_sample || fs::exists(entry.path() / "sample.json")) << entry.path();
  }
  if (fs::exists(root / "checksums.txt")) {
    const std::string lines = read_text(root / "checksums.txt");
    EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 4);
  }
}

void expect_same_set(const fs::path& a, const fs::path& b) {
  for (const char* file : {"checksums.txt", "tars/tiny-000000.tar", "tars/tiny-000001.tar"})
    EXPECT_TRUE(read_text(a / file) == read_text(b / file) && fs::exists(a / file)) << file;
}

bool has_partial_names(const fs::path& root) {
  const fs::recursive_directory_iterator all(root);
  return std::any_of(begin(all), end(all), [](const auto& entry) {
    return entry.path().filename().string().find(".partial-") != std::string::npos;
  });
}

TEST(Command, ADatasetKilledAtAnyMomentIsGoneOnWith) {
  const ScratchFolder scratch;
  write_tiny_spec(scratch.path());
  const auto whole = laterna(words + "whole --json", scratch.path());
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  const json outcome = json::parse(whole.out);
  EXPECT_TRUE(outcome.at("whole"));
  EXPECT_EQ(outcome.at("made"), 4);
  const double all_s = outcome.at("seconds");
  std::mt19937_64 random = generator();
  int kills = 0;
  for (int k = 0; k < 6; ++k) {
    const double after_s = 0.05 + std::uniform_real_distribution(0.0, all_s / 3)(random);
    const int code =
        shell(fmt::format("cd '{}' && timeout -s KILL {:.3f} '{}' {}killed --resume >/dev/null 2>&1",
                          scratch.path().string(), after_s, laterna_path(), words));
    kills += code != 0;
    if (fs::exists(scratch / "killed")) expect_nothing_partial(scratch / "killed");
  }
  EXPECT_GT(kills, 0);
  const auto end = laterna(words + "killed --resume", scratch.path());
  ASSERT_EQ(end.exit_code, 0) << end.err;
  expect_same_set(scratch / "killed", scratch / "whole");
  EXPECT_FALSE(has_partial_names(scratch / "killed"));
}

TEST(Command, ADatasetWithoutRoomSaysSoAndIsGoneOnWith) {
  const ScratchFolder scratch;
  write_tiny_spec(scratch.path());
  ASSERT_EQ(laterna(words + "whole", scratch.path()).exit_code, 0);
  // No file may be longer than 32 KiB: the tar files are.
  const auto limited = laterna(words + "limited", scratch.path(), "", "trap '' XFSZ; ulimit -f 64; ");
  EXPECT_EQ(limited.exit_code, 2);
  EXPECT_THAT(limited.err, HasSubstr("File too large; what is whole stays: --resume goes on\n"));
  expect_nothing_partial(scratch / "limited");
  ASSERT_EQ(laterna(words + "limited --resume", scratch.path()).exit_code, 0);
  expect_same_set(scratch / "limited", scratch / "whole");

  const std::string small = (scratch / "small").string();
  fs::create_directory(small);
  if (shell("mount -t tmpfs -o size=500k none '" + small + "' 2>/dev/null") != 0)
    GTEST_SKIP() << "skipped: a file system of a stated size cannot be mounted here";
  struct Unmount {
    std::string at;
    ~Unmount() { shell("umount '" + at + "'"); }
  } const unmount{small};
  const auto full = laterna(words + "small/set", scratch.path());
  EXPECT_EQ(full.exit_code, 2);
  EXPECT_THAT(full.err, HasSubstr("No space left on device"));
  EXPECT_THAT(full.err, HasSubstr("--resume goes on\n"));
  expect_nothing_partial(scratch / "small/set");
  ASSERT_EQ(shell("mount -o remount,size=64m '" + small + "'"), 0);
  const auto resumed = laterna(words + "small/set --resume", scratch.path());
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  expect_same_set(scratch / "small/set", scratch / "whole");
}

TEST(Command, DatasetSaysWhatIsWrong) {
  const ScratchFolder scratch;
  write_tiny_spec(scratch.path());
  for (const char* bad : {"--shard 4/3", "--shard x", "--shard 1/0", "--count 0", "--count -1"}) {
    const auto run = laterna("dataset spec.toml -o set --count 6 " + std::string(bad), scratch.path());
    EXPECT_EQ(run.exit_code, 2) << bad;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_FALSE(fs::exists(scratch / "set")) << bad;
  }
  write_text(scratch / "bad.toml", tiny_spec + "\"camera.fov_deg\" = { uniform = [1, 2] }\n");
  const auto unknown = laterna("dataset bad.toml -o set --count 6", scratch.path());
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("bad.toml:24: random \"camera.fov_deg\""));
  EXPECT_EQ(laterna("dataset none.toml -o set --count 6", scratch.path()).exit_code, 2);
  EXPECT_EQ(laterna("dataset spec.toml -o set --count 6 --merge", scratch.path()).exit_code, 2);
  EXPECT_FALSE(fs::exists(scratch / "set"));
}

}  // namespace
}  // namespace laterna::testing
