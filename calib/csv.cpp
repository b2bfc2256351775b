#include "calib/csv.h"

#include "sim/error.h"
#include "sim/text_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

namespace laterna {

namespace {

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

template <class T>
bool parse(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

std::vector<std::string_view> split_trimmed(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(trimmed(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return parts;
}

void CsvLine::refuse(int column, const char* expected) const {
  throw InputError(
      fmt::format("{}: {} is \"{}\", expected {}", place, (*columns)[column], cells[column], expected));
}

int CsvLine::whole(int column) const {
  int value = -1;
  if (!parse(cells[column], value) || value < 0) refuse(column, "a whole number from 0");
  return value;
}

double CsvLine::number(int column) const {
  double value = 0;
  if (!parse(cells[column], value) || !std::isfinite(value)) refuse(column, "a finite number");
  return value;
}

bool CsvLine::flag(int column) const {
  if (cells[column] != "0" && cells[column] != "1") refuse(column, "0 or 1");
  return cells[column] == "1";
}

std::string CsvLine::text(int column) const {
  if (cells[column].empty()) refuse(column, "a name");
  return std::string(cells[column]);
}

bool CsvLine::is_absent(int column) const {
  double value = 0;
  return cells[column].empty() || (parse(cells[column], value) && std::isnan(value));
}

std::vector<CsvLine> csv_lines(std::string_view text, const std::string& file_name,
                               const std::vector<std::string>& required,
                               const std::vector<std::string>& optional, std::vector<std::string>& columns) {
  check_text(text, file_name);
  columns = required;
  columns.insert(columns.end(), optional.begin(), optional.end());
  const std::vector<std::string_view> lines = split_trimmed(text, '\n');
  const std::vector<std::string_view> header = split_trimmed(lines.front(), ',');
  std::vector<std::size_t> at;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const auto count = std::count(header.begin(), header.end(), columns[c]);
    if (count > 1 || (count == 0 && c < required.size())) {
      throw InputError(
          fmt::format("{}: line 1: the header has {} columns named \"{}\", expected one each of {}",
                      file_name, count, columns[c], fmt::join(required, ",")));
    }
    at.push_back(std::size_t(std::find(header.begin(), header.end(), columns[c]) - header.begin()));
  }
  std::vector<CsvLine> result;
  for (std::size_t n = 1; n < lines.size(); ++n) {
    if (lines[n].empty()) continue;
    CsvLine line{fmt::format("{}: line {}", file_name, n + 1), &columns, {}};
    const std::vector<std::string_view> cells = split_trimmed(lines[n], ',');
    if (cells.size() != header.size()) {
      throw InputError(fmt::format("{}: found {} cells, expected {} as in the header", line.place,
                                   cells.size(), header.size()));
    }
    for (const std::size_t i : at) line.cells.push_back(i < cells.size() ? cells[i] : std::string_view());
    result.push_back(std::move(line));
  }
  return result;
}

}  // namespace laterna
