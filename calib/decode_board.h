// Pictures of a projected board to projector pixels: a sparse map.
#pragma once

#include "calib/decoded_map.h"
#include "sim/image_view.h"
#include "sim/pattern_sequence.h"

namespace laterna {

/// Finds the corners of a projected chessboard or ChArUco board (OpenCV) in the board's picture between black
/// and white. The camera pixel nearest to a corner at (x, y) becomes valid: (u, v) = corner + J·(pixel - (x,
/// y)), J being the projector pixels per camera pixel between the corner's neighbours in the board. A corner
/// without a neighbour along each board axis is left out. `sigma_px` is 0.1 camera pixels times J (root mean
/// square), `confidence` 1. All other pixels are `dim` or `pair`.
///
/// A chessboard must be seen whole, and does not tell a mirrored picture from a plain one; markers do. No
/// board found: a map without a valid pixel. Throws InputError where the pictures are not three.
DecodedMap decode_board(const CapturedView& pictures, const PatternSequence& sequence);

}  // namespace laterna
