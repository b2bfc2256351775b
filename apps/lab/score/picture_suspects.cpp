#include "apps/lab/score/picture_suspects.h"

#include "calib/bent_response.h"
#include "calib/dlt.h"
#include "calib/solve.h"
#include "calib/sum_check.h"
#include "render/effects/scaler.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace laterna {

namespace {

constexpr std::size_t most_pixels = 4000, fewest_pixels = 100;
constexpr double least_range = 0.1;
constexpr double wrong = 0.05, most_left = 0.1, least_turned = 0.8, harmless_px = 0.01;

// Pixel by pixel, all pictures side by side: shares of the pixel's range, and what they should be.
struct Shares {
  std::size_t pixels = 0;
  int pictures = 0;
  std::vector<double> measured, expected;
};

// Where camera pixels read the pictures that the projector takes; only those that lie on them.
struct Site {
  std::size_t camera_pixel;
  glm::ivec2 pattern_pixel;
};

std::vector<Site> sites(const Scene& scene, int projector, const LightMap& truth, glm::ivec2 size) {
  const Projector& device = scene.projectors[projector];
  const glm::dmat3 input = scene.effects.scaler
                               ? input_from_panel(device.effects.scaler, size, device.device.intrinsics.size)
                               : glm::dmat3(1.0);
  std::vector<Site> all, chosen;
  for (std::size_t i = 0; i < truth.why.values.size(); ++i) {
    if (!truth.lit(i)) continue;
    const glm::dvec3 q = input * glm::dvec3(truth.u_px.values[i], truth.v_px.values[i], 1);
    const glm::ivec2 at(glm::round(glm::dvec2(q) / q.z));
    if (at.x >= 0 && at.y >= 0 && at.x < size.x && at.y < size.y) all.push_back({i, at});
  }
  for (const std::size_t i : evenly_spread(all.size(), most_pixels)) chosen.push_back(all[i]);
  return chosen;
}

// How a camera's driver may hand its pictures over, and the words for it.
struct Turn {
  bool in_x, in_y;
  const char* words;
};
constexpr std::array<Turn, 3> turns{{{false, true, "upside down"},
                                     {true, false, "mirrored left to right"},
                                     {true, true, "turned by half a circle"}}};

std::vector<Site> turned(std::vector<Site> sites, const Turn& turn, const LightMap& truth) {
  const std::size_t width = truth.why.width, height = truth.why.height;
  for (Site& site : sites) {
    const std::size_t x = site.camera_pixel % width, y = site.camera_pixel / width;
    site.camera_pixel = (turn.in_y ? height - 1 - y : y) * width + (turn.in_x ? width - 1 - x : x);
  }
  return sites;
}

std::vector<double> values_at(const CapturedStack& pictures, std::size_t camera_pixel) {
  return std::visit(
      [&](const auto& stack) {
        std::vector<double> values(stack.count);
        for (int k = 0; k < stack.count; ++k) values[k] = stack.picture(k)[camera_pixel];
        return values;
      },
      pictures);
}

Shares shares_of(const std::vector<Site>& sites, const CapturedStack& pictures,
                 const PatternSequence& sequence) {
  Shares shares;
  shares.pictures = picture_count(sequence);
  const double full_scale = full_scale_dn(pictures);
  std::vector<Site> used;
  for (const Site& site : sites) {
    const std::vector<double> values = values_at(pictures, site.camera_pixel);
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    if (*high - *low < least_range * full_scale || (!is_binary(sequence) && *high >= full_scale)) continue;
    for (const double value : values) shares.measured.push_back((value - *low) / (*high - *low));
    used.push_back(site);
  }
  shares.pixels = used.size();
  shares.expected.resize(shares.measured.size());
  for (int k = 0; k < shares.pictures; ++k) {
    const Image<std::uint8_t> pattern = pattern_picture(sequence, k);
    for (std::size_t i = 0; i < used.size(); ++i)
      shares.expected[i * shares.pictures + k] =
          pattern(used[i].pattern_pixel.x, used[i].pattern_pixel.y) / 255.0;
  }
  return shares;
}

// Mean over the pixels of Σ_k (m_k - p_k)².
double disagreement(const Shares& shares) {
  double sum = 0;
  for (std::size_t i = 0; i < shares.measured.size(); ++i) {
    const double d = shares.measured[i] - shares.expected[i];
    sum += d * d;
  }
  return sum / double(shares.pixels);
}

// Mean of (m_k - p_j)², where picture k should show pattern j.
std::vector<double> disagreements(const Shares& shares) {
  const int n = shares.pictures;
  std::vector<double> table(std::size_t(n) * n, 0.0);
  for (std::size_t i = 0; i < shares.pixels; ++i) {
    for (int k = 0; k < n; ++k) {
      for (int j = 0; j < n; ++j) {
        const double d = shares.measured[i * n + k] - shares.expected[i * n + j];
        table[std::size_t(k) * n + j] += d * d / double(shares.pixels);
      }
    }
  }
  return table;
}

// The axis that a picture changes along; none of white, black and their like.
std::vector<std::optional<int>> axes_of(const PatternSequence& sequence) {
  std::vector<std::optional<int>> axes(picture_count(sequence));
  for (const PatternGroup& group : pattern_groups(sequence))
    for (int j = 0; j < group.count; ++j) axes[group.first + j] = group.axis;
  return axes;
}

std::optional<Suspect> wrong_order(const Shares& shares, const PatternSequence& sequence) {
  const std::vector<double> table = disagreements(shares);
  const auto axes = axes_of(sequence);
  const int n = shares.pictures;
  double as_named = 0, as_best = 0, moved_named = 0, moved_best = 0;
  int moved = 0, first = -1, to_other_axis = 0;
  for (int k = 0; k < n; ++k) {
    const auto row = table.begin() + std::ptrdiff_t(k) * n;
    const auto best = std::min_element(row, row + n);
    const double own = row[k];
    as_named += own;
    const bool is_other = own > wrong && *best < own / 3;
    as_best += is_other ? *best : own;
    if (!is_other) continue;
    moved_named += own, moved_best += *best;
    if (first < 0) first = k;
    ++moved;
    const auto shown = axes[best - row];
    to_other_axis += axes[k] && shown && *axes[k] != *shown;
  }
  if (moved == 0 || moved_best > most_left * moved_named || as_best > wrong * n) return std::nullopt;
  const bool is_exchanged = 2 * to_other_axis > n;
  const std::string name = is_exchanged ? "axes_exchanged" : "dropped_frame";
  return Suspect{name, 1 - as_best / as_named,
                 fmt::format("{} (\"{}\" is the first of {} pictures that show another pattern)",
                             advice(name), picture_name(sequence, first), moved)};
}

std::optional<Suspect> turned_pictures(const std::vector<Site>& sites, const LightMap& truth,
                                       const CapturedStack& pictures, const PatternSequence& sequence,
                                       double as_named) {
  std::optional<Suspect> best;
  for (const Turn& turn : turns) {
    const Shares shares = shares_of(turned(sites, turn, truth), pictures, sequence);
    if (shares.pixels < fewest_pixels) continue;
    const double explains = 1 - disagreement(shares) / as_named;
    if (!(explains > (best ? best->explains : least_turned))) continue;
    best = {"y_flipped", explains,
            fmt::format("the camera's pictures are {}: take them as its sensor saw them", turn.words)};
  }
  return best;
}

// Whether fringes of this response lead a decoder astray: not where they have steps enough.
bool is_harmful(double gamma, const PatternSequence& sequence) {
  for (const PatternGroup& group : pattern_groups(sequence)) {
    if (group.kind != PatternGroup::Kind::fringe) continue;
    if (group.count < 3 || response_shift_px(gamma, group.count, group.pitch_px) > harmless_px) return true;
  }
  return false;
}

double fringe_misfit(const Shares& shares, const std::vector<int>& pictures, double gamma) {
  double sum = 0;
  for (std::size_t i = 0; i < shares.pixels; ++i) {
    for (const int k : pictures) {
      const std::size_t at = i * shares.pictures + k;
      const double d = shares.measured[at] - std::pow(shares.expected[at], gamma);
      sum += d * d;
    }
  }
  return sum;
}

std::optional<Suspect> bent_response(const Shares& shares, const PatternSequence& sequence) {
  std::vector<int> fringes;
  for (const PatternGroup& group : pattern_groups(sequence))
    for (int j = 0; group.kind == PatternGroup::Kind::fringe && j < group.count; ++j)
      fringes.push_back(group.first + j);
  if (fringes.empty()) return std::nullopt;
  const double straight = fringe_misfit(shares, fringes, 1);
  double best_gamma = 1, least = straight;
  for (int step = -24; step <= 24; ++step) {
    const double gamma = std::exp(0.05 * step);  // 0.30 to 3.3
    const double misfit = fringe_misfit(shares, fringes, gamma);
    if (misfit < least) least = misfit, best_gamma = gamma;
  }
  const double explains = 1 - least / straight;
  if ((best_gamma > 0.9 && best_gamma < 1.1) || !(explains > 0.5) || !is_harmful(best_gamma, sequence))
    return std::nullopt;
  return Suspect{"gamma", explains, fmt::format("{} (fringes follow p^{:.2f})", advice("gamma"), best_gamma)};
}

}  // namespace

std::vector<Suspect> picture_suspects(const Scene& scene, int projector, const LightMap& truth,
                                      const CapturedStack& pictures, const PatternSequence& sequence) {
  if (!is_coded(sequence.parameters.kind)) return {};
  const std::vector<Site> looked_at = sites(scene, projector, truth, sequence.projector_size);
  const Shares shares = shares_of(looked_at, pictures, sequence);
  if (shares.pixels < fewest_pixels) return {};
  const auto order = wrong_order(shares, sequence);
  const auto turned = turned_pictures(looked_at, truth, pictures, sequence, disagreement(shares));
  if (turned && (!order || turned->explains > order->explains)) return {*turned};
  if (order) return {*order};
  if (const auto bent = bent_response(shares, sequence)) return {*bent};
  return {};
}

std::optional<Suspect> keystone_suspect(const Correspondences& decoded, glm::ivec2 projector_size,
                                        const std::string& lens_model) {
  if (decoded.world_points.size() < fewest_pixels) return std::nullopt;
  const Correspondences some = subset(decoded, evenly_spread(decoded.world_points.size(), 3000));
  SolveOptions options;
  options.lens_model = lens_model;
  const DltResult matrix = dlt(some, projector_size);
  if (matrix.status != DltStatus::ok) return std::nullopt;
  const SolveResult projector = solve(some, projector_size, options);
  if (projector.status == Status::refused) return std::nullopt;
  const double explains = 1 - std::pow(matrix.rms_px / projector.fit_rms_px, 2);
  if (!(explains > 0.5)) return std::nullopt;
  return Suspect{"keystone", explains,
                 fmt::format("{} (its matrix has a skew of {:.3g} px)", advice("keystone"), matrix.skew_px)};
}

}  // namespace laterna
