// What the fuzz targets share. Each target is one reader: fuzz/NAME_fuzz.cpp, with seeds in fuzz/seeds/NAME.
#pragma once

#include "sim/error.h"

#include <unistd.h>

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

/// A file in memory with these bytes, for readers that take a path; one for each process and ending.
inline std::filesystem::path file_with(std::string_view bytes, const std::string& ending) {
  std::filesystem::path path = "/dev/shm/laterna-fuzz-" + std::to_string(::getpid()) + ending;
  std::FILE* file = std::fopen(path.c_str(), "wb");
  expect(file != nullptr, "a file in /dev/shm can be written");
  expect(std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size(), "all of it is written");
  std::fclose(file);
  return path;
}

}  // namespace laterna::fuzz
