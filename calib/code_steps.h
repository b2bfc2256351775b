// Were all pictures of a Gray code taken of one place?
#pragma once

#include "calib/decoded_map.h"

#include <glm/glm.hpp>

#include <optional>

namespace laterna {

/// A code whose coarser pictures show another place than its finer ones.
struct CodeSteps {
  bool rows = false;  ///< of the rows' code, else of the columns'
  int bit = 0;        ///< bits from this on against those below; 0 is the finest
  double asymmetry =
      0;  ///< mean of (left - right)/(left + right) over the coarse edges, less that over finer ones
  double deviations = 0;  ///< the same over its standard deviation
};

/// In a reflected binary code, bit k changes where a place is an odd multiple of 2^k. Pictures of finer bits
/// that were taken of a place m pixels away are read as its mirror image in a coarse edge that lies between:
/// of the 2m pixels around every such edge one half is never read, the other twice. How many camera pixels
/// read each column (row) is counted, two columns left of an edge are compared with two right of it, over all
/// edges of the bits from k on against edges of finer bits (which hold what the image's own grid and the
/// surface do), in the whole image and in its quadrants, for every k.
///
/// The worst case over k, both axes and all parts, where the asymmetry is at least 0.05 (some tenth of a
/// pixel) and six standard deviations from chance; none where no part says so. `decoded` comes from Gray
/// codes of the whole panel of `projector_size` px.
std::optional<CodeSteps> code_steps(const DecodedMap& decoded, glm::ivec2 projector_size);

}  // namespace laterna
