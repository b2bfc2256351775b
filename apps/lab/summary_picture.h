// The picture at the end of a round trip: captured white frame, decoded columns and rows, error on the
// surface.
#pragma once

#include "apps/lab/canvas.h"

#include "calib/decoded_map.h"

#include <string>
#include <vector>

namespace laterna {

/// What one view contributes. Maps have the camera's size.
struct SummaryPanels {
  std::string title;               ///< first line, large
  std::vector<std::string> lines;  ///< further lines
  Image<float> white;              ///< 0 to 1
  const DecodedMap* decoded = nullptr;
  glm::ivec2 projector_size{1, 1};
  Image<float> error_px;  ///< NaN where nothing is compared; empty where there is no estimate
};

/// Four panels under the title. The error's colours run from 0 to its 99th percentile, which is printed
/// beside the bar.
Canvas summary_picture(const SummaryPanels& panels);

}  // namespace laterna
