#include "apps/lab/atlas/atlas.h"
#include "apps/laterna/command.h"
#include "sim/error.h"
#include "sim/safe_write.h"

#include <fmt/format.h>

namespace laterna {

namespace {

struct Words {
  std::string spec, out;
  AtlasOptions options;
};

int run(Words& words, const Common& common) {
  const StopSignals signals;  // until the results are written
  words.options.seed = common.seed;
  const Atlas atlas = run_atlas(words.spec, words.out, words.options,
                                [&](const std::string& line) { progress(common, line); });
  if (atlas.interrupted || StopSignals::asked()) {
    fmt::print(stderr,
               "laterna: interrupted with {} of {} cells done; the same command with --resume goes on\n",
               atlas.done, atlas.all);
    return exit_interrupted;
  }
  const std::filesystem::path out(words.out);
  const nlohmann::json summary = atlas_summary(atlas);
  nlohmann::json reference = summary;
  reference["letters"] = atlas_letters(atlas);
  write_file(out / "atlas.json", reference.dump(1) + "\n");
  write_file(out / "cells.json", atlas_cells(atlas, words.spec).dump(1) + "\n");
  if (common.json)
    fmt::print("{}\n", summary.dump());
  else
    fmt::print("{}open {}\n", atlas_text(atlas), (out / "cells.json").string());
  return exit_ok;
}

}  // namespace

void add_atlas(CLI::App& app, Common& common) {
  auto words = std::make_shared<Words>();
  CLI::App* command = add_command(
      app, "atlas", "laterna atlas data/atlas/standard.toml -o atlas",
      "Tries methods where they fail: every condition of a specification on many seeds, each answer right, "
      "weak "
      "and said so, refused,\n"
      "silently wrong, or crashed. Ctrl-C leaves what is done; --resume goes on. Exit code 5: interrupted.");
  command
      ->add_option("SPEC", words->spec, "Specification (TOML, grids of conditions; apps/lab/atlas/atlas.h)")
      ->required();
  command->add_option("-o,--output", words->out, "Folder for the results, new unless --resume")->required();
  command->add_flag("--resume", words->options.resume,
                    "Goes on where an interrupted run of the same words stopped");
  command->add_flag("--long", words->options.long_run, "Also the grids that say long = true");
  command->add_option("--method", words->options.methods, "Only these methods");
  command->add_option("--cell", words->options.cell, "Only the cells whose name begins so");
  command
      ->add_option("--sample", words->options.sample,
                   "So many cells drawn at random by --seed, on seeds of their own")
      ->check(CLI::Range(1, 1000000));
  command->callback([words, &common] { common.exit_code = run(*words, common); });
}

}  // namespace laterna
