// The rows of A: image = A·pattern + ambient, a region of the camera's image at a time. A is never held
// whole.
#pragma once

#include "render/direct_light.h"
#include "render/pixel_array.h"

#include <functional>
#include <span>
#include <vector>

namespace laterna {

/// Light that reaches a camera pixel from one place of one source's picture.
struct LightEntry {
  double u_px, v_px;         ///< projector pixel
  double weight;             ///< luminance at the camera pixel, in cd/m², where the picture is 1 at (u, v)
  float footprint_px = 0;    ///< diameter of the disc of the picture that it gathers from; 0: a point
  std::uint32_t source = 0;  ///< whose picture: index into Show::sources (one primary of one projector)
};

/// The rows of A for a region's pixels, row by row: those of pixel p are entries[begin[p]] to
/// entries[begin[p + 1] - 1].
struct LightRows {
  PixelRegion region;
  std::vector<std::uint32_t> begin;       ///< region.size() + 1
  std::vector<LightEntry> entries;        ///< none where the pixel is dark
  std::vector<double> ambient_cd_per_m2;  ///< one per pixel: what no picture changes
};

/// Fills `rows` for rows.region, which the caller sets; what `rows` held before is replaced. Called on
/// several threads at once. Effects wrap one of these in another.
using RowSource = std::function<void(LightRows& rows)>;

/// Gathers entries in any order of pixels; those of one pixel keep the order in which they came.
class RowBuilder {
 public:
  explicit RowBuilder(std::size_t pixels) : count_(pixels, 0) {}
  void add(std::size_t pixel, const LightEntry& entry) {
    ++count_[pixel];
    pixel_.push_back(std::uint32_t(pixel));
    entries_.push_back(entry);
  }
  /// Writes rows.begin and rows.entries.
  void finish(LightRows& rows) const;

 private:
  std::vector<std::uint32_t> count_, pixel_;
  std::vector<LightEntry> entries_;
};

/// A projector that shows black while another one plays: its light is `share` of its white, and no picture
/// changes it.
struct IdleLight {
  const LightMap* light;
  double share;
};

/// Luminance of pixel p that no picture changes, in cd/m²: ambient light and that of idle projectors.
double constant_luminance_cd_per_m2(const SurfaceMap& surface, std::span<const IdleLight> idle,
                                    double ambient_lx, std::size_t p);

/// Rows of direct light, one entry where lit, from maps that cover the region (the whole image's, say).
void direct_rows(const SurfaceMap& surface, const LightMap& light, std::span<const IdleLight> idle,
                 double ambient_lx, LightRows& rows);

}  // namespace laterna
