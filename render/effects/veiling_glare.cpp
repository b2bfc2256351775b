#include "render/effects/veiling_glare.h"

#include "sim/parallel.h"

namespace laterna {

std::vector<double> mean_light(const PatternStack& patterns) {
  const std::size_t count = patterns.count, height = patterns.height;
  std::vector<double> of_rows(height * count, 0.0);
  parallel_for(height, [&](std::size_t y) {
    double* sums = of_rows.data() + y * count;
    for (int x = 0; x < patterns.width; ++x) {
      const std::uint8_t* texel = patterns.texel(x, int(y));
      for (std::size_t k = 0; k < count; ++k) sums[k] += patterns.light_of_value[texel[k]];
    }
  });
  std::vector<double> means(count, 0.0);
  for (std::size_t i = 0; i < of_rows.size(); ++i) means[i % count] += of_rows[i];
  for (std::size_t k = 0; k < count; ++k) {
    means[k] /= double(patterns.width) * patterns.height;
    if (!patterns.added_light.empty()) means[k] += patterns.added_light[k];
  }
  return means;
}

void apply_veiling_glare(PatternStack& patterns, const ProjectorEffects& effects) {
  if (!effects.veiling_glare) return;
  const double glare = *effects.veiling_glare;
  const std::vector<double> means = mean_light(patterns);
  patterns.added_light.resize(means.size(), 0.0f);
  for (std::size_t k = 0; k < means.size(); ++k)
    patterns.added_light[k] = float((1 - glare) * double(patterns.added_light[k]) + glare * means[k]);
  for (float& light : patterns.light_of_value) light = float((1 - glare) * double(light));
}

}  // namespace laterna
