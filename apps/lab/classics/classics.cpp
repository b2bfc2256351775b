#include "apps/lab/classics/classics.h"

#include "apps/lab/classics/table.h"
#include "sim/error.h"
#include "sim/image_file.h"
#include "sim/safe_write.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

namespace laterna {

std::span<const Classic> all_classics() { return classic_table; }

double figure(const ClassicResult& result, const std::string& name) {
  const auto found = std::ranges::find(result.figures, name, &ClassicFigure::name);
  if (found == result.figures.end()) throw std::logic_error("no figure is called " + name);
  return found->value;
}

std::vector<Classic> find_classics(const std::vector<std::string>& names) {
  std::vector<Classic> found;
  std::ranges::copy_if(all_classics(), std::back_inserter(found), [&](const Classic& classic) {
    return names.empty() || std::ranges::find(names, classic.name) != names.end();
  });
  for (const std::string& name : names) {
    if (std::ranges::find(found, name, &Classic::name) != found.end()) continue;
    std::vector<std::string> known;
    for (const Classic& classic : all_classics()) known.emplace_back(classic.name);
    throw InputError(
        fmt::format("found no classic \"{}\", expected one of {}", name, fmt::join(known, ", ")));
  }
  return found;
}

std::vector<MadeClassic> make_classics(const std::vector<Classic>& classics,
                                       const std::filesystem::path& scenes) {
  std::vector<MadeClassic> made;
  for (const Classic& classic : classics) made.push_back({classic, classic.make(scenes)});
  return made;
}

namespace {

nlohmann::json chart_json(const LineChart& chart) {
  auto all = nlohmann::json::array();
  for (const auto& series : chart.series)
    all.push_back({{"name", series.name}, {"tolerance", series.tolerance}, {"points", series.points}});
  return {{"title", chart.title}, {"x", chart.x_title}, {"y", chart.y_title}, {"series", all}};
}

nlohmann::json result_json(const MadeClassic& made) {
  nlohmann::json json{{"system", made.classic.system},
                      {"must_be_seen", made.classic.must_be_seen},
                      {"pictures", nlohmann::json::array()},
                      {"figures", nlohmann::json::object()},
                      {"charts", nlohmann::json::object()}};
  for (const ClassicPicture& picture : made.result.pictures)
    json["pictures"].push_back(picture.name + ".png");
  for (const ClassicFigure& f : made.result.figures)
    json["figures"][f.name] = {{"value", f.value}, {"unit", f.unit}, {"tolerance", f.tolerance}};
  for (const LineChart& chart : made.result.charts) json["charts"][chart.name] = chart_json(chart);
  return json;
}

// One channel where the picture is grey: less than half the bytes.
void write_small(const std::filesystem::path& path, const Canvas& canvas) {
  Image<std::uint8_t> grey(canvas.width, canvas.height);
  for (std::size_t i = 0; i < grey.values.size(); ++i) {
    const std::uint8_t* rgb = canvas.rgb.data() + 3 * i;
    if (rgb[0] != rgb[1] || rgb[0] != rgb[2]) return write_canvas(path, canvas);
    grey.values[i] = rgb[0];
  }
  write_picture(path, grey);
}

}  // namespace

nlohmann::json classics_json(const std::vector<MadeClassic>& made) {
  nlohmann::json json = nlohmann::json::object();
  for (const MadeClassic& one : made) json[one.classic.name] = result_json(one);
  return json;
}

std::string classics_text(const std::vector<MadeClassic>& made) {
  std::string text;
  for (const MadeClassic& one : made) {
    text += fmt::format("{}: {}\n", one.classic.name, one.classic.system);
    for (const ClassicFigure& f : one.result.figures)
      text += fmt::format("  {:<52} {:.4g}{}{}\n", f.name, f.value, f.unit.empty() ? "" : " ", f.unit);
  }
  return text;
}

void write_classics(const std::vector<MadeClassic>& made, const std::filesystem::path& out) {
  PendingFolder folder(out);
  for (const MadeClassic& one : made) {
    for (const ClassicPicture& picture : one.result.pictures)
      write_small(folder.path() / (picture.name + ".png"), picture.canvas);
    for (const LineChart& chart : one.result.charts)
      write_file(folder.path() / (chart.name + ".svg"), line_chart_svg(chart));
  }
  write_file(folder.path() / "classics.json", classics_json(made).dump(1) + "\n");
  folder.commit();
}

}  // namespace laterna
