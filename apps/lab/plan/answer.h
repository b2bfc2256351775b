// What a round trip answers, and how far two models' answers are apart.
#pragma once

#include "calib/solve.h"
#include "sim/device.h"
#include "sim/scene_spec.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace laterna {

/// What a round trip says of one projector. The estimate is meaningless where refused.
struct Answer {
  Status status = Status::refused;
  std::string reason;
  Device estimate;
};

/// One round trip of a scene: pictures, decoding, solve, and the seconds of it all (rays included, reading
/// files not). Answers stand in the order of the projectors. What cannot be simulated or decoded
/// (InputError) is refused for every projector.
struct RoundTrip {
  std::vector<Answer> answers;
  double seconds = NAN;
};
RoundTrip round_trip(const SceneSpec& spec, const std::filesystem::path& folder, std::uint64_t seed);

/// To JSON and back, numbers to their last bit.
nlohmann::json round_trip_json(const RoundTrip& trip);
RoundTrip round_trip_from(const nlohmann::json& json);

/// World points where the answers for a projector are compared: the grid of 16×12 pixels × 12 depths over its
/// whole picture and the 5-95 % range of its lit depths (calib/verify.h), of the scene as it stands. Throws
/// Refusal where a projector lights nothing that a camera sees.
std::vector<std::vector<glm::dvec3>> volumes_of(const SceneSpec& spec, const std::filesystem::path& folder);

/// How far a cheaper model's answers are from the full model's, in projector pixels, of the projector that
/// changes most. With a_k(x), b_k(x) the pixels to which the k-th seed's estimates of the full and of the
/// cheaper model map point x, ⟨ ⟩ the mean over points, ‾ and s the mean and the standard deviation over n
/// seeds (vectors: over both coordinates together):
///
///   mean_px²   = ⟨|mean_k(b_k - a_k)|²⟩          what is the same on every seed
///   spread     = ⟨s(a)²⟩^½, ⟨s(b)²⟩^½            how much each scatters: its noise
///   change_px² = mean_px² + (spread_px - spread_full_px)²
///   doubt_px   = 2·⟨s(b - a)²⟩^½ / √n            twice the standard error of the mean
///   rms_px²    = ⟨mean_k |b_k - a_k|²⟩           seed by seed
///
/// change_px is the distance between two normal distributions (Wasserstein's, of equal shape): the least rms
/// by which answers of one must be moved to be distributed as those of the other. Noise that is only drawn
/// anew changes nothing; noise that grows or shrinks counts by how much. Both models run on the same seeds,
/// and noise is drawn by pixel, picture and seed, so that most of it cancels in b - a.
///
/// An answer that is refused, or weak where the full model's is ok, is infinitely far; so is one that cannot
/// map the volume.
struct Change {
  double change_px = 0, doubt_px = 0;
  double mean_px = 0, spread_px = 0, spread_full_px = 0, rms_px = 0;
  std::string reason;  ///< why it is infinite
};

/// `full` and `other` hold a round trip for each seed, the same seeds, at least 2.
Change change_between(const std::vector<std::vector<glm::dvec3>>& volumes, const std::vector<RoundTrip>& full,
                      const std::vector<RoundTrip>& other);

/// small: change + doubt ≤ tolerance. large: change - doubt > tolerance. unsure: between.
enum class Verdict { small, unsure, large };
Verdict verdict_on(const Change& change, double tolerance_px);

}  // namespace laterna
