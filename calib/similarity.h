// The motion, the scale, or both, between two sets of points that belong together, some of them wrongly.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <span>

namespace laterna {

/// x_b = scale·rotation·x_a + translation.
struct Similarity {
  double scale = 1;
  glm::dmat3 rotation{1.0};
  glm::dvec3 translation{0.0};
};

inline glm::dvec3 apply(const Similarity& b_from_a, const glm::dvec3& x_a) {
  return b_from_a.scale * (b_from_a.rotation * x_a) + b_from_a.translation;
}

/// Which parts may be other than the identity's. Without `motion`, `scale` is about the origin.
struct SimilarityOptions {
  bool motion = true, scale = false;
  std::uint64_t seed = 1;  ///< of the samples that it starts from
};

/// b_from_a with the least Σ w·|apply(b_from_a, a_i) - b_i|², the rotation proper (Kabsch 1976, Umeyama
/// 1991). It starts from the sample of three pairs, of two hundred, whose median residual is the least
/// (Rousseeuw 1984), and then w = 1/(1 + (r/3m)²)² with residuals r and their median m: pairs that do not
/// belong together hold no sway as long as they are fewer than half. On pairs that all belong together
/// exactly it is exact to rounding.
///
/// None where there are fewer than three pairs, their points a or b lie on one line (within a
/// thousandth of its length; only with `motion`), or a scale is not positive. Pairs must be finite and of one
/// number.
std::optional<Similarity> fit_similarity(std::span<const glm::dvec3> a, std::span<const glm::dvec3> b,
                                         const SimilarityOptions& options = {});

}  // namespace laterna
