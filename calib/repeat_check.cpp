#include "calib/repeat_check.h"

#include "calib/sum_check.h"
#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace laterna {

namespace {

constexpr double contrast_share = 40 / 255.0, lamp_share = 0.03, noise_sigmas = 8, moved_share = 1e-3;

template <class T>
RepeatCheck compare(const ImageStackView<T>& stack, int white, double min_contrast, double sigma_dn) {
  RepeatCheck check;
  std::size_t changed = 0;
  const auto first = stack.picture(0), last = stack.picture(stack.count - 1);
  const auto bright = stack.picture(white), dark = stack.picture(white + 1);
  for (std::size_t i = 0; i < first.size(); ++i) {
    const double contrast = double(bright[i]) - double(dark[i]);
    if (!(contrast > min_contrast)) continue;
    ++check.lit;
    const double bound = noise_sigmas * std::numbers::sqrt2 * sigma_dn + lamp_share * contrast;
    changed += std::abs(double(last[i]) - double(first[i])) > bound;
  }
  check.changed_share = double(changed) / double(std::max<std::size_t>(check.lit, 1));
  return check;
}

}  // namespace

PatternSequence without_repeat(PatternSequence sequence) {
  sequence.parameters.repeat_first = false;
  return sequence;
}

CapturedView without_repeat(const CapturedView& pictures, const PatternSequence& sequence) {
  return std::visit(
      [&](const auto& stack) -> CapturedView {
        const int expected = picture_count(sequence);
        if (stack.count != expected)
          throw InputError(
              fmt::format("patterns: {} pictures, expected {}{}", stack.count, expected,
                          sequence.parameters.repeat_first ? ", the first one again at the end" : ""));
        auto kept = stack;
        kept.count -= sequence.parameters.repeat_first;
        return kept;
      },
      pictures);
}

std::optional<RepeatCheck> compare_repeat(const CapturedView& pictures, const PatternSequence& sequence) {
  if (!sequence.parameters.repeat_first) return {};
  const CapturedView plain = without_repeat(pictures, sequence);
  const double least = contrast_share * full_scale_dn(plain);
  const double sigma =
      std::max(sum_noise_dn(plain, pattern_groups(without_repeat(sequence)), least), std::sqrt(1 / 12.0));
  return std::visit([&](const auto& stack) { return compare(stack, white_picture(sequence), least, sigma); },
                    pictures);
}

bool has_moved(const RepeatCheck& check) { return check.changed_share > moved_share; }

}  // namespace laterna
