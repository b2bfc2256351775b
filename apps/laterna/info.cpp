#include "apps/laterna/command.h"
#include "apps/laterna/scene_words.h"

#include "apps/lab/matrices.h"
#include "sim/scene_file.h"
#include "sim/scene_reference.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace laterna {

void add_info(CLI::App& app, Common& common) {
  struct Words {
    SceneWords scene;
    bool reference = false;
  };
  auto words = std::make_shared<Words>();
  CLI::App* command = add_command(
      app, "info", "laterna info scene.toml --json",
      "Prints each device's B, P, V and T. JSON: {\"projectors\":[{\"name\",\"size\",\"texture_from_clip\",\n"
      "\"clip_from_projector\",\"projector_from_world\",\"texture_from_world\"}],\"cameras\":[...]}, "
      "matrices row-major.");
  auto* scene = add_scene_words(*command, words->scene)->required(false);
  auto* reference = command->add_flag("--scene-reference", words->reference,
                                      "Prints the reference of all scene keys (Markdown) instead");
  scene->excludes(reference);
  command->callback([words, &common] {
    if (words->reference) {
      fmt::print("{}", scene_reference_markdown());
      return;
    }
    if (words->scene.file.empty()) throw CLI::RequiredError("SCENE");
    const Scene loaded = load_scene(words->scene.file, words->scene.set);
    fmt::print("{}", common.json ? matrices_json(loaded).dump() + "\n" : matrices_text(loaded));
  });
}

}  // namespace laterna
