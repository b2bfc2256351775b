#include "calib/unwrap.h"

#include "calib/fringe_kernel.h"
#include "calib/pair_codes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace laterna {

namespace {

/// In [-0.5, 0.5].
double wrap(double turns) { return turns - std::round(turns); }

/// 1/(σ_m² + σ_0²) in px⁻²; 0 where either is infinite.
std::vector<float> weights_of(const FringeFit& first, double first_pitch, const FringeFit& other,
                              double pitch) {
  std::vector<float> weights;
  for (std::size_t i = 0; i < first.variance.size(); ++i) {
    weights.push_back(float(1 / (double(first.variance[i]) * first_pitch * first_pitch +
                                 double(other.variance[i]) * pitch * pitch)));
  }
  return weights;
}

}  // namespace

template <class T>
Places unwrap_by_code(const AxisPictures<T>& pictures, const FringeFit& fringe, double min_pair_dn) {
  const PairPictures<T> pairs(pictures.stack, pictures.sequence, pictures.axis);
  std::vector<std::uint16_t> stripe(pictures.count);
  std::vector<T> weakest(pictures.count, std::numeric_limits<T>::max());
  pairs.read(pictures.begin, pictures.count, stripe.data(), weakest.data());
  const double pitch = pictures.sequence.parameters.pitch_px;
  Places places(pictures.count);
  for (std::size_t i = 0; i < pictures.count; ++i) {
    const double inside_period = fringe.turns[i] * pitch;
    const double middle = (stripe[i] + 0.5) * pairs.code.stripe_px - 0.5;
    const double place = inside_period + pitch * std::round((middle - inside_period) / pitch);
    places.place_px[i] = place;
    places.variance[i] = double(fringe.variance[i]) * pitch * pitch;
    Reject& why = places.why[i] = fringe.why[i];
    if (why != Reject::none) continue;
    if (weakest[i] < min_pair_dn)
      why = Reject::pair;
    else if (std::abs(place - middle) > 0.375 * pitch)
      why = Reject::disagree;
    else if (!is_inside(place, pictures.sequence.projector_size[pictures.axis]))
      why = Reject::outside;
  }
  return places;
}

PeriodSearch period_search(const FringeFit& first, double pitch_px, int size_px) {
  return {first.turns.data(),   float(pitch_px), -1, int(std::ceil(size_px / pitch_px)), -0.5f,
          float(size_px) - 0.5f};
}

Reject judge_period(float cost, float second_cost, std::size_t witnesses, const UnwrapLimits& limits) {
  if (!(cost < std::numeric_limits<float>::infinity())) return Reject::outside;
  const double most = limits.max_disagreement_sigmas * limits.max_disagreement_sigmas * double(witnesses);
  const double margin = limits.min_margin_sigmas * limits.min_margin_sigmas;
  return cost <= most && second_cost - cost >= margin ? Reject::none : Reject::disagree;
}

Places unwrap_by_phases(const std::vector<double>& pitches_px, int size_px,
                        const std::vector<FringeFit>& fringes, const UnwrapLimits& limits) {
  const FringeFit& first = fringes[0];
  const std::size_t count = first.turns.size(), others = fringes.size() - 1;
  std::vector<std::vector<float>> weights;
  std::vector<PhaseWitness> witnesses;
  for (std::size_t m = 1; m <= others; ++m) {
    weights.push_back(weights_of(first, pitches_px[0], fringes[m], pitches_px[m]));
    witnesses.push_back({fringes[m].turns.data(), weights.back().data(), float(pitches_px[m])});
  }
  Periods periods(count);
  choose_period(period_search(first, pitches_px[0], size_px), witnesses.data(), int(others), count,
                periods.arrays());
  Places places(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double start = (double(periods.best[i]) + first.turns[i]) * pitches_px[0];
    double weight = 0, moved = 0;
    for (std::size_t m = 0; m <= others; ++m) {
      const double w = 1 / (double(fringes[m].variance[i]) * pitches_px[m] * pitches_px[m]);
      weight += w;
      moved += w * pitches_px[m] * wrap(double(fringes[m].turns[i]) - start / pitches_px[m]);
    }
    Reject& why = places.why[i];
    for (const FringeFit& fringe : fringes)
      if (why == Reject::none) why = fringe.why[i];
    if (why == Reject::none) why = judge_period(periods.cost[i], periods.second_cost[i], others, limits);
    if (why != Reject::none) continue;
    places.place_px[i] = start + moved / weight;
    places.variance[i] = 1 / weight;
    if (!is_inside(places.place_px[i], size_px)) why = Reject::outside;
  }
  return places;
}

template Places unwrap_by_code(const AxisPictures<std::uint8_t>&, const FringeFit&, double);
template Places unwrap_by_code(const AxisPictures<std::uint16_t>&, const FringeFit&, double);

}  // namespace laterna
