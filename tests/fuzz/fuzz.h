// What the fuzz targets share. Each target is one reader: fuzz/NAME_fuzz.cpp, with seeds in fuzz/seeds/NAME.
#pragma once

#include "sim/error.h"

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

namespace laterna::fuzz {

inline std::string_view text_of(const std::uint8_t* bytes, std::size_t count) {
  return {reinterpret_cast<const char*>(bytes), count};
}

/// Runs a reader; an InputError is a right answer to bad bytes. Anything else that is thrown ends the
/// program, which is what the fuzzer looks for.
template <class Read>
int attempt(Read&& read) {
  try {
    read();
  } catch (const InputError&) {  // one sentence is all that bad bytes may lead to
  }
  return 0;
}

/// Ends the program where something that must hold does not.
inline void expect(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

/// A folder in memory of this process's own, gone when the process ends, also by exit() (libFuzzer's way).
/// What a crash, a timeout or a kill leaves, the next fuzzer that starts removes: folders of processes that
/// are no more.
class ScratchFolder {
 public:
  ScratchFolder() {
    for (const auto& entry : std::filesystem::directory_iterator("/dev/shm")) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with(prefix) && is_gone(name.substr(prefix.size()))) remove(entry.path());
    }
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() { remove(path_); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  static bool is_gone(const std::string& process) {
    const long id = std::strtol(process.c_str(), nullptr, 10);
    return id > 0 && ::kill(pid_t(id), 0) != 0 && errno == ESRCH;
  }
  static void remove(const std::filesystem::path& folder) {
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
  }

  static constexpr std::string_view prefix = "laterna-fuzz-";
  std::filesystem::path path_ =
      std::filesystem::path("/dev/shm") / (std::string(prefix) + std::to_string(::getpid()));
};

/// The process's own folder, made when it is first asked for.
inline const std::filesystem::path& scratch() {
  static const ScratchFolder folder;
  return folder.path();
}

/// A file in memory with these bytes, for readers that take a path; one for each ending.
inline std::filesystem::path file_with(std::string_view bytes, const std::string& ending) {
  std::filesystem::path path = scratch() / ("file" + ending);
  std::FILE* file = std::fopen(path.c_str(), "wb");
  expect(file != nullptr, "a file in /dev/shm can be written");
  expect(std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size(), "all of it is written");
  std::fclose(file);
  return path;
}

}  // namespace laterna::fuzz
