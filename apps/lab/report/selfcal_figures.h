// The static figures of a self-calibration.
#pragma once

#include "apps/lab/report/static_figures.h"

namespace laterna {

/// Of selfcal_json() (selfcal_report.h): the rig where it holds points, each station's residuals beside the
/// error that noise predicts; none where it was refused.
void add_selfcal_figures(const nlohmann::json& selfcal, const std::string& name,
                         std::vector<StaticFigure>& figures);

}  // namespace laterna
