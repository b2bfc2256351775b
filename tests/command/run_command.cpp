#include "tests/command/run_command.h"

#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

namespace laterna::testing {

std::string read_text(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::string laterna_path() { return LATERNA_COMMAND; }

CommandResult laterna(const std::string& words, const std::filesystem::path& folder, const std::string& input,
                      const std::string& before) {
  const std::filesystem::path scratch = folder.string() + ".std";
  std::filesystem::create_directories(scratch);
  std::ofstream(scratch / "in", std::ios::binary) << input;
  const std::string line = before + "cd '" + folder.string() + "' && '" LATERNA_COMMAND "' " + words + " <'" +
                           (scratch / "in").string() + "' >'" + (scratch / "out").string() + "' 2>'" +
                           (scratch / "err").string() + "'";
  const int status = std::system(line.c_str());
  CommandResult result{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(scratch / "out"),
                       read_text(scratch / "err")};
  std::filesystem::remove_all(scratch);
  return result;
}

std::string listing(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.insert(entry.path().filename().string());
  std::string text;
  for (const std::string& name : names) text += name + " ";
  return text;
}

}  // namespace laterna::testing
