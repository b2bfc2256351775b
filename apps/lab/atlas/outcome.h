// How an answer fares against the truth: the five outcomes that the atlas counts.
#pragma once

#include "calib/solve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace laterna {

enum class Outcome { right, weak, refused, silent, crashed };

inline constexpr std::array<const char*, 5> outcome_words{"right", "weak", "refused", "silent", "crashed"};
/// One letter each: r, w, f, S, X.
inline constexpr std::string_view outcome_letters = "rwfSX";

/// How one answer fared. Errors are of the volume, rms, projector pixels.
struct Graded {
  Outcome outcome = Outcome::refused;
  double error_px = NAN;      ///< true; NaN where refused
  double predicted_px = NAN;  ///< by the method itself, or by the bound where it makes no prediction
  std::string reason;         ///< the method's own
};

/// ok is `right` where error ≤ max(5·predicted, 1e-6 px), so that 10⁴ cells of honest predictions do not fail
/// by chance, else `silent`: wrong, and it looks right. weak and refused are what they say.
inline Outcome grade(Status status, double error_px, double predicted_px) {
  if (status == Status::refused) return Outcome::refused;
  if (status == Status::weak) return Outcome::weak;
  return error_px <= std::max(5 * predicted_px, 1e-6) ? Outcome::right : Outcome::silent;
}

}  // namespace laterna
