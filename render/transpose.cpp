#include "render/transpose.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace laterna {

namespace {

void scatter(const LightRows& rows, Lookup lookup, const Image<float>& camera_image, std::uint32_t source,
             Image<double>& sum) {
  for (std::size_t p = 0; p < rows.region.size(); ++p) {
    const int x = rows.region.x + int(p) % rows.region.width, y = rows.region.y + int(p) / rows.region.width;
    for (std::uint32_t e = rows.begin[p]; e < rows.begin[p + 1]; ++e) {
      const LightEntry& entry = rows.entries[e];
      if (entry.source != source) continue;
      const double value = entry.weight * camera_image(x, y);
      if (lookup == Lookup::nearest) {
        sum(nearest_texel(entry.u_px, sum.width), nearest_texel(entry.v_px, sum.height)) += value;
        continue;
      }
      const LinearTaps u = linear_taps(entry.u_px, sum.width), v = linear_taps(entry.v_px, sum.height);
      sum(u.first, v.first) += value * (1 - u.share) * (1 - v.share);
      sum(u.second, v.first) += value * u.share * (1 - v.share);
      sum(u.first, v.second) += value * (1 - u.share) * v.share;
      sum(u.second, v.second) += value * u.share * v.share;
    }
  }
}

}  // namespace

Image<double> apply_transpose(const ImageRows& image, Lookup lookup, const Image<float>& camera_image,
                              glm::ivec2 projector_size, std::uint32_t source) {
  constexpr std::size_t batch = 64;  // regions traced at once; added one after the other, for the same bits
  Image<double> sum(projector_size.x, projector_size.y);
  const std::size_t count = region_count(image);
  for (std::size_t first = 0; first < count; first += batch) {
    std::vector<LightRows> parts(std::min(batch, count - first));
    for_each_region(image, first, parts.size(),
                    [&](LightRows& rows, std::size_t index) { parts[index - first] = std::move(rows); });
    for (const LightRows& part : parts) scatter(part, lookup, camera_image, source, sum);
  }
  return sum;
}

}  // namespace laterna
