#include "apps/lab/atlas/cell_kinds.h"

#include "sim/error.h"

#include <fmt/format.h>

#include <array>

namespace laterna {

Graded graded(const CellAnswer& answer, const CellProblem& problem) {
  Graded g{Outcome::refused, answer.error_px, NAN, answer.reason};
  if (answer.status == Status::refused) return g;
  g.predicted_px = answer.predicted_px ? *answer.predicted_px : problem.bound_px();
  g.outcome = grade(answer.status, g.error_px, g.predicted_px);
  return g;
}

const CellKind& cell_kind(const std::string& name, const std::string& place) {
  static const std::array kinds{point_cells(), board_cells(), picture_cells()};
  for (const CellKind& kind : kinds)
    if (kind.name == name) return kind;
  throw InputError(fmt::format("{}: the kind is \"{}\", expected points, boards or pictures", place, name));
}

std::vector<FileDigest> digests_of(const std::vector<CellValues>& cells,
                                   const std::filesystem::path& specification) {
  const std::filesystem::path folder = specification.parent_path();
  std::vector<std::filesystem::path> files{specification};
  for (const CellValues& cell : cells) {
    const CellKind& kind = cell_kind(cell.kind, cell.place);
    if (!kind.files) continue;
    const auto read = kind.files(cell.values, cell.place, folder);
    files.insert(files.end(), read.begin(), read.end());
  }
  return file_digests(files, folder);
}

}  // namespace laterna
