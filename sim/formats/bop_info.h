// BOP's scene_gt_info.json: how much of each object a picture shows.
//
//   {"0": [{"bbox_obj": [x, y, w, h], "bbox_visib": [x, y, w, h], "px_count_all": n, "px_count_valid": n,
//           "px_count_visib": n, "visib_fract": f}, ...], ...}      as scene_gt.json lists the objects
//
//   px_count_all    pixels of the whole silhouette, as if the object stood there alone, with those that fall
//                   outside the picture, up to one picture beyond each edge
//   px_count_valid  pixels of the silhouette inside the picture that have a depth
//   px_count_visib  pixels where the object is seen
//   visib_fract     px_count_visib / px_count_all; 0 where that is 0
//   bbox_obj        box of the whole silhouette, bbox_visib of what is seen: the first column and row, then
//                   the last less the first (so a single pixel has 0, 0); -1, -1, -1, -1 where nothing is
//                   seen
//
// Whole pixels, numbered as here. BOP's own script finds what is seen by comparing distances within 15 mm;
// here it is what the camera's rays meet. Source: scripts/calc_gt_info.py, bop_toolkit_lib/misc.py of
// https://github.com/thodan/bop_toolkit
#pragma once

#include "sim/formats/tree.h"
#include "sim/image.h"

namespace laterna {

/// A set of pixels: how many, and the columns and rows from `low` to `high`, both included. Of an empty set,
/// low and high say nothing.
struct BopExtent {
  int count = 0;
  glm::ivec2 low{0, 0}, high{0, 0};
};

/// The pixels of a mask that are not 0; pixel (0, 0) of the mask is `first_px`.
BopExtent extent_of(const Image<std::uint8_t>& mask, glm::ivec2 first_px = {0, 0});

/// The union of two sets without a common pixel.
BopExtent merged(const BopExtent& a, const BopExtent& b);

/// One entry of scene_gt_info.json. `valid` counts px_count_valid.
Tree bop_info(const BopExtent& whole, int valid, const BopExtent& visible);

/// `whole` back from an entry; its box says nothing where the object is not seen. Throws InputError.
BopExtent bop_whole(const Place& entry);

}  // namespace laterna
