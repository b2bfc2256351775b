// Do all pictures of a sequence with fringes show the same places?
#pragma once

#include "calib/decoded_map.h"
#include "sim/image_view.h"
#include "sim/pattern_sequence.h"

#include <optional>
#include <vector>

namespace laterna {

/// How far from the decoded places one group of pictures shows them, on average.
struct GroupPlace {
  PatternGroup group;
  double mean_px = 0;   ///< shown - decoded, along the group's axis
  double sigma_px = 0;  ///< of the mean, from the spread over pixels
};

/// Of a fringe of at least three steps, the mean of p·wrap(φ/2π - u/p). Of a pair of a gray_phase code, whose
/// edges the fringes locate: of the pixels less than a quarter of a stripe from an edge, 2w times the share
/// that is read as if it lay beyond the edge, forward less backward (w: that quarter). Regularly chosen
/// pixels, at most some 65,000; groups that fewer than 500 of them tell of are left out. Empty for families
/// without fringes and for micro_phase, whose single pictures are fitted together.
std::vector<GroupPlace> group_places(const CapturedView& pictures, const PatternSequence& sequence,
                                     const DecodedMap& map);

/// The two groups of one axis that differ most, where they do by more than 0.1 px and six standard
/// deviations: pictures that were not taken of one place, since errors of single fringes and edges average
/// out over their periods.
std::optional<std::pair<GroupPlace, GroupPlace>> farthest_apart(const std::vector<GroupPlace>& places);

}  // namespace laterna
