// What the tests share: seeds from the test's name, a scratch folder, pictures kept on failure.
#pragma once

#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace laterna::testing {

/// A seed made from the running test's full name ("Suite.Case"), so that tests never share a stream.
std::uint64_t seed();

/// A generator seeded with seed().
std::mt19937_64 generator();

/// A folder of this test's own, empty when the test starts. Removed with the object, but kept where the test
/// failed.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// The folder `data` of the sources.
std::filesystem::path data_folder();

/// Writes a text file and returns its path.
std::filesystem::path write_text(const std::filesystem::path& path, const std::string& text);

/// The names of the instruction sets that this machine has, without those that do the same as a narrower one;
/// the caller sees to it that the cap is lifted in the end (CapLifter).
std::vector<std::string> instruction_sets_here();

/// Lifts the cap on the instruction set when it goes.
struct CapLifter {
  ~CapLifter();
};

/// The message of the InputError that `action` throws; fails the test where it throws none.
template <class Action>
std::string input_error(Action&& action);

}  // namespace laterna::testing

#include "sim/error.h"

#include <gtest/gtest.h>

template <class Action>
std::string laterna::testing::input_error(Action&& action) {
  try {
    action();
  } catch (const laterna::InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no InputError was thrown";
  return {};
}
