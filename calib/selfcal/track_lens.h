// Lenses of self-calibrated devices: known ones are undone for the start, unknown ones begin at none.
#pragma once

#include "calib/selfcal/pair_outliers.h"

#include <string>
#include <vector>

namespace laterna {

/// The tracks as pinholes see them: pixels without the known lens of a device whose intrinsics are held; all
/// other lenses are passed over. Sightings that a known lens maps to no ray are left out and named, with an
/// infinite residual. What start values and pairs are made from.
Tracks pinhole_view(const Tracks& tracks, std::vector<DroppedSighting>& left_out);

/// The inverse: puts the devices' lenses back, and pixels through those that pinhole_view() had undone, to
/// 1e-9 px.
void put_lenses_back(const std::vector<TrackDevice>& devices, Tracks& tracks);
void put_lens_back(const TrackDevice& device, glm::dvec2& pixel);

/// Gives a device the lens of these distortion terms (boards/rig.h: lens_terms()), all of them free; those
/// that it had keep their values, new ones begin at 0.
void set_lens_terms(Tracks& tracks, TrackRig& rig, std::size_t device, const std::vector<std::string>& terms);

/// Devices whose lens is estimated and maps no ray to a corner of the image: it folds over before. Names.
std::vector<std::string> folded_lenses(const Tracks& tracks, const TrackRig& rig);

/// How well the lens of a device is known: the largest sigma of a lens parameter, in shares of f at the
/// image's farthest corner (track_rig.h: natural_units()). 0 where none is free.
double largest_lens_sigma(const Tracks& tracks, const TrackRig& rig, const std::vector<double>& sigma);

/// The distortion of a pinhole, or of fewer terms, that the residuals ask for: χ² of what k1, k2, p1, p2 of
/// one device would change (Wald's test on the step of Gauss and Newton that frees them, all else moving
/// along, with `variance` times the sightings' covariance).
struct TrackLensLeftOut {
  std::string device;
  double k1 = 0;
  double chi2 = 0;      ///< with `terms` degrees of freedom where there is no such lens
  double moved_px = 0;  ///< rms over the points of what the step moves in the device's stations
  int terms = 0;
};

/// The device with the largest χ² for each degree of freedom; `terms` is 0 where every lens is known, has the
/// four terms already, or cannot be told from the rest.
TrackLensLeftOut track_lens_left_out(const Tracks& tracks, const TrackRig& rig,
                                     const std::vector<UnitBaseline>& units, double variance);

}  // namespace laterna
