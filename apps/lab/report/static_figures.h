// Each figure of a report without a browser: for papers, for machines without Node, for continuous
// integration.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace laterna {

struct StaticFigure {
  std::string name;  ///< plain, such as "residual_histogram_camera_projector"
  std::string caption;
  std::string svg;    ///< with its own title, on a clear ground; empty for a picture
  std::string image;  ///< a PNG's data URI; empty for a drawing

  std::string file_name() const { return name + (svg.empty() ? ".png" : ".svg"); }
  std::string file_bytes() const;
};

/// The figures of what report_data() gathered: white frames and decoded maps, the rig, residual vectors and
/// histograms, difference and uncertainty over the projector's image, error by range, the lens ladder,
/// uncertainty by range and left-out poses of a calibration from boards, speed against accuracy, the atlas
/// for each method. Points whose numbers are null are left out. Throws InputError where the data are not as
/// Laterna writes them.
std::vector<StaticFigure> static_figures(const nlohmann::json& data);

}  // namespace laterna
