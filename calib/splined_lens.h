// Splined lens models (sim/lens.h) in the solvers: a grid that covers a device's image, knots to begin with,
// and what holds those that no point reaches.
//
// A spline with a free core (fx, fy, cx, cy) would be redundant: a scale or a shift of all knots is one of
// the core. The core is therefore held at that of a lean lens that was fitted before, as mrcal does, and each
// knot has a prior about that lens's value.
#pragma once

#include "calib/intrinsics_prior.h"
#include "sim/device.h"

#include <string>
#include <vector>

namespace laterna {

/// How far a spline is believed to depart from the lean lens: standard deviation of each knot, as a share of
/// the focal length. Weak beside what points say of a knot (some 1e-4), and what is predicted where no point
/// reaches: a fiftieth of the focal length.
constexpr double spline_departure = 0.02;

/// A cubic model whose field of view covers the image of a device under its lens with square cells, `across`
/// of them over the wider side. Throws InputError where the lens maps no ray to the image's border.
std::string spline_over_image(const Device& device, int across = 6);

/// fx, fy, cx, cy of the device, and the knots whose Δu is that of its lens at the image's pixel nearest to
/// the knot's own. Within some 5e-3 of the focal length of the lens, for a start.
std::vector<double> spline_like(const Device& device, const std::string& splined_model);

/// Holds the core (to 1e-6 px) and each knot to `parameters` within spline_departure.
IntrinsicsPrior spline_prior(const std::vector<double>& parameters);

}  // namespace laterna
