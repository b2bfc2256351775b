#include "apps/laterna/command.h"

#include "sim/scene_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace laterna {

void add_check(CLI::App& app, Common& common) {
  auto scene = std::make_shared<std::string>();
  CLI::App* command = add_command(app, "check", "laterna check scene.toml",
                                  "Reads a scene and everything it names, and says what it holds, or in one "
                                  "sentence what is wrong with it.");
  command->add_option("SCENE", *scene, "Scene file (TOML)")->required();
  command->callback([scene, &common] {
    const Scene loaded = load_scene(*scene);
    std::size_t triangles = 0;
    for (const Object& object : loaded.objects) triangles += object.mesh.triangles.size();
    if (common.json) {
      fmt::print("{}\n", nlohmann::json{{"status", "ok"},
                                        {"meshes", loaded.objects.size()},
                                        {"triangles", triangles},
                                        {"projectors", loaded.projectors.size()},
                                        {"cameras", loaded.cameras.size()}}
                             .dump());
      return;
    }
    fmt::print("{}: sound: {} mesh(es) with {} triangles, {} projector(s), {} camera(s)\n", *scene,
               loaded.objects.size(), triangles, loaded.projectors.size(), loaded.cameras.size());
  });
}

}  // namespace laterna
