#include "sim/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

namespace laterna {

namespace {

void expect(int error, const std::string& what) {
  if (error != 0) throw std::system_error(error, std::generic_category(), what);
}

/// Both ends are closed on exec, unless a process takes one as its standard output.
struct Pipe {
  int read_end = -1, write_end = -1;
  Pipe() {
    std::array<int, 2> ends{};
    expect(::pipe2(ends.data(), O_CLOEXEC) == 0 ? 0 : errno, "a pipe");
    read_end = ends[0];
    write_end = ends[1];
  }
  ~Pipe() {
    close_write_end();
    ::close(read_end);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close_write_end() {
    if (write_end >= 0) ::close(write_end);
    write_end = -1;
  }
};

struct FileActions {
  posix_spawn_file_actions_t actions{};
  FileActions() { expect(::posix_spawn_file_actions_init(&actions), "posix_spawn"); }
  ~FileActions() { ::posix_spawn_file_actions_destroy(&actions); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
};

pid_t spawn(const std::string& program, const std::vector<std::string>& arguments, int output, int errors) {
  FileActions files;
  expect(::posix_spawn_file_actions_addopen(&files.actions, 0, "/dev/null", O_RDONLY, 0), program);
  expect(::posix_spawn_file_actions_adddup2(&files.actions, output, 1), program);
  expect(::posix_spawn_file_actions_adddup2(&files.actions, errors, 2), program);
  std::vector<char*> words = {const_cast<char*>(program.c_str())};  // posix_spawn does not write to them
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  pid_t child = 0;
  expect(::posix_spawn(&child, program.c_str(), &files.actions, nullptr, words.data(), environ), program);
  return child;
}

/// Appends what is there to read; false at the end.
bool drain(int file, std::string& text) {
  std::array<char, 65536> bytes{};
  const ssize_t count = ::read(file, bytes.data(), bytes.size());
  if (count < 0) return errno == EINTR;
  text.append(bytes.data(), std::size_t(count));
  return count > 0;
}

/// Reads both pipes as they fill: one that is left alone stops the child.
void read_both(int output, int errors, ChildOutcome& outcome) {
  std::array<pollfd, 2> open = {pollfd{output, POLLIN, 0}, pollfd{errors, POLLIN, 0}};
  while (open[0].fd >= 0 || open[1].fd >= 0) {
    if (::poll(open.data(), open.size(), -1) < 0) continue;  // interrupted by a signal
    if (open[0].revents != 0 && !drain(output, outcome.output)) open[0].fd = -1;
    if (open[1].revents != 0 && !drain(errors, outcome.errors)) open[1].fd = -1;
  }
}

}  // namespace

ChildOutcome run_child(const std::filesystem::path& program, const std::vector<std::string>& arguments) {
  Pipe output, errors;
  const pid_t child = spawn(program.string(), arguments, output.write_end, errors.write_end);
  output.close_write_end();
  errors.close_write_end();
  ChildOutcome outcome;
  read_both(output.read_end, errors.read_end, outcome);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) expect(errno, program.string());
  if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
  if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
  return outcome;
}

}  // namespace laterna
