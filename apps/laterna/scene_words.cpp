#include "apps/laterna/scene_words.h"

namespace laterna {

CLI::Option* add_scene_words(CLI::App& command, SceneWords& words) {
  CLI::Option* scene = command.add_option("SCENE", words.file, "Scene file (TOML)")->required();
  command
      .add_option("--set", words.set,
                  "KEY=VALUE: a key of the scene at another value, as effects.shadow=false or "
                  "projector.0.fx=1500; may be given several times")
      ->allow_extra_args(false);
  return scene;
}

}  // namespace laterna
