// The static figure of a plan.
#pragma once

#include "apps/lab/report/static_figures.h"

namespace laterna {

/// Of plan_json() or plan_reference() (plan/plan_report.h): what every level that was tried changes alone,
/// beside the tolerance; none where nothing was tried. Below a thousandth of the tolerance, it is drawn
/// there.
void add_plan_figure(const nlohmann::json& plan, const std::string& name, std::vector<StaticFigure>& figures);

}  // namespace laterna
