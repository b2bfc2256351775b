#include "apps/lab/report/report_data.h"

#include "apps/lab/chart/chart_report.h"
#include "apps/lab/report/capture_figures.h"
#include "apps/lab/report/report_verdicts.h"
#include "apps/lab/report/stored_atlas.h"
#include "apps/lab/report/thumbnails.h"
#include "sim/error.h"
#include "sim/plain_name.h"
#include "sim/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace laterna {

using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_bytes = std::size_t{256} << 20, most_live_bytes = std::size_t{8} << 20;

Json read_json(const fs::path& file) {
  try {
    return Json::parse(read_text(file, most_bytes));
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: no JSON: {}", file.string(), plain_json_message(error.what())));
  }
}

bool is_board(const Json& json) {
  return json.is_object() && json.contains("ladder") && json.contains("cameras") && json.contains("status");
}

// Every key that a page draws from, so that no figure meets a hole.
void expect_keys(const Json& json, const fs::path& file, const std::vector<const char*>& keys) {
  for (const char* key : keys)
    if (!json.is_object() || !json.contains(key))
      throw InputError(fmt::format("{}: has no key \"{}\"", file.string(), key));
}

// The scene for the live view; meshes that would make the page too large are left to a page of their own.
void add_live(const fs::path& folder, Json& data) {
  const fs::path file = folder / "live.json";
  if (!fs::exists(file)) return;
  if (fs::file_size(file) > most_live_bytes) {
    data["live_left_out"] = fmt::format(
        "The scene takes {:.0f} MB, more than belongs on this page: \"laterna live\" writes a page of its "
        "own.",
        double(fs::file_size(file)) / 1e6);
    return;
  }
  data["live"] = read_json(file);
  expect_keys(data["live"], file,
              {"name", "meshes", "cameras", "projectors", "switches", "texture_from_clip"});
}

void add_roundtrip(const fs::path& folder, Json& data) {
  data["result"] = read_json(folder / "result.json");
  expect_keys(data["result"], folder / "result.json", {"projectors", "seconds"});
  for (const Json& projector : data["result"]["projectors"])
    expect_keys(projector, folder / "result.json", {"name", "status", "reason", "volume_error_px"});
  add_live(folder, data);
  if (!fs::exists(folder / "figures.json")) return;
  Json figures = read_json(folder / "figures.json");
  expect_keys(figures, folder / "figures.json", {"rig", "points", "residuals", "projections", "views"});
  for (const Json& view : figures["views"]) data["views"].push_back(stored_view(folder, view));
  figures.erase("views");
  data["figures"] = std::move(figures);
}

void add_chart(Json json, const fs::path& file, Json& data) {
  expect_keys(json, file, {"points", "pareto", "chart", "against"});
  read_chart(json);  // throws where a point is not whole
  data["charts"].push_back(std::move(json));
}

void add_plan(Json json, const fs::path& file, Json& data) {
  for (const Json& choice : json.at("choices")) {
    expect_keys(choice, file, {"name", "effect", "full", "plan", "end", "tried"});
    for (const Json& tried : choice["tried"])
      expect_keys(tried, file, {"value", "change_px", "doubt_px", "verdict", "reason"});
  }
  data["plans"].push_back(std::move(json));
  data["plan_names"].push_back(file.stem().string());
}

void add_selfcal(Json json, const fs::path& file, Json& data) {
  for (const Json& device : json.at("devices"))
    expect_keys(device, file, {"name", "size", "fx", "fy", "cx", "cy", "sigma"});
  for (const Json& station : json.at("stations"))
    expect_keys(station, file,
                {"device", "station", "device_from_first", "sightings", "fit_rms_px", "predicted_px"});
  data["selfcals"].push_back(std::move(json));
  data["selfcal_names"].push_back(file.stem().string());
}

void add_atlas(const fs::path& folder, Json& data) {
  data["atlas"] = {{"summary", read_json(folder / "atlas.json")},
                   {"cells", read_json(folder / "cells.json")}};
  expect_keys(data["atlas"]["summary"], folder / "atlas.json", {"conditions", "seeds", "methods"});
  for (const Json& cell : data["atlas"]["cells"])
    expect_keys(cell, folder / "cells.json",
                {"grid", "cell", "method", "values", "hidden", "letters", "error_px", "predicted_px",
                 "reasons", "command", "right", "weak", "refused", "silent", "crashed"});
  for (Json& cell : data["atlas"]["cells"]) {
    if (!cell.contains("picture")) continue;
    const std::string picture = cell["picture"];
    check_inner_path(picture, (folder / "cells.json").string());
    cell["image"] = data_uri_of_file(folder / picture);
  }
}

bool has_keys(const Json& json, const std::vector<const char*>& keys) {
  return json.is_object() &&
         std::all_of(keys.begin(), keys.end(), [&](const char* key) { return json.contains(key); });
}

// By its keys, whatever its name.
void add_file(const fs::path& file, Json& data) {
  Json json = read_json(file);
  if (file.filename() == "chart.json" || has_keys(json, {"points", "pareto", "against"}))
    return add_chart(std::move(json), file, data);
  if (has_keys(json, {"kept", "dropped", "choices", "tolerance_px", "change_px"}))
    return add_plan(std::move(json), file, data);
  if (has_keys(json, {"status", "reason", "count", "devices", "stations", "merged", "dropped"}))
    return add_selfcal(std::move(json), file, data);
  if (has_keys(json, {"conditions", "seeds", "methods", "letters"}))
    data["atlas_references"].push_back(stored_atlas(json, file.stem().string(), file.string()));
  else if (is_board(json))
    data["board"] = std::move(json);
}

// Drawn with what they belong to. A run leaves its reference beside the whole of it.
bool is_a_part(const fs::path& file) {
  const fs::path name = file.filename(), folder = file.parent_path();
  if (name == "reference.json")
    for (const char* whole : {"chart.json", "plan.json", "atlas.json"})
      if (fs::exists(folder / whole)) return true;
  if (name == "atlas.json" && fs::exists(folder / "cells.json")) return true;
  return name == "cells.json" || name == "figures.json" || name == "live.json";
}

std::vector<fs::path> json_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

void add_folder(const fs::path& folder, Json& data) {
  if (fs::exists(folder / "result.json")) add_roundtrip(folder, data);
  if (fs::exists(folder / "manifest.json")) add_capture(folder, data);
  if (fs::exists(folder / "atlas.json") && fs::exists(folder / "cells.json")) add_atlas(folder, data);
  for (const fs::path& file : json_files(folder))
    if (!is_a_part(file)) add_file(file, data);
}

std::string title_of(const fs::path& path) {
  const fs::path whole = fs::weakly_canonical(fs::absolute(path));
  return whole.filename().string();
}

}  // namespace

Json report_data(const fs::path& path) {
  if (!fs::exists(path))
    throw InputError(path.string() + ": no such file or folder, expected what Laterna wrote");
  Json data{{"format", "laterna-report"}, {"version", 1}, {"title", title_of(path)}};
  const std::size_t bare = data.size();
  try {
    if (fs::is_directory(path))
      add_folder(path, data);
    else
      add_file(path, data);
    if (data.size() == bare)
      throw InputError(
          path.string() +
          ": holds nothing to draw, expected a round trip (result.json), a capture "
          "(manifest.json), a calibration from boards, a self-calibration, a plan, a chart, atlas.json and "
          "cells.json, or a stored reference of these");
    data["verdicts"] = verdicts_of(data);
  } catch (const Json::exception& error) {
    throw InputError(
        fmt::format("{}: not as Laterna writes it: {}", path.string(), plain_json_message(error.what())));
  }
  return data;
}

}  // namespace laterna
