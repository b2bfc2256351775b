#include "apps/lab/chart/chart.h"
#include "apps/lab/chart/chart_report.h"
#include "apps/lab/chart/chart_svg.h"
#include "apps/laterna/command.h"
#include "sim/safe_write.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace laterna {

namespace {

struct Words {
  std::string sweep, out;
  ChartOptions options;
};

int run(Words& words, const Common& common) {
  const StopSignals signals;  // until the results are written
  words.options.seed = common.seed;
  const Chart chart = run_chart(words.sweep, words.out, words.options,
                                [&](const std::string& line) { progress(common, line); });
  if (chart.interrupted || StopSignals::asked()) {
    fmt::print(stderr,
               "laterna: interrupted with {} of {} points done; the same command with --resume goes on\n",
               chart.done, chart.all);
    return exit_interrupted;
  }
  const std::filesystem::path out(words.out);
  write_file(out / "chart.json", chart_json(chart, words.sweep, common.seed).dump(1) + "\n");
  write_file(out / "reference.json", chart_reference(chart).dump(1) + "\n");
  write_file(out / "chart.csv", chart_csv(chart));
  write_file(out / "chart.svg", chart_svg(chart));
  if (common.json)
    fmt::print("{}\n", chart_summary(chart, words.sweep, common.seed).dump());
  else
    fmt::print("{}open {}\n", chart_text(chart), (out / "chart.svg").string());
  return exit_ok;
}

}  // namespace

void add_chart(CLI::App& app, Common& common) {
  auto words = std::make_shared<Words>();
  CLI::App* command = add_command(
      app, "chart", "laterna chart data/charts/point_solvers.toml -o solvers",
      "Speed against accuracy: measures every point of a sweep on several seeds, and draws error, spread, "
      "bound and seconds\n"
      "with the front that nothing beats. Leaves chart.svg, chart.json, chart.csv, and reference.json: what "
      "holds on every machine.\n"
      "Ctrl-C leaves what is done; --resume goes on. Exit code 5: interrupted.");
  command->add_option("SWEEP", words->sweep, "Sweep (TOML, grids of points; apps/lab/chart/chart.h)")
      ->required();
  command->add_option("-o,--output", words->out, "Folder for the results, new unless --resume")->required();
  command->add_flag("--resume", words->options.resume,
                    "Goes on where an interrupted run of the same words stopped");
  command->add_option("--point", words->options.points, "Only the points of these labels");
  command
      ->add_option("--repeats", words->options.repeats,
                   "How often each problem is solved, for the seconds, in place of the sweep's own")
      ->check(CLI::Range(1, 1000));
  command->callback([words, &common] { common.exit_code = run(*words, common); });
}

}  // namespace laterna
