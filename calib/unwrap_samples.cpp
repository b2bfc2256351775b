// Micro phase shifting (Gupta and Nayar, CVPR 2012): one fringe in steps, then single pictures of near
// periods, which share its mean and modulation.
#include "calib/fringe_kernel.h"
#include "calib/unwrap.h"

#include <Eigen/Dense>

#include <cmath>
#include <numbers>

namespace laterna {

namespace {

constexpr double two_pi = 2 * std::numbers::pi;
constexpr float large_chi2 = 9;

std::vector<PatternGroup> fringes_of(const PatternSequence& sequence, int axis) {
  std::vector<PatternGroup> fringes;
  for (const PatternGroup& group : pattern_groups(sequence))
    if (group.axis == axis && group.kind == PatternGroup::Kind::fringe) fringes.push_back(group);
  return fringes;
}

/// What choose_period() asks of one single picture, in units of its standard deviation.
struct Witness {
  std::vector<float> rest, c, s, cosines, sines;

  template <class T>
  Witness(const AxisPictures<T>& pictures, const PatternGroup& group, double ratio, const FringeFit& first,
          const SampleNoise& noise, double full_scale_dn, const PeriodSearch& search) {
    const T* samples = pictures.stack.picture(group.first).data() + pictures.begin;
    const T* black = pictures.stack.picture(pictures.stack.count - 1).data() + pictures.begin;
    for (std::size_t i = 0; i < pictures.count; ++i) {
      const double light = std::max(double(samples[i]) - double(black[i]), 0.0);
      // The prediction's own noise, from a fringe of three steps, doubles the sample's.
      const double sigma =
          std::sqrt(2 * (noise.constant_dn * noise.constant_dn + noise.variance_per_dn * light));
      const double weight = samples[i] < full_scale_dn ? 1 / sigma : 0;
      const double modulation = weight * std::hypot(first.c[i], first.s[i]),
                   phase = two_pi * first.turns[i] * ratio;
      rest.push_back(float(weight * (double(samples[i]) - first.mean[i])));
      c.push_back(float(modulation * std::cos(phase)));
      s.push_back(float(modulation * std::sin(phase)));
    }
    for (int k = search.first; k <= search.last; ++k) {
      cosines.push_back(float(std::cos(two_pi * k * ratio)));
      sines.push_back(float(std::sin(two_pi * k * ratio)));
    }
  }
  SampleWitness view() const { return {rest.data(), c.data(), s.data(), cosines.data(), sines.data()}; }
};

/// One picture of the axis: I = A + B·cos(2π·(x/pitch + shift)).
template <class T>
struct Sample {
  const T* pixels;
  double pitch_px, shift_turns;
};

template <class T>
std::vector<Sample<T>> samples_of(const AxisPictures<T>& pictures, const std::vector<PatternGroup>& fringes) {
  std::vector<Sample<T>> samples;
  for (const PatternGroup& group : fringes)
    for (int j = 0; j < group.count; ++j)
      samples.push_back({pictures.stack.picture(group.first + j).data() + pictures.begin, group.pitch_px,
                         double(j) / group.count});
  return samples;
}

/// x, A and B, with the variance of x and χ² per degree of freedom.
struct Solution {
  Eigen::Vector3d xab;
  double variance, reduced_chi2;
};

/// Gauss-Newton from a start within a small part of a period: three steps square the error each time.
template <class T>
Solution refine(const std::vector<Sample<T>>& samples, std::size_t i, double black, const SampleNoise& noise,
                double full_scale_dn, const Eigen::Vector3d& start) {
  Solution solution{start, 0, 0};
  for (int step = 0; step < 4; ++step) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double chi2 = 0;
    int used = 0;
    for (const Sample<T>& sample : samples) {
      const double value = sample.pixels[i];
      if (value >= full_scale_dn) continue;
      const double rate = two_pi / sample.pitch_px;
      const double phase = rate * solution.xab[0] + two_pi * sample.shift_turns, cosine = std::cos(phase);
      const Eigen::Vector3d row(-solution.xab[2] * rate * std::sin(phase), 1, cosine);
      const double rest = value - solution.xab[1] - solution.xab[2] * cosine;
      const double weight =
          1 / (noise.constant_dn * noise.constant_dn + noise.variance_per_dn * std::max(value - black, 0.0));
      normal += weight * row * row.transpose();
      right += weight * rest * row;
      chi2 += weight * rest * rest;
      ++used;
    }
    const Eigen::Matrix3d covariance = normal.inverse();
    solution.variance = covariance(0, 0);
    solution.reduced_chi2 = used > 3 ? chi2 / (used - 3) : 1;
    if (step < 3) solution.xab += covariance * right;
  }
  return solution;
}

}  // namespace

template <class T>
Places unwrap_by_samples(const AxisPictures<T>& pictures, const FringeFit& first, const SampleNoise& noise,
                         double full_scale_dn, const UnwrapLimits& limits) {
  const std::vector<PatternGroup> fringes = fringes_of(pictures.sequence, pictures.axis);
  const int size = pictures.sequence.projector_size[pictures.axis];
  const double pitch = fringes[0].pitch_px;
  const PeriodSearch search = period_search(first, pitch, size);
  std::vector<Witness> witnesses;
  std::vector<SampleWitness> views;
  for (std::size_t m = 1; m < fringes.size(); ++m)
    witnesses.emplace_back(pictures, fringes[m], pitch / fringes[m].pitch_px, first, noise, full_scale_dn,
                           search);
  for (const Witness& witness : witnesses) views.push_back(witness.view());
  Periods periods(pictures.count);
  choose_period(search, views.data(), int(views.size()), pictures.count, periods.arrays());

  const std::vector<Sample<T>> samples = samples_of(pictures, fringes);
  const T* black = pictures.stack.picture(pictures.stack.count - 1).data() + pictures.begin;
  Places places(pictures.count);
  for (std::size_t i = 0; i < pictures.count; ++i) {
    Reject& why = places.why[i] = first.why[i];
    if (why == Reject::none)
      why = judge_period(periods.cost[i], periods.second_cost[i], views.size(), limits);
    if (why != Reject::none) continue;
    const double start = (double(periods.best[i]) + first.turns[i]) * pitch;
    const Solution solution = refine(samples, i, black[i], noise, full_scale_dn,
                                     {start, first.mean[i], std::hypot(first.c[i], first.s[i])});
    places.place_px[i] = solution.xab[0];
    places.variance[i] = solution.variance;
    const double moved = std::abs(solution.xab[0] - start);
    if (!(moved < pitch / 4) || solution.reduced_chi2 > large_chi2)
      why = Reject::disagree;
    else if (!is_inside(places.place_px[i], size))
      why = Reject::outside;
  }
  return places;
}

template Places unwrap_by_samples(const AxisPictures<std::uint8_t>&, const FringeFit&, const SampleNoise&,
                                  double, const UnwrapLimits&);
template Places unwrap_by_samples(const AxisPictures<std::uint16_t>&, const FringeFit&, const SampleNoise&,
                                  double, const UnwrapLimits&);

}  // namespace laterna
