#include "apps/lab/report/svg_atlas.h"

#include "apps/lab/atlas/outcome.h"
#include "apps/lab/chart/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace laterna {

using Json = nlohmann::json;

namespace {

constexpr int across = 40;
constexpr double side = 14, left = 250, letter = 6.6;
// By Outcome; Okabe and Ito's, which the colour-blind tell apart, and a darker purple.
constexpr std::array<const char*, 5> colours{"#009E73", "#E69F00", "#56B4E9", "#D55E00", "#7a3b8f"};

// Cells of one method that belong together under one name.
struct Row {
  std::string name;
  std::vector<const Json*> cells;
};

std::vector<Row> rows_of(const Json& cells, const std::string& method, bool hidden) {
  std::vector<Row> rows;
  for (const Json& cell : cells) {
    if (cell["method"] != method || cell["hidden"] != hidden) continue;
    const std::string grid = cell["grid"];
    auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.name == grid; });
    if (row == rows.end()) row = rows.insert(row, {grid, {}});
    row->cells.push_back(&cell);
  }
  return rows;
}

double height_of(const std::vector<Row>& rows) {
  double height = 0;
  for (const Row& row : rows) height += side * std::ceil(double(row.cells.size()) / across) + 6;
  return height;
}

std::size_t outcome_index(const Json& cell) {
  const auto found = std::find(outcome_words.begin(), outcome_words.end(), cell_outcome(cell));
  return std::size_t(found - outcome_words.begin());
}

void draw_rows(Svg& svg, const std::vector<Row>& rows, double y) {
  for (const Row& row : rows) {
    svg.text(left - 10, y + side - 3, row.name, 12, Svg::Anchor::end);
    for (std::size_t k = 0; k < row.cells.size(); ++k) {
      const Json& cell = *row.cells[k];
      const std::size_t outcome = outcome_index(cell), column = k % across, line = k / across;
      const double x = left + side * double(column), top = y + side * double(line);
      svg.rect(x, top, side - 1, side - 1, colours[outcome]);
      svg.hinted_text(x + side / 2 - 0.5, top + side - 4, std::string(1, outcome_letters[outcome]), 10,
                      outcome == 4 ? "#fff" : "#000",
                      fmt::format("{}: {}", cell["cell"].get<std::string>(), outcome_words[outcome]));
    }
    y += side * std::ceil(double(row.cells.size()) / across) + 6;
  }
}

void draw_key(Svg& svg) {
  double x = 20;
  for (std::size_t k = 0; k < outcome_words.size(); ++k) {
    const std::string words = fmt::format("{}: {}", outcome_letters[k], outcome_words[k]);
    svg.rect(x, 36, 12, 12, colours[k]);
    svg.text(x + 18, 46, words, 13);
    x += 46 + letter * double(words.size());
  }
}

}  // namespace

std::string cell_outcome(const Json& cell) {
  for (const char* word : {"crashed", "silent"})
    if (cell.at(word).get<int>() > 0) return word;
  std::string most = "right";
  for (const char* word : {"weak", "refused"})
    if (cell.at(word).get<int>() > cell.at(most).get<int>()) most = word;
  return most;
}

std::vector<std::string> methods_of(const Json& cells) {
  std::vector<std::string> methods;
  for (const Json& cell : cells) {
    const std::string method = cell["method"];
    if (std::find(methods.begin(), methods.end(), method) == methods.end()) methods.push_back(method);
  }
  return methods;
}

std::string atlas_svg(const Json& cells, const std::string& method) {
  const std::vector<Row> counted = rows_of(cells, method, false), hidden = rows_of(cells, method, true);
  const double top = 68, below = top + height_of(counted) + 24;
  Svg svg(left + side * across + 20, hidden.empty() ? below - 10 : below + height_of(hidden) + 10,
          "Outcomes of method " + method);
  svg.text(
      20, 22,
      fmt::format("Method {}: a square per condition; S and X where any seed is, else what most are", method),
      16);
  draw_key(svg);
  draw_rows(svg, counted, top);
  if (!hidden.empty()) {
    svg.text(left, below - 8, "what no data can reveal, not counted", 12);
    draw_rows(svg, hidden, below);
  }
  return svg.str();
}

}  // namespace laterna
