#include "calib/decode_phase.h"

#include "calib/sum_check.h"
#include "sim/error.h"
#include "sim/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace laterna {

namespace {

constexpr std::size_t segment_pixels = 4096;

/// What holds for the whole stack.
struct Setting {
  const PatternSequence& sequence;
  std::vector<PatternGroup> groups;
  SampleNoise noise;
  FringeLimits fringe;
  UnwrapLimits unwrap;
  double min_white_minus_black, min_pair;
};

/// The lower median over the groups: one group that is wrong does not count. At least rounding.
SampleNoise measured_noise(const CapturedView& pictures, const Setting& s) {
  std::vector<double> sigmas;
  for (const PatternGroup& group : s.groups)
    if (group.count > 1) sigmas.push_back(group_noise_dn(pictures, group, s.min_white_minus_black));
  const auto middle = sigmas.begin() + std::ptrdiff_t((sigmas.size() - 1) / 2);
  std::nth_element(sigmas.begin(), middle, sigmas.end());
  return {std::max(*middle, std::sqrt(1 / 12.0)), 0};
}

Setting setting_of(const CapturedView& pictures, const PatternSequence& sequence,
                   const PhaseDecodeOptions& options) {
  const double full_scale = full_scale_dn(pictures), unit = full_scale / 255;
  Setting s{
      sequence, pattern_groups(sequence), {}, {}, options.unwrap, unit * options.min_white_minus_black_dn, 0};
  s.noise = options.noise ? *options.noise : measured_noise(pictures, s);
  s.fringe = {full_scale, unit * options.min_modulation_dn, options.min_modulation_sigmas};
  s.min_pair = 5 * std::numbers::sqrt2 * s.noise.constant_dn;
  return s;
}

/// One axis of a segment: places, and the weakest modulation in DN.
struct AxisResult {
  Places places;
  std::vector<float> modulation;
};

template <class T>
AxisResult decode_axis(const Setting& s, const AxisPictures<T>& pictures) {
  std::vector<FringeFit> fits;
  std::vector<double> pitches;
  std::vector<float> modulation(pictures.count, std::numeric_limits<float>::infinity());
  for (const PatternGroup& group : s.groups) {
    if (group.axis != pictures.axis || group.kind != PatternGroup::Kind::fringe || group.count == 1) continue;
    const FringeFit& fit = fits.emplace_back(
        fit_fringe(pictures.stack, group, s.noise, s.fringe, pictures.begin, pictures.count));
    pitches.push_back(group.pitch_px);
    for (std::size_t i = 0; i < pictures.count; ++i)
      modulation[i] = std::min(modulation[i], std::hypot(fit.c[i], fit.s[i]));
  }
  const int size = s.sequence.projector_size[pictures.axis];
  switch (s.sequence.parameters.kind) {
    case PatternKind::gray_phase:
      return {unwrap_by_code(pictures, fits[0], s.min_pair), std::move(modulation)};
    case PatternKind::micro_phase:
      return {unwrap_by_samples(pictures, fits[0], s.noise, s.fringe.full_scale_dn, s.unwrap),
              std::move(modulation)};
    default:
      return {unwrap_by_phases(pitches, size, fits, s.unwrap), std::move(modulation)};
  }
}

/// Half a pixel from the middle of the outermost pixels there is no neighbour to blend with.
float edge_variance(double place_px, int size_px) {
  return place_px < 0.5 || place_px > size_px - 1.5 ? 1 / 12.0f : 0;
}

/// A whole map, with the variances of u and v apart.
struct Decoding {
  DecodedMap map;
  std::vector<float> variance_u, variance_v;
};

template <class T>
void decode_segment(const ImageStackView<T>& stack, const Setting& s, std::size_t begin, Decoding& out) {
  const std::size_t count = std::min(segment_pixels, stack.picture_size() - begin);
  const AxisResult u = decode_axis(s, AxisPictures<T>{stack, s.sequence, 0, begin, count});
  const AxisResult v = decode_axis(s, AxisPictures<T>{stack, s.sequence, 1, begin, count});
  const std::span<const T> white = stack.picture(stack.count - 2), black = stack.picture(stack.count - 1);
  DecodedMap& map = out.map;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t pixel = begin + i;
    const float contrast = float(white[pixel]) - float(black[pixel]);
    const float modulation = std::min(u.modulation[i], v.modulation[i]);
    map.confidence.values[pixel] = contrast > 0 ? std::min(2 * modulation / contrast, 1.0f) : 0.0f;
    Reject why = u.places.why[i] == Reject::none ? v.places.why[i] : u.places.why[i];
    if (!(contrast > s.min_white_minus_black)) why = Reject::dim;
    if (why != Reject::none) {
      reject(map, pixel, why);
      continue;
    }
    map.u_px.values[pixel] = u.places.place_px[i], map.v_px.values[pixel] = v.places.place_px[i];
    map.valid.values[pixel] = 1;
    const glm::ivec2 size = s.sequence.projector_size;
    out.variance_u[pixel] = float(u.places.variance[i]) + edge_variance(u.places.place_px[i], size.x);
    out.variance_v[pixel] = float(v.places.variance[i]) + edge_variance(v.places.place_px[i], size.y);
  }
}

/// What seeing the panel's pixels as boxes adds to the variance.
double box_variance(const Image<double>& place_px, const DecodedMap& map) {
  std::complex<double> sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < place_px.values.size(); ++i) {
    if (!map.valid.values[i]) continue;
    sum += std::polar(1.0, 2 * std::numbers::pi * place_px.values[i]);
    ++count;
  }
  const double r = count ? std::abs(sum) / double(count) : 0;
  return r > 5 / std::sqrt(double(std::max<std::size_t>(count, 1))) ? r / 12 : 0;
}

void validate_options(const PhaseDecodeOptions& o) {
  const SampleNoise noise = o.noise.value_or(SampleNoise{});
  for (const double value : {o.min_white_minus_black_dn, o.min_modulation_dn, o.min_modulation_sigmas,
                             o.unwrap.max_disagreement_sigmas, o.unwrap.min_margin_sigmas, noise.constant_dn,
                             noise.variance_per_dn}) {
    if (!std::isfinite(value) || value < 0)
      throw InputError(fmt::format("phase: an option of {}, expected a finite number of at least 0", value));
  }
  if (!(noise.constant_dn > 0)) throw InputError("phase: a noise of 0 DN, expected more");
}

}  // namespace

DecodedMap decode_phase(const CapturedView& pictures, const PatternSequence& sequence,
                        const PhaseDecodeOptions& options) {
  validate(sequence);
  validate_options(options);
  const PatternKind kind = sequence.parameters.kind;
  if (!is_coded(kind) || kind == PatternKind::gray || kind == PatternKind::xor_gray)
    throw InputError("phase: the patterns are of another family, expected one with fringes");
  if (sequence.parameters.repeat_first)
    throw InputError("phase: the first picture is repeated, expected without_repeat()");
  Decoding out;
  std::visit(
      [&](const auto& stack) {
        const int expected = picture_count(sequence);
        if (stack.count != expected || stack.picture_size() == 0)
          throw InputError(fmt::format("phase: {} pictures of {}×{}, expected {} for a projector of {}×{}",
                                       stack.count, stack.width, stack.height, expected,
                                       sequence.projector_size.x, sequence.projector_size.y));
        const Setting setting = setting_of(pictures, sequence, options);
        const std::size_t pixels = stack.picture_size();
        out = {DecodedMap(stack.width, stack.height), std::vector<float>(pixels), std::vector<float>(pixels)};
        parallel_for((pixels + segment_pixels - 1) / segment_pixels,
                     [&](std::size_t i) { decode_segment(stack, setting, i * segment_pixels, out); });
      },
      pictures);
  const auto box = float(box_variance(out.map.u_px, out.map) + box_variance(out.map.v_px, out.map));
  for (std::size_t i = 0; i < out.variance_u.size(); ++i)
    if (out.map.valid.values[i])
      out.map.sigma_px.values[i] = std::sqrt(0.5f * (out.variance_u[i] + out.variance_v[i] + box));
  return std::move(out.map);
}

}  // namespace laterna
