#include "apps/lab/dataset/dataset.h"

#include "apps/lab/dataset/drawn_scene.h"
#include "apps/lab/dataset/sample.h"
#include "apps/lab/dataset/sha256.h"
#include "sim/parallel.h"
#include "sim/scene_build.h"
#include "sim/text_file.h"
#include "tests/lab/changed_files.h"
#include "tests/lab/dataset/specs.h"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include <algorithm>

namespace laterna {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::input_error;
using testing::ScratchFolder;

constexpr std::uint64_t count = 5, seed_of_all = 3;

std::string text_of(const fs::path& path) { return read_text(path, std::size_t(1) << 30); }

std::string without(const std::string& text, const std::string& word) {
  std::string other = text;
  return other.erase(other.find(word), word.size());
}

DatasetOptions words(int shard = 0, int shards = 1) {
  return {.count = count, .seed = seed_of_all, .shard = shard, .shards = shards};
}

/// One set that several tests look at.
struct Made {
  ScratchFolder scratch;
  fs::path spec = testing::write_tiny_spec(scratch.path()), root = scratch / "set";
  DatasetOutcome outcome = make_dataset(spec, root, words());
};

struct ThreadReset {
  ~ThreadReset() { set_thread_count(0); }
};

TEST(Dataset, IsTheSameBytesForAnyShardsThreadsAndOrder) {
  const Made one;
  EXPECT_TRUE(one.outcome.whole);
  EXPECT_EQ(one.outcome.made, count);
  const ThreadReset reset;
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    const fs::path root = one.scratch / ("shards" + std::to_string(threads));
    for (const int shard : {2, 0, 1}) {
      const DatasetOutcome part = make_dataset(one.spec, root, words(shard, 3));
      EXPECT_EQ(part.whole, shard == 1);  // the last one
      EXPECT_EQ(fs::exists(root / "checksums.txt"), shard == 1);
    }
    for (const char* file :
         {"checksums.txt", "tars/tiny-000000.tar", "tars/tiny-000001.tar", "tars/tiny-000002.tar"})
      EXPECT_EQ(sha256_hex(text_of(root / file)), sha256_hex(text_of(one.root / file))) << file;
  }
  DatasetOptions other = words();
  other.seed = 4;
  make_dataset(one.spec, one.scratch / "other", other);
  EXPECT_NE(text_of(one.scratch / "other" / "checksums.txt"), text_of(one.root / "checksums.txt"));
}

TEST(Dataset, HasAChecksumLinePerSampleSorted) {
  const Made set;
  std::istringstream lines(text_of(set.root / "checksums.txt"));
  std::vector<std::string> all;
  for (std::string line; std::getline(lines, line);) all.push_back(line);
  ASSERT_EQ(all.size(), count);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
  // By the rule of block.h, worked out here from the files.
  const fs::path sample = set.root / "samples/000001/00000003";
  std::map<std::string, std::string> sums;
  for (const auto& entry : fs::recursive_directory_iterator(sample))
    if (entry.is_regular_file())
      sums[entry.path().lexically_relative(sample).generic_string()] = sha256_hex(text_of(entry.path()));
  std::string text;
  for (const auto& [name, sum] : sums) text += sum + "  " + name + "\n";
  EXPECT_EQ(all[3], "00000003 " + sha256_hex(text));
  EXPECT_THAT(text_of(set.root / "card.md"),
              AllOf(HasSubstr("5 samples of seed 3"), HasSubstr("`camera.fov_x_deg` | uniform 30 to 60"),
                    HasSubstr("CC0-1.0"), HasSubstr("A million samples: "), HasSubstr("samples per second"),
                    HasSubstr(fmt::format("\n| {} | 5 | ", thread_count()))));
}

TEST(Dataset, RecordsKeepTheirSchema) {
  const Made set;
  const json schema_text = json::parse(text_of(set.root / "sample.schema.json"));
  valijson::Schema schema;
  valijson::SchemaParser(valijson::SchemaParser::kDraft7)
      .populateSchema(valijson::adapters::NlohmannJsonAdapter(schema_text), schema);
  const auto valid = [&](const json& record) {
    return valijson::Validator().validate(schema, valijson::adapters::NlohmannJsonAdapter(record), nullptr);
  };
  json record;
  for (std::uint64_t k = 0; k < count; ++k) {
    const fs::path root = DatasetFolder{set.root, "tiny", count, 2}.sample(k);
    record = json::parse(text_of(root / "sample.json"));
    EXPECT_TRUE(valid(record)) << record.dump(1);
    for (const json& view : record["views"])
      for (const char* file : {"truth", "mask", "correspondences"})
        EXPECT_TRUE(fs::is_regular_file(root / view[file].get<std::string>())) << view[file];
    EXPECT_NO_THROW(build_scene(
        scene_of({.scene_file = root / "scene.toml", .scene_text = text_of(root / "scene.toml")}, {}),
        root));  // self-contained
  }
  for (const char* key : {"views", "drawn", "effects", "calibration"}) {
    json less = record;
    less.erase(key);
    EXPECT_FALSE(valid(less)) << key;
  }
  record["views"][0]["lit_share"] = 1.5;
  EXPECT_FALSE(valid(record));
}

TEST(Dataset, CountsWhatTheRigCannotSeeByReason) {
  const Made set;
  const DatasetSpec spec = read_dataset_spec(set.spec);
  std::map<std::string, std::uint64_t> expected;
  for (std::uint64_t k = 0; k < count; ++k) {
    for (std::uint64_t attempt = 0;; ++attempt) {
      const Scene scene =
          build_scene(scene_of(spec, draw_values(spec, seed_of_all, k, attempt)), set.scratch.path());
      StageTimes times;
      const Traced traced = trace(scene, times);
      const std::string reason = rejection({sight_of(scene, traced, traced.views[0])}, spec.reject);
      if (reason.empty()) break;
      ++expected[reason];
    }
  }
  EXPECT_FALSE(expected.empty());  // else the specification tests nothing
  EXPECT_EQ(set.outcome.totals.rejected, expected);
  for (const auto& [reason, n] : expected)
    EXPECT_THAT(text_of(set.root / "card.md"), HasSubstr("| " + reason + " | " + std::to_string(n) + " |"));
}

TEST(Dataset, RejectionsHaveTheirReasons) {
  const RejectSettings reject{.least_lit = 0.2, .least_projector = 0.1};
  EXPECT_EQ(rejection({{1, 0.5, 0.5}}, reject), "");
  EXPECT_EQ(rejection({{1, 0.5, 0.5}, {0, 0, 0}}, reject), "nothing_seen");
  EXPECT_EQ(rejection({{1, 0, 0}}, reject), "no_overlap");
  EXPECT_EQ(rejection({{1, 0.1, 0.5}}, reject), "too_little_lit");
  EXPECT_EQ(rejection({{1, 0.5, 0.05}}, reject), "too_little_of_projector");
}

TEST(Dataset, ARigThatNeverSeesEndsWithItsReasons) {
  const ScratchFolder scratch;
  const fs::path spec = testing::write_tiny_spec(
      scratch.path(), testing::tiny_spec + "\"camera.up\" = { choice = [[0, 0, 1]] }\n" +
                          "\"camera.position\" = { choice = [[0, 0, -5]] }\n");
  EXPECT_THAT(input_error([&] { make_dataset(spec, scratch / "set", words()); }),
              AllOf(HasSubstr("all of 100 attempts thrown away ("), HasSubstr("--resume goes on")));
  EXPECT_FALSE(fs::exists(scratch / "set" / "checksums.txt"));
}

TEST(Dataset, AttemptsWithoutAnyMeshAreCounted) {
  const ScratchFolder scratch;
  const auto with_share = [&](const char* share) {
    std::string text = testing::tiny_spec;
    const std::string line = "\"mesh.1\" = 0.8";
    text.replace(text.find(line), line.size(), line + "\n\"mesh.0\" = " + share);
    return testing::write_tiny_spec(scratch.path(), text.replace(text.find("0.8"), 3, share));
  };
  const DatasetOutcome half = make_dataset(with_share("0.5"), scratch / "half", words());
  EXPECT_TRUE(half.whole);
  EXPECT_GT(half.totals.rejected.at("nothing_seen"), 0u);
  EXPECT_THAT(input_error([&] { make_dataset(with_share("0"), scratch / "none", words()); }),
              HasSubstr("all of 100 attempts thrown away (nothing_seen 100)"));
}

/// The members of a tar file, in order.
std::vector<std::pair<std::string, std::string>> members(const fs::path& path) {
  std::vector<std::pair<std::string, std::string>> all;
  const std::unique_ptr<archive, int (*)(archive*)> tar(archive_read_new(), &archive_read_free);
  archive_read_support_format_tar(tar.get());
  EXPECT_EQ(archive_read_open_filename(tar.get(), path.c_str(), 1 << 16), ARCHIVE_OK);
  archive_entry* entry = nullptr;
  while (archive_read_next_header(tar.get(), &entry) == ARCHIVE_OK) {
    EXPECT_EQ(archive_format(tar.get()), ARCHIVE_FORMAT_TAR_USTAR);
    EXPECT_EQ(archive_entry_mtime(entry), 0);
    EXPECT_EQ(archive_entry_uid(entry), 0);
    std::string bytes(std::size_t(archive_entry_size(entry)), '\0');
    EXPECT_EQ(archive_read_data(tar.get(), bytes.data(), bytes.size()), la_ssize_t(bytes.size()));
    all.emplace_back(archive_entry_pathname(entry), std::move(bytes));
  }
  return all;
}

TEST(Dataset, TarFilesHoldTheSamplesAsWebDatasetReadsThem) {
  const Made set;
  std::vector<std::string> keys;
  std::size_t files = 0;
  for (const char* block : {"000000", "000001", "000002"}) {
    for (const auto& [name, bytes] : members(set.root / "tars" / (std::string("tiny-") + block + ".tar"))) {
      const std::string key = name.substr(0, name.find('.'));  // WebDataset's rule
      if (keys.empty() || keys.back() != key) keys.push_back(key);
      ++files;
      if (!name.ends_with(".sample.json")) continue;
      EXPECT_EQ(bytes, text_of(set.root / "samples" / block / key / "sample.json"));
      EXPECT_EQ(json::parse(bytes)["key"], key);
    }
  }
  // Each key once: a sample's files stand together.
  EXPECT_EQ(keys, (std::vector<std::string>{"00000000", "00000001", "00000002", "00000003", "00000004"}));
  EXPECT_EQ(files, set.outcome.totals.files);
}

TEST(Dataset, FoldersMayGoOnceTheyArePacked) {
  const Made kept;
  const fs::path spec =
      testing::write_tiny_spec(kept.scratch.path(), "folders = false\n" + testing::tiny_spec);
  DatasetOptions options = words();
  EXPECT_TRUE(make_dataset(spec, kept.scratch / "lean", options).whole);
  EXPECT_TRUE(fs::is_empty(kept.scratch / "lean" / "samples"));
  EXPECT_EQ(text_of(kept.scratch / "lean" / "checksums.txt"), text_of(kept.root / "checksums.txt"));
  options.resume = true;  // nothing is made again
  EXPECT_EQ(make_dataset(spec, kept.scratch / "lean", options).made, 0u);
}

TEST(Dataset, PartsAreMergedWhenAllAreThere) {
  const Made set;
  const fs::path root = set.scratch / "parts";
  make_dataset(set.spec, root, words(0, 2));
  DatasetOptions merge = words();
  merge.merge = true;
  EXPECT_THAT(input_error([&] { make_dataset(set.spec, root, merge); }),
              HasSubstr("2 of 5 samples are missing, 00000001 first"));
  fs::remove_all(root / "runs");  // another machine made the rest
  DatasetOptions rest = words();
  rest.resume = true;
  EXPECT_EQ(make_dataset(set.spec, root, rest).made, 2u);
  fs::remove(root / "checksums.txt");
  EXPECT_TRUE(make_dataset(set.spec, root, merge).whole);
  EXPECT_EQ(text_of(root / "checksums.txt"), text_of(set.root / "checksums.txt"));
}

TEST(Dataset, WhatHasGoneIsMadeAgain) {
  const Made set;
  const std::string sums = text_of(set.root / "checksums.txt");
  for (const char* gone : {"samples/000001/00000003", "tars/tiny-000001.tar", "checksums.txt"})
    fs::remove_all(set.root / gone);
  DatasetOptions rest = words();
  rest.resume = true;
  EXPECT_EQ(make_dataset(set.spec, set.root, rest).made, 1u);
  EXPECT_EQ(text_of(set.root / "checksums.txt"), sums);
}

TEST(Dataset, AnotherSetIsNotMixedIn) {
  const Made set;
  DatasetOptions other = words();
  EXPECT_THAT(input_error([&] { make_dataset(set.spec, set.root, other); }), HasSubstr("--resume"));
  other.resume = true, other.seed = 9;
  EXPECT_THAT(input_error([&] { make_dataset(set.spec, set.root, other); }),
              HasSubstr("seed 3 there, 9 here"));
  testing::write_text(set.spec, without(testing::tiny_spec, "\"gray\", "));
  other.seed = seed_of_all;
  EXPECT_THAT(input_error([&] { make_dataset(set.spec, set.root, other); }),
              HasSubstr("spec.toml: has changed since "));
  fs::create_directories(set.scratch / "full");
  testing::write_text(set.scratch / "full" / "file", "");
  EXPECT_THAT(input_error([&] { make_dataset(set.spec, set.scratch / "full", words()); }),
              HasSubstr("holds something else"));
}

// Also a mesh that the one sample does not draw.
TEST(Dataset, AChangedFileIsNotGoneOnWith) {
  const ScratchFolder scratch;
  const fs::path spec = testing::write_tiny_spec(scratch.path());
  DatasetOptions options{.count = 1};
  const auto draws_the_mesh = [&] {
    const auto values = draw_values(read_dataset_spec(spec), options.seed, 0, 0).values;
    return std::any_of(values.begin(), values.end(), [](const auto& v) { return v.second == "wedge.ply"; });
  };
  while (draws_the_mesh()) ++options.seed;
  make_dataset(spec, scratch / "set", options);
  options.resume = true;
  testing::expect_each_change_refused({spec, scratch / "scene.toml", scratch / "wedge.ply"},
                                      [&] { make_dataset(spec, scratch / "set", options); });
}

TEST(Sha256, IsThatOfTheStandard) {  // FIPS 180-4's example
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
}  // namespace laterna
