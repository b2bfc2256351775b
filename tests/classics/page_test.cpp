// The page data/classics/README.md, and what is stored beside it, against what the classics make now.
#include "tests/classics/made.h"

#include "sim/image_file.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <set>

namespace laterna {
namespace {

using laterna::testing::classics_folder;
using laterna::testing::made_classics;

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::set<std::string> stored_names() {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(classics_folder() / "pictures"))
    if (entry.path().extension() != ".json") names.insert(entry.path().filename().string());
  return names;
}

TEST(ClassicsPage, StoresWhatTheClassicsMake) {
  std::set<std::string> made;
  for (const MadeClassic& one : made_classics()) {
    for (const ClassicPicture& picture : one.result.pictures) made.insert(picture.name + ".png");
    for (const LineChart& chart : one.result.charts) made.insert(chart.name + ".svg");
  }
  EXPECT_EQ(made, stored_names());
}

TEST(ClassicsPage, NamesEveryPictureSceneAndFigure) {
  const std::string page = text_of(classics_folder() / "README.md");
  for (const std::string& name : stored_names())
    EXPECT_THAT(page, ::testing::HasSubstr("(pictures/" + name + ")"));
  for (const MadeClassic& one : made_classics()) {
    EXPECT_THAT(page, ::testing::HasSubstr("laterna classics " + std::string(one.classic.name) + " -o"));
    for (const ClassicFigure& f : one.result.figures) EXPECT_THAT(page, ::testing::HasSubstr(f.name));
  }
  for (const auto& entry : std::filesystem::directory_iterator(classics_folder()))
    if (entry.path().extension() == ".toml") {
      EXPECT_THAT(page, ::testing::HasSubstr("(" + entry.path().filename().string() + ")"));
    }
}

// Less than 60 kB each and 1.5 MB together: a page that opens at once.
TEST(ClassicsPage, IsSmall) {
  std::uintmax_t sum = 0;
  for (const std::string& name : stored_names()) {
    const auto bytes = std::filesystem::file_size(classics_folder() / "pictures" / name);
    EXPECT_LT(bytes, 60'000u) << name;
    sum += bytes;
  }
  EXPECT_LT(sum, 1'500'000u);
}

TEST(ClassicsPage, StoredFiguresComeOutAgain) {
  const auto stored = nlohmann::json::parse(text_of(classics_folder() / "pictures" / "classics.json"));
  const auto now = classics_json(made_classics());
  ASSERT_EQ(stored.size(), now.size());
  for (const auto& [name, classic] : now.items()) {
    ASSERT_EQ(stored[name]["figures"].size(), classic["figures"].size()) << name;
    for (const auto& [key, figure] : classic["figures"].items())
      EXPECT_NEAR(stored[name]["figures"][key]["value"].get<double>(), figure["value"].get<double>(),
                  figure["tolerance"].get<double>())
          << name << ": " << key;
    for (const auto& [key, chart] : classic["charts"].items())
      for (std::size_t s = 0; s < chart["series"].size(); ++s) {
        const auto& series = chart["series"][s];
        const auto& before = stored[name]["charts"][key]["series"][s];
        ASSERT_EQ(before["points"].size(), series["points"].size()) << key;
        for (std::size_t i = 0; i < series["points"].size(); ++i) {
          const double y = series["points"][i][1].get<double>();
          EXPECT_NEAR(before["points"][i][1].get<double>(), y, y * series["tolerance"].get<double>()) << key;
        }
      }
  }
}

// Rounding moves a few pixels across an edge, no more than 1 in 500; elsewhere a digital number by 1.
TEST(ClassicsPage, StoredPicturesComeOutAgain) {
  for (const MadeClassic& one : made_classics())
    for (const ClassicPicture& picture : one.result.pictures) {
      const Picture stored = read_picture(classics_folder() / "pictures" / (picture.name + ".png"));
      const auto& values = std::get<std::vector<std::uint8_t>>(stored.values);
      const std::vector<std::uint8_t>& rgb = picture.canvas.rgb;
      const std::size_t repeat =
          rgb.size() / values.size();  // 3 where a grey picture is stored as one channel
      ASSERT_EQ(values.size() * repeat, rgb.size()) << picture.name;
      std::size_t other = 0;
      for (std::size_t i = 0; i < rgb.size(); ++i)
        other += std::abs(int(values[i / repeat]) - int(rgb[i])) > 1;
      EXPECT_LE(other, rgb.size() / 500) << picture.name;
    }
}

TEST(Classics, UnknownNameListsTheKnownOnes) {
  EXPECT_THAT(laterna::testing::input_error([] { (void)find_classics({"magic"}); }),
              ::testing::HasSubstr("found no classic \"magic\", expected one of slide_projector"));
}

TEST(Classics, FolderIsNewOrRefused) {
  const laterna::testing::ScratchFolder scratch;
  EXPECT_THAT(laterna::testing::input_error([&] { write_classics(made_classics(), scratch.path()); }),
              ::testing::HasSubstr("exists"));
}

}  // namespace
}  // namespace laterna
