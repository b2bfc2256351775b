#include "calib/sum_check.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace laterna {

namespace {

/// An odd step over the pixels, so that all columns are met.
std::size_t grid_step(std::size_t pixels) { return std::max<std::size_t>(1, pixels / 4096) | 1; }

/// Where white is at full scale a pair still tells: one picture is at full scale too, the other black. At a
/// stripe's edge, which is neither, the sum is wrong for no fault of the pictures.
template <class T>
bool is_clipped_edge(const ImageStackView<T>& stack, const PatternGroup& pair, std::size_t i, double black,
                     double contrast, double full_scale) {
  for (int j = 0; j < pair.count; ++j) {
    const double value = stack.picture(pair.first + j)[i];
    if (value < full_scale && value - black > 0.1 * contrast) return true;
  }
  return false;
}

/// Calls body(group, rest, white - black) for the lit pixels of a regular grid.
template <class T, class Body>
void for_rests(const ImageStackView<T>& stack, const std::vector<PatternGroup>& groups,
               double min_white_minus_black, double full_scale, const Body& body) {
  const std::span<const T> white = stack.picture(stack.count - 2), black = stack.picture(stack.count - 1);
  const std::size_t step = grid_step(stack.picture_size());
  for (std::size_t i = 0; i < white.size(); i += step) {
    const double contrast = white[i] - black[i], both = white[i] + black[i];
    if (!(contrast > min_white_minus_black)) continue;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const PatternGroup& group = groups[g];
      if (group.count < 2) continue;
      if (white[i] >= full_scale && (group.kind == PatternGroup::Kind::fringe ||
                                     is_clipped_edge(stack, group, i, black[i], contrast, full_scale)))
        continue;
      double sum = 0;
      for (int j = 0; j < group.count; ++j) sum += stack.picture(group.first + j)[i];
      body(g, sum - 0.5 * group.count * both, contrast);
    }
  }
}

}  // namespace

double full_scale_dn(const CapturedView& pictures) {
  const auto* wide = std::get_if<ImageStackView<std::uint16_t>>(&pictures);
  if (!wide) return 255;
  const std::span<const std::uint16_t> white = wide->picture(wide->count - 2);
  const int bits = std::bit_width(*std::max_element(white.begin(), white.end()));
  return (1 << std::max(8, bits)) - 1;
}

namespace {

/// |rest|/sqrt(n + n²/2) of every group and pixel of the grid: each has the deviation of one sample.
std::vector<double> sample_rests(const CapturedView& pictures, const std::vector<PatternGroup>& groups,
                                 double min_white_minus_black) {
  std::vector<double> rests;
  std::visit(
      [&](const auto& stack) {
        for_rests(stack, groups, min_white_minus_black, full_scale_dn(pictures),
                  [&](std::size_t g, double rest, double) {
                    const double n = groups[g].count;
                    rests.push_back(std::abs(rest) / std::sqrt(n + n * n / 2));
                  });
      },
      pictures);
  return rests;
}

double sigma_of_median(std::vector<double>& rests) {
  if (rests.empty()) return 0;
  std::nth_element(rests.begin(), rests.begin() + rests.size() / 2, rests.end());
  return 1.4826 * rests[rests.size() / 2];
}

}  // namespace

double sum_noise_dn(const CapturedView& pictures, const std::vector<PatternGroup>& groups,
                    double min_white_minus_black) {
  std::vector<double> rests = sample_rests(pictures, groups, min_white_minus_black);
  return sigma_of_median(rests);
}

double group_noise_dn(const CapturedView& pictures, const PatternGroup& group, double min_white_minus_black) {
  std::vector<double> rests = sample_rests(pictures, {group}, min_white_minus_black);
  const double most = 3 * sigma_of_median(rests);
  double sum = 0, count = 0;
  for (const double rest : rests)
    if (rest <= most) sum += rest * rest, ++count;
  return count > 0 ? std::sqrt(sum / count / 0.9733) : 0;  // the variance of a normal deviate within ±3
}

std::vector<GroupMisfit> sum_misfits(const CapturedView& pictures, const std::vector<PatternGroup>& groups,
                                     double min_white_minus_black) {
  std::vector<double> sums(groups.size(), 0);
  std::vector<std::size_t> counts(groups.size(), 0);
  std::visit(
      [&](const auto& stack) {
        for_rests(stack, groups, min_white_minus_black, full_scale_dn(pictures),
                  [&](std::size_t g, double rest, double contrast) {
                    const double n = groups[g].count;
                    sums[g] += std::abs(rest) / (std::sqrt(n + n * n / 2) * contrast);
                    ++counts[g];
                  });
      },
      pictures);
  std::vector<GroupMisfit> misfits;
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (counts[g]) misfits.push_back({groups[g], sums[g] / double(counts[g])});
  return misfits;
}

double outside_black_and_white(const CapturedView& pictures, double min_white_minus_black) {
  std::size_t outside = 0, all = 0;
  std::visit(
      [&](const auto& stack) {
        for (std::size_t i = 0; i < stack.picture_size(); i += grid_step(stack.picture_size())) {
          double low = stack.picture(0)[i], high = low;
          for (int k = 1; k < stack.count; ++k) {
            low = std::min(low, double(stack.picture(k)[i]));
            high = std::max(high, double(stack.picture(k)[i]));
          }
          const double beyond =
              std::max(high - stack.picture(stack.count - 2)[i], stack.picture(stack.count - 1)[i] - low);
          outside += high - low > min_white_minus_black && beyond > 0.25 * (high - low);
          ++all;
        }
      },
      pictures);
  return double(outside) / double(std::max<std::size_t>(all, 1));
}

}  // namespace laterna
