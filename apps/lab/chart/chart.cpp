#include "apps/lab/chart/chart.h"

#include "apps/lab/atlas/cell_kinds.h"
#include "apps/lab/cell_seed.h"
#include "apps/lab/grid_settings.h"
#include "apps/lab/json_number.h"
#include "apps/lab/peak_memory.h"
#include "sim/error.h"
#include "sim/fields.h"
#include "sim/text_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <memory>

namespace laterna {

namespace {

using Json = nlohmann::json;

const std::vector<std::string> settings{"seeds", "repeats", "methods", "against", "seconds_per_picture"};

/// A point that is to be measured.
struct Planned {
  ChartPoint point;
  CellTrial trial;
  std::string cell;  ///< its name, for the seeds
  int repeats = 3;
  double seconds_per_picture = 1.0 / 60;
  std::shared_ptr<std::map<int, double>> bounds;  ///< by seed, shared by the methods of a cell
};

// The number that a grid's cell is drawn against, where it is no measured one.
double told_x(const Grid& grid, const std::string& against, const Json& values) {
  if (against == "seconds" || against == "capture_seconds") return NAN;
  const auto found = values.find(against);
  if (found == values.end() || !found->is_number())
    throw InputError(
        fmt::format("{}: against is \"{}\", expected seconds, capture_seconds or a key that holds numbers",
                    grid.place, against));
  return found->get<double>();
}

void plan_cell(const Grid& grid, const GridCell& cell, const CellTrial& trial, const ChartOptions& options,
               std::vector<Planned>& planned) {
  const CellKind& kind = cell_kind(grid.kind, grid.place);
  const std::vector<std::string> methods = methods_setting(grid, kind.methods);
  const auto bounds = std::make_shared<std::map<int, double>>();
  for (const std::string& method : methods) {
    Planned p{{},
              trial,
              cell.name,
              count_setting(grid, "repeats", 3),
              positive_setting(grid, "seconds_per_picture", 1.0 / 60),
              bounds};
    const bool several = methods.size() > 1;
    p.point.label = several
                        ? fmt::format("{}{} method={}", cell.name, cell.name == grid.name ? ":" : "", method)
                        : cell.name;
    p.point.series = several ? fmt::format("{}, {}", grid.name, method) : grid.name;
    p.point.kind = grid.kind, p.point.method = method, p.point.values = cell.values;
    p.point.seeds = count_setting(grid, "seeds", 5);
    p.point.x = told_x(grid, word_setting(grid, "against", "seconds"), cell.values);
    if (options.repeats > 0) p.repeats = options.repeats;
    planned.push_back(std::move(p));
  }
}

std::string against_of(const std::vector<Grid>& grids) {
  std::string against = word_setting(grids.front(), "against", "seconds");
  for (const Grid& grid : grids) {
    if (word_setting(grid, "against", "seconds") != against)
      throw InputError(grid.place + ": against differs from the first grid's, expected one x for the chart");
    if (against == "capture_seconds" && grid.kind != "pictures")
      throw InputError(grid.place + ": against is \"capture_seconds\", which pictures alone have");
  }
  return against;
}

// Those that are asked for, in the order of the specification.
std::vector<Planned> chosen(std::vector<Planned> planned, const ChartOptions& options,
                            const std::string& file) {
  if (options.points.empty()) return planned;
  std::vector<std::string> labels;
  for (const Planned& p : planned) labels.push_back(p.point.label);
  for (const std::string& label : options.points)
    if (std::find(labels.begin(), labels.end(), label) == labels.end())
      throw InputError(
          fmt::format("{}: no point \"{}\", did you mean \"{}\"?", file, label, nearest_key(label, labels)));
  std::erase_if(planned, [&](const Planned& p) {
    return std::find(options.points.begin(), options.points.end(), p.point.label) == options.points.end();
  });
  return planned;
}

CellAnswer try_once(const CellProblem& problem, const std::string& method, bool& crashed) {
  try {
    return problem.solve(method);
  } catch (const std::exception& error) {
    crashed = true;
    CellAnswer answer;
    answer.reason = error.what();
    return answer;
  }
}

double bound_of(const Planned& p, int k, const CellProblem& problem, const CellAnswer& answer) {
  if (p.point.kind == "pictures") return answer.independent_px.value_or(NAN);
  const auto [place, is_new] = p.bounds->try_emplace(k, NAN);
  if (is_new) place->second = problem.bound_px();
  return place->second;
}

/// What a seed gives: {"end", "reason", "error_px", "error_mm", "bound_px", "pictures", "peak_mib",
/// "seconds": [of each repeat], "stages": {name: [of each repeat]}}.
Json run_seed(const Planned& p, std::uint64_t seed, int k) {
  const bool counts_memory = restart_peak_memory();
  const CellProblem problem = p.trial(cell_seed(p.cell, seed, k));
  Json json{{"seconds", Json::array()}, {"stages", Json::object()}};
  CellAnswer answer;
  bool crashed = false;
  for (int r = 0; r < p.repeats && !crashed; ++r) {
    answer = try_once(problem, p.point.method, crashed);
    json["seconds"].push_back(answer.times.total());
    for (const auto& stage : answer.times.stages) json["stages"][stage.name].push_back(stage.seconds);
  }
  json["end"] = crashed                            ? "crashed"
                : answer.status == Status::refused ? "refused"
                : answer.status == Status::weak    ? "weak"
                                                   : "ok";
  json["reason"] = answer.reason;
  json["error_px"] = finite_or_null(answer.error_px), json["error_mm"] = finite_or_null(answer.error_mm);
  json["bound_px"] = finite_or_null(bound_of(p, k, problem, answer));
  json["pictures"] = answer.pictures;
  json["peak_mib"] = finite_or_null(counts_memory ? peak_memory_mib() : NAN);
  return json;
}

Json run_point(const Planned& p, std::uint64_t seed) {
  Json runs = Json::array();
  for (int k = 0; k < p.point.seeds; ++k) runs.push_back(run_seed(p, seed, k));
  return runs;
}

std::vector<double> numbers_under(const Json& runs, const char* key) {
  std::vector<double> numbers;
  for (const Json& run : runs)
    if (run.contains(key) && run[key].is_number()) numbers.push_back(run[key].get<double>());
  return numbers;
}

bool answered(const Json& run) { return run.at("end") == "ok" || run.at("end") == "weak"; }

// An answer that cannot map its volume is infinitely wrong, not left out.
std::vector<double> errors_of(const Json& runs) {
  std::vector<double> errors;
  for (const Json& run : runs)
    if (answered(run))
      errors.push_back(run.at("error_px").is_number() ? run["error_px"].get<double>() : double(INFINITY));
  return errors;
}

// Only of seeds that were answered: a refusal may come at once.
void fill_seconds(const Json& runs, ChartPoint& point) {
  std::vector<double> middle, low, high;
  std::map<std::string, std::vector<double>> stages;
  for (const Json& run : runs) {
    if (!answered(run)) continue;
    const auto seconds = run.at("seconds").get<std::vector<double>>();
    middle.push_back(quartiles(seconds).middle);
    low.push_back(*std::min_element(seconds.begin(), seconds.end()));
    high.push_back(*std::max_element(seconds.begin(), seconds.end()));
    for (const auto& [name, times] : run.at("stages").items())
      for (const Json& time : times) stages[name].push_back(time.get<double>());
  }
  point.seconds = quartiles(middle).middle;
  point.seconds_low = quartiles(low).middle, point.seconds_high = quartiles(high).middle;
  for (const auto& [name, times] : stages) point.stages.emplace_back(name, quartiles(times).middle);
}

void fill(Planned& p, const JobOutcome& outcome, const std::string& against) {
  ChartPoint& point = p.point;
  if (!outcome.crashed.empty()) {
    point.crashed = point.seeds, point.reason = outcome.crashed;
    return;
  }
  const Json& runs = outcome.result;
  for (const Json& run : runs) {
    const auto end = run.at("end").get<std::string>();
    ++(end == "ok"        ? point.ok
       : end == "weak"    ? point.weak
       : end == "refused" ? point.refused
                          : point.crashed);
    if (point.reason.empty()) point.reason = run.at("reason").get<std::string>();
    point.pictures = std::max(point.pictures, run.at("pictures").get<int>());
  }
  point.error_px = quartiles(errors_of(runs));
  point.error_mm = quartiles(numbers_under(runs, "error_mm")).middle;
  point.bound_px = quartiles(numbers_under(runs, "bound_px")).middle;
  point.peak_mib = quartiles(numbers_under(runs, "peak_mib")).middle;
  point.bound = point.kind == "pictures" ? "predicted_volume_rms_independent_px" : "cramer_rao";
  fill_seconds(runs, point);
  if (point.pictures > 0) point.capture_seconds = point.pictures * p.seconds_per_picture;
  if (against == "seconds") point.x = point.seconds;
  if (against == "capture_seconds") point.x = point.capture_seconds;
}

}  // namespace

Quartiles quartiles(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    const double place = share * double(values.size() - 1);
    const auto below = std::size_t(place);
    const auto above = std::min(below + 1, values.size() - 1);
    const double weight = place - double(below);  // 0 and infinity would give NaN
    return weight == 0 ? values[below] : values[below] + weight * (values[above] - values[below]);
  };
  return {at(0.25), at(0.5), at(0.75)};
}

std::vector<std::size_t> pareto_front(const std::vector<ChartPoint>& points) {
  const auto counts = [](const ChartPoint& p) {
    return p.ok + p.weak == p.seeds && std::isfinite(p.x) && std::isfinite(p.error_px.middle);
  };
  std::vector<std::size_t> front;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto beats = [&, x = points[k].x, e = points[k].error_px.middle](const ChartPoint& other) {
      return counts(other) && other.x <= x && other.error_px.middle <= e &&
             (other.x < x || other.error_px.middle < e);
    };
    if (counts(points[k]) && std::none_of(points.begin(), points.end(), beats)) front.push_back(k);
  }
  std::stable_sort(front.begin(), front.end(),
                   [&](std::size_t a, std::size_t b) { return points[a].x < points[b].x; });
  return front;
}

Chart run_chart(const std::filesystem::path& specification, const std::filesystem::path& folder,
                const ChartOptions& options, const Progress& progress) {
  const std::string text = read_text(specification, std::size_t(16) << 20);
  const std::vector<Grid> grids = parse_grids(text, specification.string(), settings);
  Chart chart{specification.stem().string(), against_of(grids), false, {}, false, 0, 0};
  std::vector<Planned> planned;
  std::vector<CellValues> cells;
  for (const Grid& grid : grids) {
    const CellKind& kind = cell_kind(grid.kind, grid.place);
    for (const GridCell& cell : cells_of(grid)) {
      cells.push_back({grid.kind, cell.values, grid.place});
      plan_cell(grid, cell, kind.prepare(cell.values, grid.place, specification.parent_path()), options,
                planned);
    }
  }
  planned = chosen(std::move(planned), options, specification.string());
  std::vector<Job> jobs;
  for (const Planned& p : planned)
    jobs.push_back({p.point.label, [&p, &options] { return run_point(p, options.seed); }});
  const RunOutcome run =
      run_jobs(jobs,
               {.folder = folder,
                .fingerprint = fmt::format("chart, seed {} repeats {} points {}", options.seed,
                                           options.repeats, fmt::join(options.points, "|")),
                .files = digests_of(cells, specification),
                .resume = options.resume,
                .parallel = false,
                .noun = "points"},
               progress);
  chart.interrupted = run.interrupted, chart.done = run.done, chart.all = jobs.size();
  for (std::size_t k = 0; k < planned.size(); ++k) {
    if (!run.jobs[k].done) continue;
    fill(planned[k], run.jobs[k], chart.against);
    chart.points.push_back(std::move(planned[k].point));
  }
  return chart;
}

}  // namespace laterna
