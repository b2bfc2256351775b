// The first lines of a report: what was asked, what the answer is, and why.
#pragma once

#include <nlohmann/json.hpp>

namespace laterna {

/// [{"of", "status", "reason", "facts": [{"name", "value", "unit"}]}] of what report_data() gathered: one for
/// each projector of a round trip or an estimate, for a calibration from boards, a chart and an atlas. Status
/// is "ok", "weak" or "refused", and empty for a chart; an atlas is "ok" where Laterna's own method is never
/// silently wrong and never crashes, else "failed". Values are those of the files.
nlohmann::json verdicts_of(const nlohmann::json& data);

}  // namespace laterna
