#include "apps/laterna/command.h"

#include "sim/error.h"
#include "sim/image_file.h"
#include "sim/parallel.h"
#include "sim/pattern.h"
#include "sim/safe_write.h"
#include "sim/scene_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace laterna {

namespace {

glm::ivec2 projector_size(const std::string& scene_file, const std::string& size_text,
                          const std::string& name) {
  if (!size_text.empty()) {
    const auto size = parse_size(size_text, "--size");
    return {size[0], size[1]};
  }
  if (scene_file.empty())
    throw InputError("patterns: found neither a scene nor --size, expected one of them");
  const Scene scene = load_scene(scene_file);
  for (const Projector& p : scene.projectors) {
    if (name.empty() || p.device.name == name) return p.device.intrinsics.size;
  }
  throw InputError(fmt::format("{}: no projector \"{}\"", scene_file, name));
}

}  // namespace

void add_patterns(CLI::App& app, Common& common) {
  struct Words {
    std::string scene, size, projector, out;
  };
  auto words = std::make_shared<Words>();
  CLI::App* command =
      add_command(app, "patterns", "laterna patterns --size 1920x1080 -o patterns",
                  "Writes the pictures that a real projector should show, in order, into a new folder.");
  command->add_option("SCENE", words->scene, "Scene whose projector gives the size");
  command->add_option("--size", words->size, "Size of the projector, WIDTHxHEIGHT, in place of a scene");
  command->add_option("--projector", words->projector, "Which projector of the scene (default: the first)");
  command->add_option("-o,--output", words->out, "New folder")->required();
  command->callback([words, &common] {
    const GraySequence sequence{projector_size(words->scene, words->size, words->projector)};
    validate(sequence);
    PendingFolder folder(words->out);
    const int count = picture_count(sequence);
    parallel_for(std::size_t(count), [&](std::size_t k) {
      write_picture(folder.path() / fmt::format("graycode_{:02}.png", k), pattern_picture(sequence, int(k)));
    });
    folder.commit();
    if (common.json) {
      fmt::print("{}\n", nlohmann::json{{"folder", words->out}, {"pictures", count}}.dump());
      return;
    }
    fmt::print(
        "{} pictures of {} × {} px: show them full screen, unscaled, in the order of their names\nopen "
        "{}/graycode_00.png\n",
        count, sequence.projector_size.x, sequence.projector_size.y, words->out);
  });
}

}  // namespace laterna
