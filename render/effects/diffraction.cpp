#include "render/effects/diffraction.h"

#include <array>
#include <cmath>
#include <numbers>

namespace laterna {

namespace {

// Where J1 is 0.
constexpr double first_dark = 3.8317059702075123;
constexpr std::array<double, 9> circle_at{0,
                                          first_dark / 4,
                                          first_dark / 2,
                                          first_dark * 3 / 4,
                                          first_dark,
                                          7.0155866698156188,
                                          10.173468135062722,
                                          13.323691936314223,
                                          16.470630050877633};

double share_within(double x) {
  const double j0 = std::cyl_bessel_j(0, x), j1 = std::cyl_bessel_j(1, x);
  return 1 - j0 * j0 - j1 * j1;
}

std::array<AiryCircle, circle_at.size()> make_circles() {
  std::array<AiryCircle, circle_at.size()> circles{};
  for (std::size_t i = 0; i < circle_at.size(); ++i)
    circles[i] = {circle_at[i] / std::numbers::pi,
                  share_within(circle_at[i]) / share_within(circle_at.back())};
  circles[0].share = 0;
  return circles;
}

// Light over squared radius between circle i - 1 and circle i; 0 beyond the last.
double density(std::span<const AiryCircle> circles, std::size_t i) {
  if (i == circles.size()) return 0;
  const AiryCircle &inner = circles[i - 1], &outer = circles[i];
  return (outer.share - inner.share) / (outer.radius * outer.radius - inner.radius * inner.radius);
}

}  // namespace

std::span<const AiryCircle> airy_circles() {
  static const auto circles = make_circles();
  return circles;
}

double airy_unit_px(const Optics& optics, const Intrinsics& k) {
  return optics.aperture_m ? std::sqrt(k.fx * k.fy) * optics.wavelength_m / *optics.aperture_m : 0;
}

std::vector<DiscShare> airy_discs(double unit_px) {
  const auto circles = airy_circles();
  std::vector<DiscShare> discs;
  for (std::size_t i = 1; i < circles.size(); ++i) {
    const double radius = circles[i].radius;
    discs.push_back(
        {2 * radius * unit_px, (density(circles, i) - density(circles, i + 1)) * radius * radius});
  }
  return discs;
}

glm::vec2 airy_point(const glm::vec2& in_unit_disc) {
  const auto circles = airy_circles();
  const double share = glm::dot(glm::dvec2(in_unit_disc), glm::dvec2(in_unit_disc));
  if (share == 0) return {0, 0};
  std::size_t i = 1;
  while (i + 1 < circles.size() && circles[i].share < share) ++i;
  const double inner = circles[i - 1].radius;
  const double radius = std::sqrt(inner * inner + (share - circles[i - 1].share) / density(circles, i));
  return in_unit_disc * static_cast<float>(radius / std::sqrt(share));
}

}  // namespace laterna
