// An entry that gathers from a disc of the panel becomes one entry per panel pixel under the disc.
#pragma once

#include "render/light_rows.h"

#include <vector>

namespace laterna {

/// A disc of the panel, and the share of an entry's light that it takes, evenly over its area.
struct DiscShare {
  double diameter_px, share;
};

/// What blurs a projector's picture besides the entries' own footprints.
struct PanelBlur {
  glm::ivec2 panel_px{0, 0};
  bool clamp = false;     ///< beyond the panel: its edge pixels' light; else none
  double pixel_side = 1;  ///< of the square about a panel pixel's centre that emits, with 1/side²
  std::vector<DiscShare> discs{{0, 1}};  ///< a point spread as a sum of concentric discs; shares add to 1
};

/// How many cells an entry's disc is wide at most.
inline constexpr int most_cells_across = 32;

/// Replaces each entry (u, v, weight, footprint) by one for each panel pixel i that it gathers from, at the
/// pixel's centre, without a footprint, of weight
///
///   weight · Σ_k share_k · area(disc_k ∩ square_i) / (area(disc_k) · side²),
///   diameter_k = √(footprint² + diameter_px_k²)
///
/// (two discs one after the other are again one of the same second moment: exact where either is 0). So the
/// light of a white picture is kept, but for what falls beyond the panel. The areas are exact: with
/// Lookup::nearest this is the disc over panel pixels that are boxes; Lookup::bilinear reads the same there.
/// Entries of one pixel and one source that meet in a panel pixel become one. Where centres of entries (or
/// `discs`) spread by less than a 32nd, rms, of the footprint, one disc of the same light, centre and second
/// moment stands for them: the rays of an antialiased pixel then cost no more than one, and at most 2.5 % of
/// the light stands in a neighbouring pixel.
///
/// A disc wider than most_cells_across pixels is cut into cells of m×m panel pixels, m the smallest that
/// keeps it within that many cells; one pixel speaks for its cell, a different column and row of it from
/// cell to cell, so that no stripes of the pattern are favoured, and pixel_side counts as 1.
void spread_over_panel(LightRows& rows, const PanelBlur& blur);

}  // namespace laterna
