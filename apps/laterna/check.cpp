#include "apps/laterna/command.h"
#include "apps/laterna/scene_words.h"

#include "sim/believed.h"
#include "sim/scene_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace laterna {

void add_check(CLI::App& app, Common& common) {
  auto scene = std::make_shared<SceneWords>();
  CLI::App* command = add_command(app, "check", "laterna check scene.toml",
                                  "Reads a scene and everything it names, and says what it holds, or in one "
                                  "sentence what is wrong with it.");
  add_scene_words(*command, *scene);
  command->callback([scene, &common] {
    const Scene loaded = load_scene(scene->file, scene->set);
    std::size_t triangles = 0;
    for (const Object& object : loaded.objects) triangles += object.mesh.triangles.size();
    std::optional<Scene> storage;
    believed(loaded, storage);  // it can be made
    const auto differs = [&](const auto& noun) { return believed_otherwise(loaded, noun); };
    const auto meshes = std::count_if(loaded.objects.begin(), loaded.objects.end(), differs);
    const auto cameras = std::count_if(loaded.cameras.begin(), loaded.cameras.end(), differs);
    const auto uncertain = std::count_if(loaded.cameras.begin(), loaded.cameras.end(), [&](const Camera& c) {
      return !told_covariance(loaded, c).empty();
    });
    if (common.json) {
      fmt::print("{}\n", nlohmann::json{{"status", "ok"},
                                        {"meshes", loaded.objects.size()},
                                        {"triangles", triangles},
                                        {"projectors", loaded.projectors.size()},
                                        {"cameras", loaded.cameras.size()},
                                        {"meshes_believed_otherwise", meshes},
                                        {"cameras_believed_otherwise", cameras},
                                        {"cameras_uncertain", uncertain}}
                             .dump());
      return;
    }
    fmt::print("{}: sound: {} mesh(es) with {} triangles, {} projector(s), {} camera(s)\n", scene->file,
               loaded.objects.size(), triangles, loaded.projectors.size(), loaded.cameras.size());
    if (meshes + cameras + uncertain > 0)
      fmt::print(
          "the solver is told otherwise of {} mesh(es) and {} camera(s), and that {} camera(s) are "
          "uncertain\n",
          meshes, cameras, uncertain);
  });
}

}  // namespace laterna
