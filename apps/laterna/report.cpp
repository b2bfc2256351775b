#include "apps/lab/report/report_data.h"
#include "apps/lab/report/report_page.h"
#include "apps/lab/report/static_figures.h"
#include "apps/laterna/command.h"
#include "sim/safe_write.h"

#include <fmt/format.h>

#include <optional>

namespace laterna {

namespace {

struct Words {
  std::string path, out, figures;
  bool is_static = false;
};

// FOLDER/report.html, or FILE.html for a FILE.json.
std::filesystem::path default_output(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) return path / "report.html";
  std::filesystem::path page = path;
  return page.replace_extension(".html");
}

void fill(const PendingFolder& folder, const nlohmann::json& data) {
  for (const StaticFigure& figure : static_figures(data))
    write_file(folder.path() / figure.file_name(), figure.file_bytes());
}

std::string page_of(const nlohmann::json& data, const Words& words, const Common& common) {
  if (words.is_static) return static_report_page(data, StaticReason::asked);
  const std::filesystem::path bundle = report_bundle();
  if (!bundle.empty()) return report_page(data, bundle);
  progress(common, "no report.js beside the program (it was built without Node): static figures instead");
  return static_report_page(data, StaticReason::no_bundle);
}

int run(const Words& words, const Common& common) {
  const nlohmann::json data = report_data(words.path);
  if (common.json) {
    fmt::print("{}\n", data.dump());
    return exit_ok;
  }
  const std::filesystem::path out =
      words.out.empty() ? default_output(words.path) : std::filesystem::path(words.out);
  std::optional<PendingFolder> figures;
  if (!words.figures.empty()) fill(figures.emplace(words.figures), data);
  write_file(out, page_of(data, words, common));
  if (figures) figures->commit();
  fmt::print("open {}\n", out.string());
  return exit_ok;
}

}  // namespace

void add_report(CLI::App& app, Common& common) {
  auto words = std::make_shared<Words>();
  CLI::App* command =
      add_command(app, "report", "laterna report scene-roundtrip",
                  "Draws what Laterna left in a folder as one HTML file that opens offline: a round trip, a "
                  "capture, a calibration\nfrom boards, a self-calibration, plans, charts, an atlas, or "
                  "stored references of these.\nWith --json, prints the data that "
                  "the page holds, and writes nothing.");
  command->add_option("PATH", words->path, "Folder, or one JSON file of these")->required();
  command->add_option("-o,--output", words->out,
                      "HTML file, replaced where it exists (default: PATH/report.html)");
  command->add_option("--figures", words->figures,
                      "New folder for each figure as a file: drawings as SVG, pictures as PNG");
  command->add_flag("--static", words->is_static, "Static figures and no script");
  command->callback([words, &common] { common.exit_code = run(*words, common); });
}

}  // namespace laterna
