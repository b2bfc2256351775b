// Each figure of a report as a static SVG: for papers, for machines without Node, for continuous integration.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace laterna {

struct StaticFigure {
  std::string name;  ///< plain, such as "residuals_camera_projector"
  std::string caption;
  std::string svg;  ///< with its own title; black on white
};

/// The figures of what report_data() gathered: residual histograms, error by range, held-out error by lens,
/// speed against accuracy, and outcomes by method. Points whose numbers are null are left out.
std::vector<StaticFigure> static_figures(const nlohmann::json& data);

}  // namespace laterna
