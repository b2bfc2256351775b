#include "calib/bent_response.h"

#include <cmath>
#include <complex>
#include <numbers>

namespace laterna {

namespace {

constexpr int samples = 64;
constexpr double two_pi = 2 * std::numbers::pi, largest_gamma = 8;

double light(double theta, double gamma) { return std::pow((1 + std::cos(theta)) / 2, gamma); }

double mean_rest_of(double gamma) {
  double sum = 0;
  for (int i = 0; i < samples; ++i) sum += light(two_pi * (i + 0.5) / samples, gamma);
  return 0.5 - sum / samples;
}

double gamma_of(double mean_rest) {
  double low = 1, high = largest_gamma;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (mean_rest_of(middle) < mean_rest ? low : high) = middle;
  }
  return low;
}

}  // namespace

double response_shift_px(double gamma, int steps, double pitch_px) {
  double squares = 0;
  for (int i = 0; i < samples; ++i) {
    const double theta = two_pi * (i + 0.5) / samples;
    std::complex<double> sum = 0;
    for (int j = 0; j < steps; ++j)
      sum += light(theta + two_pi * j / steps, gamma) * std::polar(1.0, -two_pi * j / steps);
    squares += std::pow(std::arg(sum * std::polar(1.0, -theta)), 2);
  }
  return std::sqrt(squares / samples) / two_pi * pitch_px;
}

double bent_response_shift_px(double mean_rest, int steps, double pitch_px) {
  return response_shift_px(gamma_of(std::abs(mean_rest)), steps, pitch_px);
}

}  // namespace laterna
