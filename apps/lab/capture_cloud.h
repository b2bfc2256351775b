// The surface that a capture saw, as points in the world.
#pragma once

#include "calib/decoded_map.h"
#include "sim/formats/point_cloud.h"
#include "sim/formats/rig.h"

#include <filesystem>
#include <string>
#include <vector>

namespace laterna {

struct CloudOptions {
  std::string camera, projector;  ///< whose sequence; empty: all
};

/// The points that the folder's truth pictures hold, where the projector lights them. Throws InputError where
/// a sequence has none.
std::vector<CloudPoint> true_cloud(const std::filesystem::path& folder, const CloudOptions& options);

/// Adds what a camera has decoded, its rays intersected with the projector's: the point halfway between the
/// camera's ray and the projector's, where they pass each other within 1 % of its distance, in front of both.
void append_cloud(const DecodedMap& map, const Device& camera, const Device& projector,
                  std::vector<CloudPoint>& points);

/// Decodes the folder's pictures and does so. Devices are looked up in `rig` by name.
std::vector<CloudPoint> decoded_cloud(const std::filesystem::path& folder, const Rig& rig,
                                      const CloudOptions& options);

/// The point halfway between two rays' closest approach, and how far apart they pass; none where they are
/// parallel.
struct Midpoint {
  glm::dvec3 x{0.0};
  double gap_m = 0, along_a = 0, along_b = 0;
};
bool midpoint(const glm::dvec3& origin_a, const glm::dvec3& direction_a, const glm::dvec3& origin_b,
              const glm::dvec3& direction_b, Midpoint& result);

}  // namespace laterna
