// Calls the command as a person would.
#pragma once

#include <filesystem>
#include <string>

namespace laterna::testing {

struct CommandResult {
  int exit_code = -1;
  std::string out, err;
};

/// Runs `laterna WORDS` in a folder, by a shell, with `input` on standard input; `before` are shell words
/// that run first.
CommandResult laterna(const std::string& words, const std::filesystem::path& folder,
                      const std::string& input = "", const std::string& before = "");

/// Where the command stands, for what calls it by other means.
std::string laterna_path();

/// The whole of a file.
std::string read_text(const std::filesystem::path& path);

/// Every name in a folder, sorted, each followed by a space.
std::string listing(const std::filesystem::path& folder);

}  // namespace laterna::testing
