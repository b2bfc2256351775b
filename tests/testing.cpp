#include "tests/testing.h"

#include "sim/instruction_sets.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iostream>

namespace laterna::testing {

namespace {

std::string test_name() {
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  return std::string(info->test_suite_name()) + "." + info->name();
}

}  // namespace

std::uint64_t seed() {
  std::uint64_t hash = 14695981039346656037ull;  // FNV-1a, 64 bit
  for (const unsigned char c : test_name()) hash = (hash ^ c) * 1099511628211ull;
  return hash;
}

std::filesystem::path data_folder() { return LATERNA_SOURCE_DIR "/data"; }

std::mt19937_64 generator() { return std::mt19937_64(seed()); }

ScratchFolder::ScratchFolder() {
  std::string name = test_name() + "-" + std::to_string(::getpid());
  for (char& c : name)
    if (c == '/') c = '_';
  path_ = std::filesystem::temp_directory_path() / "laterna-tests" / name;
  std::filesystem::remove_all(path_);
  std::filesystem::create_directories(path_);
}

ScratchFolder::~ScratchFolder() {
  if (::testing::Test::HasFailure()) {
    std::cerr << "kept for a look: " << path_ << "\n";
    return;
  }
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

std::vector<std::string> instruction_sets_here() {
  const CapLifter lifter;
  std::vector<std::string> here;
  for (const std::string& name : instruction_set_names()) {
    cap_instruction_set(name);
    if (instruction_set() == name) here.push_back(name);
  }
  return here;
}

CapLifter::~CapLifter() { cap_instruction_set(""); }

}  // namespace laterna::testing
