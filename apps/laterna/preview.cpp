#include "apps/laterna/command.h"
#include "apps/laterna/scene_words.h"

#include "apps/lab/preview.h"
#include "sim/scene_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace laterna {

namespace {

nlohmann::json overlap_json(const Scene& scene, const Traced& traced) {
  auto views = nlohmann::json::array();
  for (const View& view : traced.views) {
    const Overlap share = overlap(scene, traced, view);
    views.push_back({{"camera", scene.cameras[view.camera].device.name},
                     {"projector", scene.projectors[view.projector].device.name},
                     {"camera_lit_percent", share.camera_lit},
                     {"projector_seen_percent", share.projector_seen}});
  }
  return {{"overlap", views}};
}

}  // namespace

void add_preview(CLI::App& app, Common& common) {
  struct Words {
    SceneWords scene;
    std::string out;
  };
  auto words = std::make_shared<Words>();
  CLI::App* command = add_command(
      app, "preview", "laterna preview scene.toml -o rig.png",
      "Draws the rig in one picture: meshes, frusta, what is lit and seen, and the overlap in per cent.");
  add_scene_words(*command, words->scene);
  command->add_option("-o,--output", words->out, "Picture to write (default: preview.png)")
      ->default_str("preview.png");
  command->callback([words, &common] {
    const Scene scene = load_scene(words->scene.file, words->scene.set);
    StageTimes times;
    const Traced traced = trace(scene, times, [&](const std::string& line) { progress(common, line); });
    write_canvas(words->out.empty() ? "preview.png" : words->out, preview_picture(scene, traced));
    if (common.json) {
      fmt::print("{}\n", overlap_json(scene, traced).dump());
      return;
    }
    fmt::print("{}open {}\n", overlap_text(scene, traced), words->out.empty() ? "preview.png" : words->out);
  });
}

}  // namespace laterna
