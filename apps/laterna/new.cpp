#include "apps/laterna/command.h"

#include "sim/new_scene.h"

#include <fmt/format.h>

namespace laterna {

void add_new(CLI::App& app, Common&) {
  CLI::App* command = add_command(
      app, "new", "laterna new > scene.toml",
      "Prints a commented scene that needs no other file: a projector, a camera, a surface in relief.");
  command->callback([] { fmt::print("{}", new_scene_text()); });
}

}  // namespace laterna
