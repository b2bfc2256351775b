#include "apps/laterna/command.h"
#include "apps/laterna/scene_words.h"

#include "apps/lab/render_picture.h"
#include "sim/scene_file.h"
#include "sim/scene_limits.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace laterna {

void add_render(CLI::App& app, Common& common) {
  struct Words {
    SceneWords scene;
    std::string out, show, kind;
    RenderOptions options;
  };
  auto words = std::make_shared<Words>();
  CLI::App* command = add_command(
      app, "render", "laterna render scene.toml --as photo -o photo.png",
      "One picture. photo: what the camera takes of the projector's picture. dual: the scene from the "
      "projector's seat, lit by\nthe camera (dual photography). bake: a photograph reprojected onto a mesh's "
      "own texture. An .exr holds numbers\n(apps/lab/render_picture.h).");
  add_scene_words(*command, words->scene);
  command->add_option("--as", words->kind, "photo, dual or bake")->required();
  command->add_option("-o,--output", words->out, "Picture: .png, .tif, .pgm or .exr")->required();
  command->add_option("--show", words->show,
                      "Linear grey picture that the projector (photo) or the camera (dual) sends out, or the "
                      "photograph (bake); absent: white, or the photo");
  command->add_option("--camera", words->options.camera, "Name of a camera; absent: the first");
  command->add_option("--projector", words->options.projector, "Name of a projector; absent: the first");
  command->add_option("--mesh", words->options.mesh, "bake: name of a mesh; absent: the first with texture");
  command->add_option("--texture-size", words->options.texture_px, "bake: texels along each side")
      ->capture_default_str();
  command
      ->add_option("--samples", words->options.samples_per_pixel,
                   "Rays per camera pixel; 0: the scene's (dual: at least 16)")
      ->check(CLI::Range(0, most_samples_per_pixel));
  command->callback([words, &common] {
    words->options.kind = render_kind_of(words->kind);
    words->options.show = words->show;
    words->options.seed = common.seed;
    StageTimes times;
    render_picture(load_scene(words->scene.file, words->scene.set), words->options, words->out, times);
    if (common.json)
      fmt::print("{}\n", nlohmann::json{{"picture", words->out}, {"seconds", times.total()}}.dump());
    else
      fmt::print("open {}\n", words->out);
  });
}

}  // namespace laterna
