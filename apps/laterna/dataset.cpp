#include "apps/lab/dataset/dataset.h"
#include "apps/lab/keep_memory.h"
#include "apps/laterna/command.h"
#include "sim/error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>

namespace laterna {

namespace {

struct Words {
  std::string spec, out, shard;
  DatasetOptions options;
};

// "I/K"; K/K is 0/K, so that shards may be counted from 0 or from 1.
void parse_shard(const std::string& text, DatasetOptions& options) {
  if (text.empty()) return;
  int used = 0, shard = 0, shards = 0;
  if (std::sscanf(text.c_str(), "%6d/%6d%n", &shard, &shards, &used) != 2 || used != int(text.size()) ||
      shards < 1 || shard < 0 || shard > shards)
    throw InputError(
        fmt::format("--shard: found \"{}\", expected I/K such as 0/3, with I from 0 to K", text));
  options.shard = shard % shards, options.shards = shards;
}

nlohmann::json json_of(const DatasetOutcome& outcome, const Words& words) {
  nlohmann::json json{{"folder", words.out},
                      {"whole", outcome.whole},
                      {"made", outcome.made},
                      {"seconds", outcome.cost.wall_s},
                      {"cpu_seconds", outcome.cost.cpu_s},
                      {"threads", outcome.cost.threads}};
  if (outcome.whole) {
    json["samples"] = outcome.totals.samples, json["bytes"] = outcome.totals.bytes;
    json["rejected"] = outcome.totals.rejected;
  }
  return json;
}

void print_text(const DatasetOutcome& outcome, const Words& words) {
  if (outcome.made > 0)
    fmt::print("{} samples in {:.1f} s on {} threads: {:.3g} samples/s, {:.3g} CPU seconds each\n",
               outcome.made, outcome.cost.wall_s, outcome.cost.threads,
               double(outcome.made) / outcome.cost.wall_s, outcome.cost.cpu_s / double(outcome.made));
  if (!outcome.whole) {
    fmt::print("shard {} of {} is done; the shard that ends last completes {}\n", words.options.shard,
               words.options.shards, words.out);
    return;
  }
  for (const auto& [reason, count] : outcome.totals.rejected)
    fmt::print("thrown away: {} {}\n", count, reason);
  const std::string million = million_text(outcome.totals, outcome.all_cost);
  fmt::print("{}{}open {}/card.md\n", million, million.empty() ? "" : "\n", words.out);
}

int run(Words& words, const Common& common) {
  words.options.seed = common.seed;
  parse_shard(words.shard, words.options);
  keep_freed_memory();
  const DatasetOutcome outcome = make_dataset(words.spec, words.out, words.options,
                                              [&](const std::string& line) { progress(common, line); });
  if (outcome.interrupted) {
    fmt::print(stderr, "laterna: interrupted after {} samples; the same command with --resume goes on\n",
               outcome.made);
    return exit_interrupted;
  }
  if (common.json)
    fmt::print("{}\n", json_of(outcome, words).dump());
  else
    print_text(outcome, words);
  return exit_ok;
}

}  // namespace

void add_dataset(CLI::App& app, Common& common) {
  auto words = std::make_shared<Words>();
  CLI::App* command =
      add_command(app, "dataset", "laterna dataset data/dataset/tabletop.toml -o tabletop --count 100",
                  "Makes a data set: random scenes from stated distributions, each captured with its truth, "
                  "and packed for "
                  "training\n"
                  "(apps/lab/dataset/dataset_folder.h). Shards may share the folder; the one that ends last "
                  "completes it with "
                  "checksums.txt\n"
                  "and a data card. The same seed gives the same bytes for any shards, threads and order. "
                  "Ctrl-C, kill or a "
                  "full disk leave\n"
                  "what is whole; --resume goes on. Exit code 5: interrupted.");
  command->add_option("SPEC", words->spec, "Specification (TOML; apps/lab/dataset/dataset_spec.h)")
      ->required();
  command->add_option("-o,--output", words->out, "Folder of the data set, shared by its shards")->required();
  command->add_option("--count", words->options.count, "How many samples the whole set has")
      ->required()
      ->check(CLI::Range(1, 99999999));
  command->add_option("--shard", words->shard, "I/K: only this one of K parts, counted from 0 or from 1");
  command->add_flag("--resume", words->options.resume,
                    "Goes on where a run of the same words stopped, or begins");
  command->add_flag("--merge", words->options.merge,
                    "Makes no sample: completes the set from what all shards made");
  command->callback([words, &common] { common.exit_code = run(*words, common); });
}

}  // namespace laterna
