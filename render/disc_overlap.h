// The area that a disc and a rectangle share.
#pragma once

namespace laterna {

/// A line across the unit disc, from the centre outwards, and half the area between it and the parallel
/// line through the centre: (x√(1-x²) + asin x)/2. Lines beyond the disc count as its tangent.
struct DiscEdge {
  double at, half_area;
};
DiscEdge disc_edge(double at_radii);

/// Share of the disc's area in [left, right] × [top, bottom], each edge measured in radii from the centre: 1
/// for a rectangle that holds the disc. Exact to rounding, 1e-15.
double disc_share(const DiscEdge& left, const DiscEdge& right, const DiscEdge& top, const DiscEdge& bottom);

}  // namespace laterna
