// Static figures of a calibration from boards.
#pragma once

#include "apps/lab/report/static_figures.h"

namespace laterna {

/// Of board_json() (board_json.h): the lens ladder, the rig, uncertainty by range, each pose left out;
/// those for which it has numbers.
void add_board_figures(const nlohmann::json& board, std::vector<StaticFigure>& figures);

}  // namespace laterna
