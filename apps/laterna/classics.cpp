#include "apps/lab/classics/classics.h"
#include "apps/laterna/command.h"

#include <fmt/format.h>

namespace laterna {

void add_classics(CLI::App& app, Common& common) {
  struct Words {
    std::vector<std::string> names;
    std::string scenes, out;
  };
  auto words = std::make_shared<Words>();
  CLI::App* command = add_command(
      app, "classics", "laterna classics slide_projector -o classics",
      "The classic systems of projective textures, each with what must be seen: pictures, charts, and "
      "classics.json with\nits figures. data/classics/README.md shows them all.");
  command->add_option("NAME", words->names, "Classics by name; absent: all");
  command->add_option("-o,--output", words->out, "Folder for the results, new")->required();
  command->add_option("--scenes", words->scenes, "Folder of their scenes (default: data/classics)")
      ->default_str("data/classics");
  command->callback([words, &common] {
    const auto classics = find_classics(words->names);
    const auto made = make_classics(classics, words->scenes.empty() ? "data/classics" : words->scenes);
    write_classics(made, words->out);
    if (common.json)
      fmt::print("{}\n", classics_json(made).dump());
    else
      fmt::print("{}open {}\n", classics_text(made), words->out);
  });
}

}  // namespace laterna
