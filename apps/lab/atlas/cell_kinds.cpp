#include "apps/lab/atlas/cell_kinds.h"

#include "sim/error.h"

#include <fmt/format.h>

#include <array>

namespace laterna {

const CellKind& cell_kind(const std::string& name, const std::string& place) {
  static const std::array kinds{point_cells(), board_cells(), picture_cells()};
  for (const CellKind& kind : kinds)
    if (kind.name == name) return kind;
  throw InputError(fmt::format("{}: the kind is \"{}\", expected points, boards or pictures", place, name));
}

}  // namespace laterna
