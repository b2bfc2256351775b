// From a rig with lean lenses to one with splined ones (splined_lens.h).
#pragma once

#include "calib/boards/rig_fit.h"

#include <string>
#include <vector>

namespace laterna {

using DeviceTerms = std::vector<std::vector<std::string>>;  ///< of each device (rig.h: lens_terms())

/// k1, k2, p1, p2 in the place of splined terms: what is fitted before.
DeviceTerms lean_terms(DeviceTerms terms);

/// The fitted rig with the lenses of `terms`: devices whose terms are splined get a start like their lean
/// lens, and `splined` becomes the model that covers the device's image.
BoardRig with_splines(const RigFit& lean, DeviceTerms& terms);

/// Gives splined devices of a model their priors about a rig that has them already.
void add_spline_priors(RigModel& model, const BoardRig& rig);

}  // namespace laterna
