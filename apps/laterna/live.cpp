#include "apps/lab/live_page.h"
#include "apps/laterna/command.h"
#include "apps/laterna/scene_words.h"
#include "sim/safe_write.h"
#include "sim/scene_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace laterna {

void add_live(CLI::App& app, Common& common) {
  struct Words {
    SceneWords scene;
    std::string out = "live.html";
  };
  auto words = std::make_shared<Words>();
  CLI::App* command = add_command(app, "live", "laterna live scene.toml -o live.html",
                                  "Writes one HTML page that draws the scene in the browser, offline: move "
                                  "and turn projector and camera, "
                                  "choose the slide,\nswitch the border, back faces, shadow and the q > 0 "
                                  "test. With --json, prints the data "
                                  "that the page holds, and writes nothing.");
  add_scene_words(*command, words->scene);
  command->add_option("-o,--output", words->out, "Page to write, replaced where it exists")
      ->capture_default_str();
  command->callback([words, &common] {
    const Scene scene = load_scene(words->scene.file, words->scene.set);
    const nlohmann::json data = live_json(scene, std::filesystem::path(words->scene.file).stem().string());
    if (const std::string missing = live_omissions(scene); !missing.empty()) progress(common, missing);
    if (common.json) {
      fmt::print("{}\n", data.dump());
      return;
    }
    write_file(words->out, live_page(data));
    fmt::print("open {}\n", words->out);
  });
}

}  // namespace laterna
