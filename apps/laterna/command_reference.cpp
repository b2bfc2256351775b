#include "apps/laterna/command.h"

#include <fmt/format.h>

namespace laterna {

std::string command_reference_markdown(const CLI::App& app) {
  std::string page =
      "# The command, word by word\n\n"
      "What `laterna --help` and each subcommand's `--help` print, made by `laterna --command-reference`.\n\n"
      "Exit codes: 0 ok, 1 internal error, 2 bad input, 3 refused (the data cannot tell), 4 weak (they tell "
      "less than was "
      "asked), 5 interrupted (`--resume` goes on).\n";
  page += fmt::format("\n## laterna\n\n```\n{}```\n", app.help());
  for (const CLI::App* command : app.get_subcommands({}))
    page += fmt::format("\n## laterna {}\n\n```\n{}```\n", command->get_name(), command->help("laterna"));
  return page;
}

}  // namespace laterna
