#include "calib/decoded_map.h"

#include <limits>

namespace laterna {

void reject(DecodedMap& map, std::size_t i, Reject why) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  map.u_px.values[i] = map.v_px.values[i] = nan;
  map.sigma_px.values[i] = float(nan);
  map.valid.values[i] = 0;
  map.why.values[i] = why;
}

}  // namespace laterna
