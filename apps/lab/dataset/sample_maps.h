// What a sample holds per view beside its pictures: the truth per pixel, the both-see mask, correspondences.
#pragma once

#include "apps/lab/simulation.h"
#include "sim/image.h"
#include "sim/large_vector.h"

#include <array>
#include <vector>

namespace laterna {

/// 255 where the camera sees light of the projector, else 0: the pixels that both see.
Image<std::uint8_t> both_see_mask(const LightMap& light);

/// The channels of a truth map.
inline constexpr std::array truth_channels{"projector_u", "projector_v", "depth_m", "normal_x",
                                           "normal_y",    "normal_z",    "object"};

/// These numbers of what each pixel's centre sees, side by side, pixels row by row from the top: projector
/// pixel where the point is imaged (also in shadow or beyond the picture, where the mask is 0; NaN where
/// nothing is seen or the projector's lens images nothing), axial depth (NaN where nothing is seen), unit
/// normal in the world (0 where nothing is seen), index of the mesh in the scene (-1: none). Uncompressed,
/// since coding takes longer than the pictures do.
LargeVector<float> truth_map(const Traced& traced, const View& view);

/// The columns of a correspondence table.
inline constexpr std::array correspondence_columns{"camera_x",  "camera_y",  "true_u",   "true_v",
                                                   "decoded_u", "decoded_v", "sigma_px", "lit"};

/// Rows of these numbers, for every step-th camera pixel in x and y that is lit or decoded: the pixel, the
/// projector pixel that its centre sees (NaN where none is), the one that decoding the pictures gives with
/// its standard deviation (NaN where none, and for patterns that tell no pixel its place), and 1 or 0.
std::vector<float> correspondences(const Scene& scene, const View& view, const CapturedStack& pictures,
                                   int step_px);

}  // namespace laterna
