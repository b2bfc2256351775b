// Rigs drawn at random, each calibrated once with noise: what mistakes are planted in.
#pragma once

#include "calib/correspondences.h"
#include "sim/formats/rig.h"

#include <random>

namespace laterna::testing {

/// A camera and a projector that see one surface.
struct CalibratedRig {
  Device camera, projector;  ///< true
  Correspondences seen;      ///< exact world points and true pixels of the surface, sigma as noisy as it was
  Device recovered;          ///< the projector, solved from `seen` with its noise
  double bound_px = 0;       ///< rms that the noise predicts over the volume
};

/// One in four has the devices of a scene of data/scenes. Else: pictures of eight sizes (square and upright
/// ones too), throw ratios 0.8 to 2.2, centres in the middle, near it or a lens shift away, half of the rigs
/// with a lens; 0.4 to 12 m from a surface with a relief of 5 to 50 % of that, turned a little or anyhow in
/// the world; 1,500 points with a noise of 0.02 to 0.4 px.
CalibratedRig random_rig(std::mt19937_64& random);

/// What a right calibration of it says, in the scene's world or, as calibrators do, in the camera's frame.
Rig right_result(const CalibratedRig& rig, bool in_camera_frame);

/// Correspondences of the device with points that fill its picture, `relief` of `distance_m` deep.
Correspondences points_before(const Device& projector, double distance_m, double relief, std::size_t count,
                              std::mt19937_64& random);

double uniform(std::mt19937_64& random, double low, double high);
std::size_t one_of(std::mt19937_64& random, std::size_t count);

}  // namespace laterna::testing
