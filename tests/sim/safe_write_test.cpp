#include "sim/safe_write.h"

#include "tests/testing.h"

#include <gmock/gmock.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>

namespace laterna {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::input_error;
using testing::ScratchFolder;

std::string read_text(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::size_t entries(const fs::path& folder) {
  return std::size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

/// Files cannot grow beyond `bytes` while this lives.
struct FileSizeLimit {
  struct rlimit before {};
  void (*handler)(int);
  explicit FileSizeLimit(rlim_t bytes) : handler(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before);
    const struct rlimit limit {
      bytes, before.rlim_max
    };
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
};

/// The id of a process that is no more.
pid_t dead_process() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  return child;
}

TEST(WriteFile, LeavesTheBytesAndNothingElse) {
  const ScratchFolder folder;
  const std::string bytes("a\0b\n", 4);
  write_file(folder / "x.bin", bytes);
  EXPECT_EQ(read_text(folder / "x.bin"), bytes);
  write_file(folder / "x.bin", "");
  EXPECT_EQ(read_text(folder / "x.bin"), "");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(WriteFile, KeepsTheOldFileWhereTheNewOneFails) {
  const ScratchFolder folder;
  write_file(folder / "x.bin", "old");
  {
    const FileSizeLimit limit(100);
    const std::string sentence = input_error([&] { write_file(folder / "x.bin", std::string(1000, 'n')); });
    EXPECT_THAT(sentence, AllOf(HasSubstr("x.bin: cannot be written"), HasSubstr("File too large")));
  }
  EXPECT_EQ(read_text(folder / "x.bin"), "old");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(WriteFile, SaysThatTheDiskIsFull) {
  const ScratchFolder folder;
  if (::mount("tmpfs", folder.path().c_str(), "tmpfs", 0, "size=64k") != 0)
    GTEST_SKIP() << "this user may not mount a small disk";
  const std::string sentence = input_error([&] { write_file(folder / "x.bin", std::string(200000, 'n')); });
  const std::size_t left = entries(folder.path());
  ::umount2(folder.path().c_str(), MNT_DETACH);
  EXPECT_THAT(sentence, AllOf(HasSubstr("x.bin: cannot be written"), HasSubstr("No space left on device")));
  EXPECT_EQ(left, 0u);
}

TEST(WriteFile, RefusesWhatIsNoFile) {
  const ScratchFolder folder;
  EXPECT_THAT(input_error([&] { write_file(folder.path(), "x"); }), HasSubstr("no regular file"));
  EXPECT_THAT(input_error([] { write_file("/dev/null", "x"); }), HasSubstr("no regular file"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_THAT(input_error([&] { write_file(folder / "missing/x", "x"); }), HasSubstr("No such file"));
}

TEST(PendingFolder, AppearsWhenCommitted) {
  const ScratchFolder folder;
  PendingFolder pending(folder / "out/");  // a trailing slash changes nothing
  write_file(pending.path() / "x.txt", "x");
  EXPECT_FALSE(fs::exists(folder / "out"));
  EXPECT_EQ(pending.path().parent_path(), folder.path()) << "beside it: a rename does not cross file systems";
  pending.commit();
  EXPECT_EQ(read_text(folder / "out/x.txt"), "x");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(WriteFile, PartsStandOneBehindTheOther) {
  const ScratchFolder folder;
  write_file(folder / "file", {"ab", "", "cde"});
  EXPECT_EQ(read_text(folder / "file"), "abcde");
}

TEST(PendingFolder, LeavesNothingWhereItIsNotCommitted) {
  const ScratchFolder folder;
  {
    const PendingFolder pending(folder / "out");
    write_file(pending.path() / "x.txt", "x");
  }
  EXPECT_EQ(entries(folder.path()), 0u);
}

TEST(PendingFolder, RefusesAFolderThatExists) {
  const ScratchFolder folder;
  fs::create_directory(folder / "out");
  EXPECT_THAT(input_error([&] { PendingFolder(folder / "out"); }),
              HasSubstr("out exists already, expected a new folder"));
  fs::create_symlink("nowhere", folder / "link");
  EXPECT_THAT(input_error([&] { PendingFolder(folder / "link"); }), HasSubstr("exists already"));
  EXPECT_THAT(input_error([&] { PendingFolder(folder / "a/b"); }), HasSubstr("parent folder"));
  EXPECT_THAT(input_error([&] { PendingFolder("/"); }), HasSubstr("exists already"));
}

TEST(PendingFolder, NeverReplacesWhatCameMeanwhile) {
  const ScratchFolder folder;
  {
    PendingFolder pending(folder / "out");
    fs::create_directory(folder / "out");  // empty: rename(2) would replace it
    EXPECT_THAT(input_error([&] { pending.commit(); }), HasSubstr("exists already"));
  }
  EXPECT_TRUE(fs::is_empty(folder / "out"));
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(PendingFolder, RemovesWhatADeadProcessLeftAndNothingElse) {
  const ScratchFolder folder;
  const fs::path stale = folder / (".out.partial-" + std::to_string(dead_process()));
  const fs::path of_another = folder / (".other.partial-" + std::to_string(dead_process()));
  const fs::path alive = folder / (".out.partial-" + std::to_string(::getppid()));
  const fs::path no_process = folder / ".out.partial-notes";
  for (const fs::path& path : {stale, of_another, alive, no_process}) fs::create_directory(path);
  const PendingFolder pending(folder / "out");
  EXPECT_FALSE(fs::exists(stale));
  for (const fs::path& path : {of_another, alive, no_process}) EXPECT_TRUE(fs::exists(path)) << path;
}

}  // namespace
}  // namespace laterna
