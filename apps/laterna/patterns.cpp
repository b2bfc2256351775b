#include "apps/laterna/pattern_words.h"

#include "render/effects/apply_effects.h"
#include "sim/error.h"
#include "sim/image_file.h"
#include "sim/parallel.h"
#include "sim/safe_write.h"
#include "sim/scene_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace laterna {

namespace {

struct Words {
  std::string scene, size, projector, out;
  PatternParameters patterns;
};

/// The scene's family for its projector, or that of the command line for --size.
PatternSequence sequence_of(const Words& words) {
  if (!words.size.empty()) {
    const auto size = parse_size(words.size, "--size");
    return {words.patterns, {size[0], size[1]}};
  }
  if (words.scene.empty())
    throw InputError("patterns: found neither a scene nor --size, expected one of them");
  const Scene scene = load_scene(words.scene);
  for (const Projector& p : scene.projectors) {
    if (words.projector.empty() || p.device.name == words.projector) return pattern_sequence(scene, p);
  }
  throw InputError(fmt::format("{}: no projector \"{}\"", words.scene, words.projector));
}

/// "column-bit-9-inverse" of "column bit 9 inverse".
std::string file_name(const PatternSequence& sequence, int k) {
  if (sequence.parameters == PatternParameters{}) return fmt::format("graycode_{:02}.png", k);
  std::string name;
  for (const char c : picture_name(sequence, k))
    if (c != ',') name += c == ' ' ? '-' : c;
  return fmt::format("{:03}_{}.png", k, name);
}

}  // namespace

void add_patterns(CLI::App& app, Common& common) {
  auto words = std::make_shared<Words>();
  CLI::App* command =
      add_command(app, "patterns", "laterna patterns --size 1920x1080 -o patterns",
                  "Writes the pictures that a real projector should show, in order, into a new folder.");
  command->add_option("SCENE", words->scene, "Scene whose projector and [patterns] are taken");
  command->add_option("--size", words->size, "Size of the projector, WIDTHxHEIGHT, in place of a scene");
  command->add_option("--projector", words->projector, "Which projector of the scene (default: the first)");
  add_pattern_words(*command, words->patterns);
  command->add_option("-o,--output", words->out, "New folder")->required();
  command->callback([words, &common] {
    const PatternSequence sequence = sequence_of(*words);
    validate(sequence);
    PendingFolder folder(words->out);
    const int count = picture_count(sequence);
    parallel_for(std::size_t(count), [&](std::size_t k) {
      write_picture(folder.path() / file_name(sequence, int(k)), pattern_picture(sequence, int(k)));
    });
    folder.commit();
    if (common.json) {
      fmt::print("{}\n", nlohmann::json{{"folder", words->out}, {"pictures", count}}.dump());
      return;
    }
    fmt::print(
        "{} pictures of {} × {} px: show them full screen, unscaled, in the order of their names\nopen "
        "{}/{}\n",
        count, sequence.projector_size.x, sequence.projector_size.y, words->out, file_name(sequence, 0));
  });
}

}  // namespace laterna
