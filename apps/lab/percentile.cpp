#include "apps/lab/percentile.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace laterna {

double percentile_99(const Image<float>& image) {
  std::vector<float> values;
  std::copy_if(image.values.begin(), image.values.end(), std::back_inserter(values),
               [](float v) { return std::isfinite(v); });
  if (values.empty()) return 0;
  const auto rank = values.begin() + std::ptrdiff_t(0.99 * double(values.size() - 1));
  std::nth_element(values.begin(), rank, values.end());
  return *rank;
}

}  // namespace laterna
