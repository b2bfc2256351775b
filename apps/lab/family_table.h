// Pattern families against faults: what each fault does to each family, and whether anybody would notice.
//
// Every cell is a small round trip of one scene with one thing wrong. The verdict of a round trip never looks
// at the truth; the table does, and says how the two agree.
#pragma once

#include "apps/lab/trial.h"

#include <string>
#include <vector>

namespace laterna {

/// A family and how it is drawn.
struct NamedPatterns {
  std::string name;
  PatternParameters patterns;
};

/// gray, xor_gray, gray_phase with N = 3, 4 and 8 steps, phase, multi_frequency and micro_phase; the finest
/// pitch is 32 px.
std::vector<NamedPatterns> table_families();

/// What is wrong. All but `interreflection` (a V-groove of two right-angled flanks, albedo 0.8) look at one
/// relief, 1.6 m wide from 2 m, projector 256×192 bilinear, camera 480×300 with 0.7 DN of noise.
enum class Fault {
  none,
  gamma,            ///< the projector's light is the 2.2th power of the pattern's value
  saturation,       ///< the camera is exposed so that white would be at 1.6 × full scale in the median
  defocus,          ///< the projector's blur is 4 to 13 px wide
  interreflection,  ///< up to three bounces
  dropped,          ///< the projector skips the second picture: all later ones are one ahead
  lost_fine,  ///< the second picture of the finest group of columns shows the next one; the others are right
  lost_coarse,        ///< ... the second picture of all
  moved,              ///< the camera moves by 20 mm between the pictures of columns and those of rows
  moved_and_repeated  ///< the same, with the first picture shown again at the end
};

const char* fault_name(Fault fault);
std::vector<Fault> all_faults();

/// How a cell ends.
enum class Ending {
  right,          ///< ok, and the true error over the volume is at most 5 × the predicted one (or 1e-6 px)
  weak,           ///< an estimate whose verdict says why not to believe it
  refused,        ///< no estimate, with the reason
  flagged,        ///< ok and beyond the prediction, but the pictures' report names the trouble
  silently_wrong  ///< ok and beyond the prediction, and nothing was said
};

const char* ending_name(Ending ending);

struct FamilyCell {
  std::string family;
  Fault fault = Fault::none;
  double decoded_rms_px = 0;  ///< sqrt(mean(du² + dv²)) against the truth over pixels that decode and are lit
  double decoded_median_px = 0;  ///< of sqrt(du² + dv²), over the same
  double valid_share = 0;        ///< of the pixels that the projector lights
  Status status = Status::refused;
  std::string reason;
  std::vector<std::string> flags;
  double true_rms_px = 0, predicted_rms_px = 0;  ///< over the volume; NaN where refused
  Ending ending = Ending::refused;
};

/// One cell. The same seed gives the same bits.
FamilyCell family_cell(const NamedPatterns& family, Fault fault, std::uint64_t seed = 1);

/// Every family with every fault, fault by fault.
std::vector<FamilyCell> family_table(const std::vector<NamedPatterns>& families,
                                     const std::vector<Fault>& faults);

/// A line for each cell, and what was said below it.
std::string family_table_text(const std::vector<FamilyCell>& cells);

}  // namespace laterna
