#include "render/automatic_exposure.h"

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

constexpr double percentile = 0.999, share_of_scale = 0.8;

struct Whites {
  std::vector<double> lit, constant;  // of pixels with entries; of those with constant light alone
};

Whites whites_of(const LightRows& rows) {
  Whites whites;
  whites.lit.reserve(rows.region.size());
  for (std::size_t p = 0; p < rows.region.size(); ++p) {
    double white = rows.ambient_cd_per_m2[p];
    for (std::uint32_t e = rows.begin[p]; e < rows.begin[p + 1]; ++e) white += rows.entries[e].weight;
    if (rows.begin[p] < rows.begin[p + 1])
      whites.lit.push_back(white);
    else if (white > 0)
      whites.constant.push_back(white);
  }
  return whites;
}

void append(const std::vector<double>& from, std::vector<double>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

double automatic_saturation_cd_per_m2(std::span<const ImageRows> images) {
  Whites all;
  for (const ImageRows& image : images) {
    all.lit.reserve(all.lit.size() + std::size_t(image.size.x) * image.size.y);
    std::vector<Whites> parts(region_count(image));
    for_each_region(image, [&](const LightRows& rows, std::size_t index) { parts[index] = whites_of(rows); });
    for (const Whites& part : parts) append(part.lit, all.lit), append(part.constant, all.constant);
  }
  std::vector<double>& seen = all.lit.empty() ? all.constant : all.lit;
  if (seen.empty()) return 1;
  const auto rank = static_cast<std::size_t>(std::ceil(percentile * double(seen.size())));
  const auto at = seen.begin() + std::ptrdiff_t(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(seen.begin(), at, seen.end());
  return *at > 0 ? *at / share_of_scale : 1;
}

}  // namespace laterna
