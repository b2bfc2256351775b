#include "apps/lab/dataset/dataset.h"

#include "apps/lab/dataset/block.h"
#include "apps/lab/dataset/drawn_scene.h"
#include "apps/lab/dataset/named_files.h"
#include "apps/lab/dataset/sample.h"
#include "apps/lab/dataset/sha256.h"
#include "apps/lab/files_digest.h"
#include "apps/lab/runner.h"
#include "sim/error.h"
#include "sim/instruction_sets.h"
#include "sim/safe_write.h"
#include "sim/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <vector>

namespace laterna {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t most_bytes = std::size_t(1) << 26;

/// What all shards of a set share; and the files that decide its samples.
struct Identity {
  Json json;
  std::vector<FileDigest> files;
};

Identity identity_of(const fs::path& specification, const DatasetSpec& spec, const DatasetOptions& options) {
  std::vector<fs::path> named = named_files(spec);
  named.insert(named.begin(), {specification, spec.scene_file});
  std::vector<FileDigest> files = file_digests(named, specification.parent_path());
  Json json{{"format", "laterna-dataset"},
            {"version", 2},
            {"name", spec.settings.name},
            {"licence", spec.settings.licence},
            {"count", options.count},
            {"seed", options.seed},
            {"tar_samples", spec.settings.tar_samples},
            {"instruction_set", instruction_set()},
            {"files", json_of(files)}};
  return {std::move(json), std::move(files)};
}

// The first difference, in words.
std::string difference(const Json& there, const Json& here) {
  for (const auto& [key, value] : here.items())
    if (key != "files" && (!there.contains(key) || there[key] != value))
      return fmt::format("{} {} there, {} here", key, there.value(key, Json()).dump(), value.dump());
  return "";
}

// Throws where the folder holds another set.
void expect_same_set(const fs::path& path, const Identity& here) {
  const Json there = Json::parse(read_text(path, most_bytes), nullptr, false);
  const std::string other = there.is_object() ? difference(there, here.json) : "no JSON";
  if (!other.empty())
    throw InputError(fmt::format("{}: another data set ({}), expected the same words or a new folder",
                                 path.string(), other));
  expect_unchanged(here.files, there.value("files", Json::object()), path);
}

void begin(const DatasetFolder& folder, const DatasetSpec& spec, const DatasetOptions& options,
           const Identity& here) {
  const fs::path path = folder.root / "dataset.json";
  if (fs::exists(path)) return expect_same_set(path, here);
  std::error_code ignored;
  if (options.merge) throw InputError(folder.root.string() + ": holds no data set, expected one to merge");
  if (fs::exists(folder.root) && !fs::is_empty(folder.root, ignored) && !fs::exists(folder.root / "runs"))
    throw InputError(folder.root.string() + ": holds something else, expected a new folder");
  check_ends(spec, options.seed);
  for (const char* part : {"runs", "tars", "samples"}) make_folders(folder.root / part);
  write_file(folder.root / "spec.toml", spec.text);
  write_file(folder.root / "scene.toml", spec.scene_text);
  write_file(path, here.json.dump(1) + "\n");
}

// What killed processes left under temporary names.
void remove_partials(const fs::path& folder) {
  std::vector<fs::path> partials;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().filename().string().find(".partial-") != std::string::npos)
      partials.push_back(entry.path());
  for (const fs::path& path : partials) fs::remove_all(path, ignored);
}

void add(DatasetTotals& totals, const Json& sample) {
  ++totals.samples;
  totals.bytes += sample.at("bytes").get<std::uint64_t>(),
      totals.files += sample.at("files").get<std::uint64_t>();
  for (const auto& [reason, count] : sample.at("rejected").items())
    totals.rejected[reason] += count.get<std::uint64_t>();
}

/// Writes what only a whole set has, checksums last.
void complete(const DatasetFolder& folder, const DatasetSpec& spec, const DatasetOptions& options,
              DatasetOutcome& outcome) {
  const FileLock lock(folder.root / ".lock", FileLock::Wait::yes);
  remove_partials(folder.root);
  remove_partials(folder.root / "tars");
  std::string checksums;
  for (std::uint64_t block = 0; block < folder.blocks(); ++block) {
    remove_partials(folder.block_folder(block));
    for (const Json& sample : read_listing(folder, block)) {
      checksums += sample.at("key").get<std::string>() + " " + sample.at("sha256").get<std::string>() + "\n";
      add(outcome.totals, sample);
    }
  }
  const std::vector<RunCost> costs = costs_by_threads(folder);
  outcome.all_cost = sum_of(costs);
  write_file(folder.root / "sample.schema.json", sample_schema());
  write_file(folder.root / "card.md", data_card(spec, options.seed, outcome.totals, costs));
  write_file(folder.root / "checksums.txt", checksums);
  outcome.whole = true;
}

/// How many blocks are packed, after packing what can be.
std::uint64_t packed_blocks(const DatasetFolder& folder, bool keep_folders) {
  std::uint64_t packed = 0;
  for (std::uint64_t block = 0; block < folder.blocks(); ++block)
    packed += pack_if_whole(folder, block, keep_folders);
  return packed;
}

std::vector<Job> jobs_of(const DatasetFolder& folder, const DatasetSpec& spec, const DatasetOptions& options,
                         std::atomic<std::uint64_t>& made) {
  std::vector<Job> jobs;
  for (auto k = std::uint64_t(options.shard); k < options.count; k += std::uint64_t(options.shards))
    jobs.push_back({sample_key(k), [&, k] {
                      if (!folder.has(k)) {
                        make_sample(spec, options.seed, k, folder.sample(k));
                        ++made;
                      }
                      pack_if_whole(folder, folder.block_of(k), spec.settings.folders);
                      return Json(nullptr);
                    }});
  return jobs;
}

bool has_all(const DatasetFolder& folder, const DatasetOptions& options) {
  for (auto k = std::uint64_t(options.shard); k < options.count; k += std::uint64_t(options.shards))
    if (!folder.has(k)) return false;
  return true;
}

void run_shard(const DatasetFolder& folder, const DatasetSpec& spec, const DatasetOptions& options,
               const Identity& identity, const Progress& progress, DatasetOutcome& outcome) {
  const fs::path run_folder = folder.run(options.shard, options.shards);
  make_folders(run_folder);
  const FileLock lock(run_folder / ".lock", FileLock::Wait::no);
  std::atomic<std::uint64_t> made = 0;
  const CostClock clock;
  const fs::path journal = run_folder / "journal.jsonl";
  RunnerOptions runner{.folder = run_folder,
                       .fingerprint = sha256_hex(identity.json.dump()),
                       .resume = options.resume && fs::exists(journal),
                       .noun = "samples",
                       .stop_at_error = true,
                       .most_deaths = std::numeric_limits<int>::max()};
  try {
    const std::vector<Job> jobs = jobs_of(folder, spec, options, made);
    outcome.interrupted = run_jobs(jobs, runner, progress).interrupted;
    if (!outcome.interrupted && !has_all(folder, options)) {  // some that the journal knows have gone since
      fs::remove(journal);
      runner.resume = false;
      outcome.interrupted = run_jobs(jobs, runner, progress).interrupted;
    }
  } catch (const InputError& error) {
    keep_cost(run_folder, clock.cost(made));
    const std::string words = error.what();  // that a run stands there already says it itself
    throw InputError(words +
                     (words.find("--resume") == words.npos ? "; what is whole stays: --resume goes on" : ""));
  }
  outcome.made = made, outcome.cost = clock.cost(made);
  keep_cost(run_folder, outcome.cost);
}

[[noreturn]] void refuse_to_merge(const DatasetFolder& folder) {
  std::uint64_t missing = 0, first = 0;
  for (std::uint64_t k = folder.count; k-- > 0;)
    if (!folder.has(k)) first = k, ++missing;
  throw InputError(fmt::format("{}: {} of {} samples are missing, {} first, expected all to merge",
                               folder.root.string(), missing, folder.count, sample_key(first)));
}

}  // namespace

DatasetOutcome make_dataset(const fs::path& specification, const fs::path& root,
                            const DatasetOptions& options, const Progress& progress) {
  const DatasetSpec spec = read_dataset_spec(specification);
  const DatasetFolder folder{root, spec.settings.name, options.count,
                             std::uint64_t(spec.settings.tar_samples)};
  const Identity identity = identity_of(specification, spec, options);
  begin(folder, spec, options, identity);
  DatasetOutcome outcome;
  if (!options.merge) run_shard(folder, spec, options, identity, progress, outcome);
  if (outcome.interrupted) return outcome;
  if (packed_blocks(folder, spec.settings.folders) == folder.blocks())
    complete(folder, spec, options, outcome);
  else if (options.merge)
    refuse_to_merge(folder);
  return outcome;
}

}  // namespace laterna
