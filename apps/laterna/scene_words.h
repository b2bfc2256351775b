// What every command that reads a scene takes.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace laterna {

/// A scene file, and keys of it set to other values, as parse_scene() takes them (sim/scene_file.h).
struct SceneWords {
  std::string file;
  std::vector<std::string> set;
};

/// SCENE, required, and --set KEY=VALUE, any number of times. Gives back SCENE.
CLI::Option* add_scene_words(CLI::App& command, SceneWords& words);

}  // namespace laterna
