#include "render/effects/camera_glare.h"

#include "render/transpose.h"
#include "sim/parallel.h"

#include <numeric>

namespace laterna {

namespace {

double sum(const double* values, std::size_t count) { return std::accumulate(values, values + count, 0.0); }

// Adds each region's constant light to its place in `sums`, on the way.
RowSource summing_constant_light(const ImageRows& image, std::vector<double>& sums) {
  const int columns = (image.size.x + image.region_px.x - 1) / image.region_px.x;
  return [&image, &sums, columns](LightRows& rows) {
    image.rows(rows);
    const int index = rows.region.y / image.region_px.y * columns + rows.region.x / image.region_px.x;
    sums[std::size_t(index)] = sum(rows.ambient_cd_per_m2.data(), rows.ambient_cd_per_m2.size());
  };
}

// Per frame, Σ over one row of a stack of mean light · value's light.
std::vector<double> light_of_row(const MeanLight& mean, const PatternStack& frames, int y) {
  std::vector<double> light(std::size_t(frames.count), 0.0);
  for (int x = 0; x < frames.width; ++x) {
    const double weight = mean.of_pixel(x, y);
    if (weight == 0) continue;
    const std::uint8_t* texel = frames.texel(x, y);
    for (std::size_t k = 0; k < light.size(); ++k) light[k] += weight * frames.light_of_value[texel[k]];
  }
  return light;
}

}  // namespace

MeanLight mean_light_of(const ImageRows& image, Lookup lookup, const glm::ivec2& projector_size) {
  const double pixels = double(image.size.x) * image.size.y;
  std::vector<double> constant(region_count(image), 0.0);
  const ImageRows counted{image.size, summing_constant_light(image, constant), image.region_px};
  const Image<float> ones(image.size.x, image.size.y, 1.0f);
  MeanLight mean{0, apply_transpose(counted, lookup, ones, projector_size), 0};
  for (double& light : mean.of_pixel.values) light /= pixels;
  mean.constant = sum(constant.data(), constant.size()) / pixels;
  mean.white = sum(mean.of_pixel.values.data(), mean.of_pixel.values.size());
  return mean;
}

PatternStack veil_of(const MeanLight& mean, const PatternStack& frames) {
  std::vector<std::vector<double>> rows(std::size_t(frames.height));
  parallel_for(rows.size(), [&](std::size_t y) { rows[y] = light_of_row(mean, frames, int(y)); });
  PatternStack veil{1, 1, frames.count, std::vector<std::uint8_t>(std::size_t(frames.count), 0)};
  for (std::size_t k = 0; k < std::size_t(frames.count); ++k) {
    double light = 0;
    for (const std::vector<double>& row : rows) light += row[k];
    const double added = frames.added_light.empty() ? 0 : double(frames.added_light[k]);
    veil.added_light.push_back(mean.white > 0 ? float(light / mean.white + added) : 0.0f);
  }
  return veil;
}

ImageRows apply_camera_glare(const ImageRows& image, const MeanLight& mean, double glare) {
  const double constant = glare * mean.constant;
  const LightEntry veil{0, 0, glare * mean.white, 0, 1};
  return {image.size,
          [image, veil, constant, kept = 1 - glare](LightRows& rows) {
            image.rows(rows);
            RowBuilder builder(rows.region.size());
            for (std::size_t p = 0; p < rows.region.size(); ++p) {
              for (std::uint32_t e = rows.begin[p]; e < rows.begin[p + 1]; ++e) {
                LightEntry entry = rows.entries[e];
                entry.weight *= kept;
                builder.add(p, entry);
              }
              builder.add(p, veil);
              rows.ambient_cd_per_m2[p] = kept * rows.ambient_cd_per_m2[p] + constant;
            }
            builder.finish(rows);
          },
          image.region_px};
}

}  // namespace laterna
