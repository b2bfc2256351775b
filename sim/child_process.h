// Runs a program as a process of its own, so that its crash is not ours.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace laterna {

/// What a process left.
struct ChildOutcome {
  int exit_code = 0;   ///< where no signal ended it
  int signal = 0;      ///< that ended it; 0: none did
  std::string output;  ///< what it wrote on standard output
  std::string errors;  ///< what it wrote on standard error
};

/// Runs `program` (a path; PATH is not searched) with these arguments and nothing on standard input, to its
/// end. Throws std::system_error where it cannot be started. Any thread may call it.
ChildOutcome run_child(const std::filesystem::path& program, const std::vector<std::string>& arguments);

}  // namespace laterna
