#include "calib/decode_quality.h"

#include "sim/error.h"
#include "sim/parallel.h"

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace laterna {

namespace {

constexpr double nothing = std::numeric_limits<double>::infinity();

/// Camera and projector pixels of a window's valid pixels; the camera's counted from the window's corner.
struct Matches {
  std::vector<cv::Point2d> camera, projector;
};

Matches matches_of(const DecodedMap& map, int left, int top, int window) {
  Matches matches;
  for (int y = top; y < top + window; ++y) {
    for (int x = left; x < left + window; ++x) {
      if (!map.valid(x, y)) continue;
      matches.camera.emplace_back(x - left, y - top);
      matches.projector.emplace_back(map.u_px(x, y), map.v_px(x, y));
    }
  }
  return matches;
}

/// sqrt(mean(du² + dv²)) about the fitted homography; infinite where the pixels do not determine one.
double residual_px(const Matches& matches) {
  const cv::Mat projector_from_camera = cv::findHomography(matches.camera, matches.projector);
  if (projector_from_camera.empty()) return nothing;
  std::vector<cv::Point2d> predicted;
  cv::perspectiveTransform(matches.camera, predicted, projector_from_camera);
  double sum = 0;
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    const cv::Point2d d = predicted[i] - matches.projector[i];
    sum += d.dot(d);
  }
  return std::sqrt(sum / double(predicted.size()));
}

}  // namespace

double median_local_residual_px(const DecodedMap& map, const LocalResidualOptions& options) {
  const int window = options.window;
  if (window < 3 || options.min_decoded < 8) {
    throw InputError(
        fmt::format("local residual: windows of {} pixels with at least {} decoded, expected at "
                    "least 3 and 8",
                    window, options.min_decoded));
  }
  const int columns = map.width / window, rows = map.height / window;
  std::vector<double> residuals(std::size_t(columns) * rows, nothing);
  parallel_for(residuals.size(), [&](std::size_t i) {
    const Matches matches = matches_of(map, int(i) % columns * window, int(i) / columns * window, window);
    if (int(matches.camera.size()) >= options.min_decoded) residuals[i] = residual_px(matches);
  });
  const auto fitted =
      std::partition(residuals.begin(), residuals.end(), [](double r) { return r < nothing; });
  if (fitted == residuals.begin()) {
    throw Refusal(fmt::format("local residual: no window of {0}×{0} camera pixels has {1} decoded pixels",
                              window, options.min_decoded));
  }
  const auto middle = residuals.begin() + (fitted - residuals.begin()) / 2;
  std::nth_element(residuals.begin(), middle, fitted);
  return *middle;
}

}  // namespace laterna
