#include "apps/lab/grid_file.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  using namespace laterna;
  return fuzz::attempt([&] {
    for (const Grid& grid : parse_grids(fuzz::text_of(bytes, count), "fuzz.toml", {"seeds", "scene"}))
      cells_of(grid);
  });
}
