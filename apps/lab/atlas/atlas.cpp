#include "apps/lab/atlas/atlas.h"

#include "apps/lab/atlas/cell_kinds.h"
#include "apps/lab/cell_seed.h"
#include "apps/lab/grid_settings.h"
#include "apps/lab/json_number.h"
#include "apps/lab/shell_word.h"
#include "calib/median.h"
#include "sim/error.h"
#include "sim/image_file.h"
#include "sim/text_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <random>

namespace laterna {

namespace {

using Json = nlohmann::json;

const std::vector<std::string> settings{"seeds", "methods", "peer_seeds", "hidden", "long"};

/// What a grid says beside its cells.
struct GridSettings {
  int seeds = 20, peer_seeds = 3;
  std::vector<std::string> methods{"laterna"};
  bool hidden = false, is_long = false;
};

GridSettings settings_of(const Grid& grid, const CellKind& kind) {
  GridSettings s;
  s.seeds = count_setting(grid, "seeds", s.seeds),
  s.peer_seeds = count_setting(grid, "peer_seeds", s.peer_seeds);
  s.hidden = flag_setting(grid, "hidden"), s.is_long = flag_setting(grid, "long");
  s.methods = methods_setting(grid, kind.methods);
  return s;
}

/// A cell that is to be run.
struct Planned {
  AtlasCell cell;
  CellTrial trial;
  int seeds = 0;
};

void plan_grid(const Grid& grid, const std::filesystem::path& folder, const AtlasOptions& options,
               std::vector<Planned>& planned) {
  const CellKind& kind = cell_kind(grid.kind, grid.place);
  const GridSettings s = settings_of(grid, kind);
  if (s.is_long && !options.long_run && options.cell.empty()) return;
  for (const GridCell& cell : cells_of(grid)) {
    const CellTrial trial = kind.prepare(cell.values, grid.place, folder);
    for (const std::string& method : s.methods) {
      const bool wanted = options.methods.empty() || std::find(options.methods.begin(), options.methods.end(),
                                                               method) != options.methods.end();
      if (!wanted || !cell.name.starts_with(options.cell)) continue;
      AtlasCell empty;
      empty.grid = grid.name, empty.name = cell.name, empty.kind = kind.name, empty.method = method;
      empty.values = cell.values, empty.hidden = s.hidden;
      planned.push_back({std::move(empty), trial, method == kind.methods.front() ? s.seeds : s.peer_seeds});
    }
  }
}

Graded try_one(const Planned& planned, std::uint64_t seed) {
  try {
    const CellProblem problem = planned.trial(seed);
    return graded(problem.solve(planned.cell.method), problem);
  } catch (const std::exception& error) {
    return {Outcome::crashed, NAN, NAN, error.what()};
  }
}

// A reason without its numbers, so that seeds of one cell have one.
std::string without_numbers(const std::string& text) {
  std::string plain;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    const bool in_word =
        k > 0 && (std::isalpha(static_cast<unsigned char>(text[k - 1])) || text[k - 1] == '_');
    const bool digit = std::isdigit(static_cast<unsigned char>(c)) && !in_word;
    if (!digit) {
      plain += c;
      continue;
    }
    while (k + 1 < text.size() &&
           (std::isdigit(static_cast<unsigned char>(text[k + 1])) || text[k + 1] == '.' ||
            (text[k + 1] == 'e' && k + 2 < text.size() && (text[k + 2] == '-' || text[k + 2] == '+')) ||
            ((text[k + 1] == '-' || text[k + 1] == '+') && text[k] == 'e')))
      ++k;
    plain += '#';
  }
  return plain;
}

// The picture of the first seed that fared worst, under the folder; empty where there is none.
std::string write_cell_picture(const Planned& planned, std::uint64_t seed, const std::string& letters,
                               const std::filesystem::path& folder) {
  if (planned.cell.kind != "pictures") return {};
  const auto rank = [](char letter) { return outcome_letters.find(letter); };
  const auto worst =
      std::max_element(letters.begin(), letters.end(), [&](char a, char b) { return rank(a) < rank(b); });
  try {
    const CellProblem problem =
        planned.trial(cell_seed(planned.cell.name, seed, int(worst - letters.begin())));
    std::string file =
        fmt::format("pictures/{:016x}.png", hash_of(planned.cell.method + ": " + planned.cell.name));
    std::filesystem::create_directories(folder / "pictures");
    write_picture(folder / file, problem.picture());
    return file;
  } catch (const std::exception&) {
    return {};  // a crash is told by its letter and reason
  }
}

Json run_cell(const Planned& planned, std::uint64_t seed, const std::filesystem::path& folder) {
  std::string letters;
  std::vector<double> errors, predictions;
  std::map<std::string, int> reasons;
  for (int k = 0; k < planned.seeds; ++k) {
    const Graded graded = try_one(planned, cell_seed(planned.cell.name, seed, k));
    letters += outcome_letters[std::size_t(graded.outcome)];
    if (std::isfinite(graded.error_px)) errors.push_back(graded.error_px);
    if (std::isfinite(graded.predicted_px)) predictions.push_back(graded.predicted_px);
    if (!graded.reason.empty()) ++reasons[without_numbers(graded.reason)];
  }
  std::vector<std::pair<std::string, int>> sorted(reasons.begin(), reasons.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  sorted.resize(std::min<std::size_t>(sorted.size(), 3));
  Json cell{{"letters", letters},
            {"error_px", errors.empty() ? Json(nullptr) : finite_or_null(median(errors))},
            {"predicted_px", predictions.empty() ? Json(nullptr) : finite_or_null(median(predictions))},
            {"reasons", sorted}};
  const std::string picture = write_cell_picture(planned, seed, letters, folder);
  if (!picture.empty()) cell["picture"] = picture;
  return cell;
}

void fill(AtlasCell& cell, const JobOutcome& outcome, int seeds) {
  if (!outcome.crashed.empty()) {
    cell.letters = std::string(std::size_t(seeds), outcome_letters[std::size_t(Outcome::crashed)]);
    cell.reasons = {{outcome.crashed, seeds}};
  } else {
    cell.letters = outcome.result["letters"].get<std::string>();
    cell.error_px = number_or_nan(outcome.result, "error_px");
    cell.predicted_px = number_or_nan(outcome.result, "predicted_px");
    cell.reasons = outcome.result["reasons"].get<std::vector<std::pair<std::string, int>>>();
    cell.picture = outcome.result.value("picture", "");
  }
  for (const char letter : cell.letters) ++cell.counts[outcome_letters.find(letter)];
}

std::vector<Planned> sampled(std::vector<Planned> planned, const AtlasOptions& options) {
  if (options.sample <= 0 || std::size_t(options.sample) >= planned.size()) return planned;
  std::mt19937_64 random(options.seed);
  for (std::size_t k = 0; k < std::size_t(options.sample);
       ++k)  // a partial shuffle, the same on every platform
    std::swap(planned[k], planned[k + random() % (planned.size() - k)]);
  planned.resize(std::size_t(options.sample));
  return planned;
}

std::string fingerprint(const AtlasOptions& options) {
  return fmt::format("atlas, seed {} long {} methods {} cell {} sample {}", options.seed, options.long_run,
                     fmt::join(options.methods, ","), options.cell, options.sample);
}

}  // namespace

Atlas run_atlas(const std::filesystem::path& specification, const std::filesystem::path& folder,
                const AtlasOptions& options, const Progress& progress) {
  const std::string text = read_text(specification, std::size_t(16) << 20);
  std::vector<Planned> planned;
  for (const Grid& grid : parse_grids(text, specification.string(), settings))
    plan_grid(grid, specification.parent_path(), options, planned);
  planned = sampled(std::move(planned), options);
  if (planned.empty()) throw InputError(specification.string() + ": no cell matches what is asked for");
  std::vector<CellValues> cells;
  for (const Planned& p : planned) cells.push_back({p.cell.kind, p.cell.values, specification.string()});
  std::vector<Job> jobs;
  for (const Planned& p : planned)
    jobs.push_back({p.cell.method + ": " + p.cell.name,
                    [&p, &options, &folder] { return run_cell(p, options.seed, folder); }});
  const RunOutcome run = run_jobs(jobs,
                                  {.folder = folder,
                                   .fingerprint = fingerprint(options),
                                   .files = digests_of(cells, specification),
                                   .resume = options.resume,
                                   .noun = "cells"},
                                  progress);
  Atlas atlas{{}, run.interrupted, run.done, jobs.size(), options.seed};
  for (std::size_t k = 0; k < planned.size(); ++k) {
    if (!run.jobs[k].done) continue;
    fill(planned[k].cell, run.jobs[k], planned[k].seeds);
    atlas.cells.push_back(std::move(planned[k].cell));
  }
  return atlas;
}

namespace {

Json counts_json(const std::array<int, 5>& counts) {
  Json json;
  for (std::size_t o = 0; o < counts.size(); ++o) json[outcome_words[o]] = counts[o];
  return json;
}

std::map<std::string, std::array<int, 5>> counts_by_method(const Atlas& atlas, bool hidden) {
  std::map<std::string, std::array<int, 5>> methods;
  for (const AtlasCell& cell : atlas.cells) {
    if (cell.hidden != hidden) continue;
    auto& counts = methods[cell.method];
    for (std::size_t o = 0; o < counts.size(); ++o) counts[o] += cell.counts[o];
  }
  return methods;
}

}  // namespace

Json atlas_summary(const Atlas& atlas) {
  int conditions = 0;
  std::size_t seeds = 0;
  for (const AtlasCell& cell : atlas.cells) {
    if (cell.hidden || cell.method != "laterna") continue;
    seeds = conditions == 0 ? cell.letters.size() : std::min(seeds, cell.letters.size());
    ++conditions;
  }
  Json json{
      {"conditions", conditions}, {"seeds", seeds}, {"methods", Json::object()}, {"hidden", Json::object()}};
  for (const auto& [method, counts] : counts_by_method(atlas, false))
    json["methods"][method] = counts_json(counts);
  for (const auto& [method, counts] : counts_by_method(atlas, true))
    json["hidden"][method] = counts_json(counts);
  return json;
}

Json atlas_letters(const Atlas& atlas) {
  Json letters = Json::object();
  for (const AtlasCell& cell : atlas.cells)
    if (cell.method == "laterna") letters[cell.name] = cell.letters;
  return letters;
}

namespace {

std::string command_of(const AtlasCell& cell, const std::string& specification, std::uint64_t seed) {
  const std::string words = seed == 1 ? "" : fmt::format(" --seed {}", seed);
  return fmt::format("laterna atlas {} --cell {} --method {}{} -o {}", shell_word(specification),
                     shell_word(cell.name), cell.method, words,
                     folder_name(cell.method + ": " + cell.name, "cell"));
}

}  // namespace

Json atlas_cells(const Atlas& atlas, const std::string& specification) {
  Json cells = Json::array();
  for (const AtlasCell& c : atlas.cells) {
    Json json = counts_json(c.counts);
    json.update({{"grid", c.grid},
                 {"cell", c.name},
                 {"kind", c.kind},
                 {"method", c.method},
                 {"values", c.values},
                 {"hidden", c.hidden},
                 {"letters", c.letters},
                 {"error_px", finite_or_null(c.error_px)},
                 {"predicted_px", finite_or_null(c.predicted_px)},
                 {"reasons", c.reasons},
                 {"command", command_of(c, specification, atlas.seed)}});
    if (!c.picture.empty()) json["picture"] = c.picture;
    cells.push_back(std::move(json));
  }
  return cells;
}

std::string atlas_text(const Atlas& atlas) {
  const Json summary = atlas_summary(atlas);
  std::string text =
      fmt::format("{} conditions, at least {} seeds each\n{:<18} {:>8} {:>8} {:>8} {:>8} {:>8}\n",
                  summary["conditions"].get<int>(), summary["seeds"].get<int>(), "method", "right", "weak",
                  "refused", "silent", "crashed");
  for (const bool hidden : {false, true})
    for (const auto& [method, n] : counts_by_method(atlas, hidden))
      text += fmt::format("{:<18} {:>8} {:>8} {:>8} {:>8} {:>8}\n", method + (hidden ? " (hidden)" : ""),
                          n[0], n[1], n[2], n[3], n[4]);
  for (const AtlasCell& c : atlas.cells)
    if (c.method == "laterna" && !c.hidden && c.counts[3] + c.counts[4] > 0)
      text += fmt::format("{} {}: {} (error {:.3g}, predicted {:.3g} px)\n",
                          c.counts[4] > 0 ? "crashed" : "silently wrong", c.name, c.letters, c.error_px,
                          c.predicted_px);
  return text;
}

}  // namespace laterna
