// A stated distribution of one value of a scene.
//
//   { uniform = [30, 60] }                      numbers between two ends; rows of numbers: each of its own
//   { log_uniform = [50, 500] }                 the same in the logarithm; ends above 0
//   { normal = [mean, sigma, low, high] }       drawn until it lies between low and high
//   { whole = [1, 5] }                          a whole number, ends included
//   { choice = ["gray", "xor_gray"] }           one of a list, all alike; of anything that a scene holds
//   { orbit = { around = [0, 0, 0], distance = [0.4, 0.6], azimuth_deg = [-30, 30], elevation_deg = [20, 60]
//   } }
//                                               a point about another: azimuth from +x towards +y, elevation
//                                               above the plane of x and y; each uniform
#pragma once

#include "apps/lab/dataset/random_stream.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace laterna {

/// A distribution as a specification says it: {"uniform": [30, 60]}.
using Distribution = nlohmann::json;

/// Whether an object is a distribution: it has one key, the name of a kind.
bool is_distribution(const nlohmann::json& object);

/// Throws InputError, beginning with `place`, for one that is none, or whose numbers are no such ends.
void check_distribution(const Distribution& distribution, const std::string& place);

/// A value, of one that check_distribution() accepts.
nlohmann::json draw(const Distribution& distribution, RandomStream& stream);

/// The values at its ends: what a scene that accepts these accepts at all. All of a choice's.
std::vector<nlohmann::json> ends_of(const Distribution& distribution);

/// The same in words, for a data card: "uniform 30 to 60".
std::string distribution_text(const Distribution& distribution);

}  // namespace laterna
