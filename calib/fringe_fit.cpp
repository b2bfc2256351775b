#include "calib/fringe_fit.h"

#include "calib/fringe_kernel.h"

#include <Eigen/Dense>

#include <cmath>
#include <limits>
#include <numbers>

namespace laterna {

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float turn = float(2 * std::numbers::pi);
constexpr float large_chi2 = 9;

template <class T>
class Fitter {
 public:
  Fitter(const ImageStackView<T>& stack, const PatternGroup& group, const SampleNoise& noise,
         const FringeLimits& limits, std::size_t begin, std::size_t count)
      : steps_(group.count),
        white_(stack.picture(stack.count - 2).data() + begin),
        black_(stack.picture(stack.count - 1).data() + begin),
        constant_(float(noise.constant_dn * noise.constant_dn)),
        per_dn_(float(noise.variance_per_dn)),
        limits_(limits),
        largest_variance_(float(1 / (limits.min_modulation_sigmas * limits.min_modulation_sigmas))) {
    for (int j = 0; j < steps_; ++j) {
      const double shift = 2 * std::numbers::pi * j / steps_;
      samples_.push_back(stack.picture(group.first + j).data() + begin);
      cosines_.push_back(float(std::cos(shift)));
      sines_.push_back(float(std::sin(shift)));
    }
    for (auto* values : {&fit_.mean, &fit_.c, &fit_.s, &fit_.turns}) values->resize(count);
    fit_.variance.assign(count, infinite);
    fit_.why.assign(count, Reject::none);
  }

  FringeFit run() {
    std::vector<float> p, q;
    for (int j = 0; j < steps_; ++j) {
      p.push_back(2 * cosines_[j] / float(steps_));
      q.push_back(-2 * sines_[j] / float(steps_));
    }
    fit_fringe(samples_.data(), steps_, p.data(), q.data(), fit_.mean.size(),
               {fit_.mean.data(), fit_.c.data(), fit_.s.data(), fit_.turns.data()});
    if (per_dn_ == 0 && !saturates()) {
      judge_all();
    } else {
      for (std::size_t i = 0; i < fit_.mean.size(); ++i) judge(i);
    }
    return std::move(fit_);
  }

 private:
  bool saturates() const {
    T largest = 0;
    for (const T* samples : samples_)
      for (std::size_t i = 0; i < fit_.mean.size(); ++i) largest = std::max(largest, samples[i]);
    return largest >= limits_.full_scale_dn;
  }

  /// judge() of every pixel where noise is constant and nothing saturates.
  void judge_all() {
    const FringeSamples<T> samples{samples_.data(),
                                   steps_,
                                   cosines_.data(),
                                   sines_.data(),
                                   white_,
                                   black_,
                                   float(limits_.full_scale_dn),
                                   constant_,
                                   float(limits_.min_modulation_dn),
                                   largest_variance_,
                                   large_chi2};
    const std::size_t count = fit_.mean.size();
    fringe_variance(samples, fit_.mean.data(), fit_.c.data(), fit_.s.data(), count, fit_.variance.data());
    for (std::size_t i = 0; i < count; ++i)
      if (!(fit_.variance[i] < infinite)) fit_.why[i] = Reject::dim;
  }

  void judge(std::size_t i) {
    int saturated = 0;
    for (int j = 0; j < steps_; ++j) saturated += samples_[j][i] >= limits_.full_scale_dn;
    if (steps_ - saturated < 3) {
      fit_.why[i] = Reject::saturated;
      return;
    }
    // Variance in rad², first without, then with the misfit.
    const float variance = saturated ? refit(i) : variance_of_all(i);
    const float modulation = std::hypot(fit_.c[i], fit_.s[i]);
    const bool clear = modulation >= float(limits_.min_modulation_dn) && variance <= largest_variance_;
    if (!clear) {
      fit_.why[i] = Reject::dim;
      return;
    }
    fit_.variance[i] = variance * misfit_factor(i, saturated) / (turn * turn);
  }

  float sample_variance(std::size_t i, int j) const {
    return constant_ + per_dn_ * std::max(float(samples_[j][i]) - float(black_[i]), 0.0f);
  }

  float variance_of_all(std::size_t i) const {
    const float c = fit_.c[i], s = fit_.s[i], n = float(steps_), squared = c * c + s * s;
    if (per_dn_ == 0) return 2 * constant_ / (n * squared);
    float sum = 0;
    for (int j = 0; j < steps_; ++j) {
      const float sine = s * cosines_[j] + c * sines_[j];  // B·sin(φ + δ_j)
      sum += sample_variance(i, j) * sine * sine;
    }
    return 4 * sum / (n * n * squared * squared);
  }

  /// Least squares over the samples below full scale; gives the variance of φ.
  float refit(std::size_t i) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (int j = 0; j < steps_; ++j) {
      if (samples_[j][i] >= limits_.full_scale_dn) continue;
      const Eigen::Vector3d row(1, cosines_[j], -sines_[j]);
      normal += row * row.transpose();
      right += row * double(samples_[j][i]);
    }
    const Eigen::Matrix3d inverse = normal.inverse();
    const Eigen::Vector3d x = inverse * right;
    fit_.mean[i] = float(x[0]), fit_.c[i] = float(x[1]), fit_.s[i] = float(x[2]);
    turns_of(&fit_.c[i], &fit_.s[i], 1, &fit_.turns[i]);
    const double squared = x[1] * x[1] + x[2] * x[2];
    double variance = 0;
    for (int j = 0; j < steps_; ++j) {
      if (samples_[j][i] >= limits_.full_scale_dn) continue;
      const Eigen::Vector3d gain = inverse * Eigen::Vector3d(1, cosines_[j], -sines_[j]);
      const double by_sample = (x[1] * gain[2] - x[2] * gain[1]) / squared;
      variance += sample_variance(i, j) * by_sample * by_sample;
    }
    return float(variance);
  }

  /// What the sinusoid leaves over, in units of the samples' mean variance: for equal steps its expectation
  /// is N - 3.
  float rest_chi2(std::size_t i, int saturated) const {
    float squares = 0, variances = 0;
    for (int j = 0; j < steps_; ++j) {
      if (samples_[j][i] >= limits_.full_scale_dn) continue;
      const float rest =
          float(samples_[j][i]) - fit_.mean[i] - fit_.c[i] * cosines_[j] + fit_.s[i] * sines_[j];
      squares += rest * rest;
      variances += sample_variance(i, j);
    }
    return squares * float(steps_ - saturated) / variances;
  }

  /// max(1, χ²/dof where that is above 9).
  float misfit_factor(std::size_t i, int saturated) const {
    float sum = 0;
    const bool has_sum = saturated == 0 && white_[i] < limits_.full_scale_dn;
    const int freedom = steps_ - saturated - 3 + (has_sum ? 1 : 0);
    if (freedom == 0) return 1;
    if (steps_ - saturated > 3) sum += rest_chi2(i, saturated);
    if (has_sum) {
      const float rest = fit_.mean[i] - 0.5f * (float(white_[i]) + float(black_[i]));
      const float middle = constant_ + per_dn_ * std::max(fit_.mean[i] - float(black_[i]), 0.0f);
      sum += rest * rest / (middle * (1 / float(steps_) + 0.5f));
    }
    const float reduced = sum / float(freedom);
    return reduced > large_chi2 ? reduced : 1;
  }

  int steps_;
  const T *white_, *black_;
  float constant_, per_dn_;
  FringeLimits limits_;
  float largest_variance_;
  std::vector<const T*> samples_;
  std::vector<float> cosines_, sines_;
  FringeFit fit_;
};

}  // namespace

template <class T>
FringeFit fit_fringe(const ImageStackView<T>& stack, const PatternGroup& group, const SampleNoise& noise,
                     const FringeLimits& limits, std::size_t begin, std::size_t count) {
  return Fitter<T>(stack, group, noise, limits, begin, count).run();
}

template FringeFit fit_fringe(const ImageStackView<std::uint8_t>&, const PatternGroup&, const SampleNoise&,
                              const FringeLimits&, std::size_t, std::size_t);
template FringeFit fit_fringe(const ImageStackView<std::uint16_t>&, const PatternGroup&, const SampleNoise&,
                              const FringeLimits&, std::size_t, std::size_t);

}  // namespace laterna
