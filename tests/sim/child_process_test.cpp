#include "sim/child_process.h"

#include "sim/run_path.h"

#include <gtest/gtest.h>

#include <csignal>
#include <stdexcept>
#include <system_error>

namespace laterna {
namespace {

ChildOutcome run_shell(const std::string& line) { return run_child("/bin/sh", {"-c", line}); }

TEST(ChildProcess, KeepsWhatItWroteAndHowItEnded) {
  const ChildOutcome outcome = run_shell("echo one; echo two >&2; exit 7");
  EXPECT_EQ(outcome.output, "one\n");
  EXPECT_EQ(outcome.errors, "two\n");
  EXPECT_EQ(outcome.exit_code, 7);
  EXPECT_EQ(outcome.signal, 0);
}

TEST(ChildProcess, NamesTheSignalThatEndedIt) { EXPECT_EQ(run_shell("kill -SEGV $$").signal, SIGSEGV); }

// Far more than a pipe holds (64 KiB), first on one, then on the other.
TEST(ChildProcess, ReadsBothOutputsAsTheyFill) {
  const ChildOutcome outcome = run_shell("head -c 1000000 /dev/zero >&2; head -c 1000000 /dev/zero");
  EXPECT_EQ(outcome.output.size(), 1000000u);
  EXPECT_EQ(outcome.errors.size(), 1000000u);
}

TEST(ChildProcess, GetsNothingToRead) { EXPECT_EQ(run_shell("cat").output, ""); }

TEST(ChildProcess, ArgumentsAreNotSplit) {
  EXPECT_EQ(run_child("/bin/echo", {"a  b", "$HOME"}).output, "a  b $HOME\n");
}

TEST(ChildProcess, SaysWhereThereIsNoProgram) {
  EXPECT_THROW(run_child("/there/is/none", {}), std::system_error);
}

TEST(RunPath, FindsTheMeshReaderAndNothingElse) {
  EXPECT_EQ(run_child(find_on_run_path("laterna-mesh-reader"), {}).exit_code, 2);  // no file was named
  EXPECT_THROW(find_on_run_path("there-is-none"), std::runtime_error);
}

}  // namespace
}  // namespace laterna
