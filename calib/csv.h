// Comma-separated tables with a header line, cell by cell.
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace laterna {

/// Parts between separators, without blanks around them.
std::vector<std::string_view> split_trimmed(std::string_view text, char separator);

/// One line: its cells by known column, and where it stands.
struct CsvLine {
  std::string place;  ///< "file.csv: line 3"
  const std::vector<std::string>* columns;
  std::vector<std::string_view> cells;  ///< one per known column; empty where an optional one is absent

  /// Throws InputError: "file.csv: line 3: cam_x is "one", expected a finite number".
  [[noreturn]] void refuse(int column, const char* expected) const;
  int whole(int column) const;         ///< from 0
  double number(int column) const;     ///< finite
  bool flag(int column) const;         ///< 0 or 1
  std::string text(int column) const;  ///< not empty
  bool is_absent(int column) const;    ///< empty or nan
};

/// The lines below a header that names all of `required` once and each of `optional` at most once, in any
/// order; other columns and empty lines are passed over. `text` must outlive the result, and so must
/// `columns`, which becomes required + optional. Throws InputError, beginning with the file and the line, for
/// text that check_text() refuses, a missing or repeated column, and a wrong number of cells.
std::vector<CsvLine> csv_lines(std::string_view text, const std::string& file_name,
                               const std::vector<std::string>& required,
                               const std::vector<std::string>& optional, std::vector<std::string>& columns);

}  // namespace laterna
