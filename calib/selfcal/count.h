// How many numbers the correspondences can give, and how many are asked for, before anything is solved.
#pragma once

#include "calib/selfcal/tracks.h"

#include <string>

namespace laterna {

/// Counted at a random rig with the same sightings, so it holds for points and placements in general position
/// and is an upper bound for special ones.
struct NumberCount {
  /// Numbers about the stations that the pixels give when every station is any 3×4 matrix: the rank of their
  /// derivatives with the points eliminated. A pair gives 7, m stations with long tracks 11m - 15, pairs
  /// alone 7 each; a point seen by s stations adds 2s - 3 until that is reached. A lens parameter that is
  /// asked for adds what no such matrix explains, its own number where points suffice.
  int given = 0;
  int stations = 0;
  int intrinsics = 0;  ///< unknown intrinsics of all devices, lens parameters among them
  int places = 0;      ///< numbers of the stations' places that pixels can tell: 6m - 7 with long tracks
  int unlinked = 0;    ///< 6(m - 1) - places: lengths of baselines that no pixel tells; 1 with long tracks
  int determined = 0;  ///< rank with intrinsics and places together

  int needed() const { return intrinsics + places; }
  /// A station that hangs on another by a pair gives 5; fewer leave its place open.
  bool joined() const { return stations >= 2 && places >= 5 * (stations - 1); }
  bool enough() const { return joined() && given >= needed() && determined == needed(); }
};

/// A lens counts as the shifts that it adds to a pinhole: where the centre of its distortion is known it
/// tells of the principal point too, which is not counted, since that may be as little as nothing. Throws
/// InputError for tracks that validate() refuses.
NumberCount count_numbers(const Tracks& tracks);

/// Why it is not enough: "one pair gives 7 numbers; known camera with unknown f, c_x, c_y of projector needs
/// 8". Empty where it is enough.
std::string shortage_in_words(const Tracks& tracks, const NumberCount& count);

}  // namespace laterna
