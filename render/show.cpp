#include "render/show.h"

#include "sim/error.h"

#include <fmt/format.h>

#include <utility>

namespace laterna {

Show::Show(std::vector<AnyPatterns> all_sources, Timeline when)
    : sources(std::move(all_sources)), timeline(std::move(when)) {
  if (sources.empty()) throw InputError("show: no patterns, expected at least one stack");
  for (const AnyPatterns& source : sources) {
    if (source.count != frames())
      throw InputError(fmt::format("show: stacks of {} and {} patterns, expected one number of patterns",
                                   frames(), source.count));
    if ((source.bits != nullptr) != binary())
      throw InputError("show: binary patterns beside patterns of values, expected one kind");
  }
}

}  // namespace laterna
