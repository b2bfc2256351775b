// What a chart says, for machines, for spreadsheets and for people.
#pragma once

#include "apps/lab/chart/chart.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace laterna {

/// {"points": [{"label", "error_px", "bound_px", "seconds", "spread_px", "command"}], "pareto": [LABEL]}:
/// error_px is the median over the seeds, spread_px the distance between their quartiles. `specification` is
/// named in the commands; each measures its point alone, with the same seeds, in a folder of its own. A
/// number that is not finite is null.
nlohmann::json chart_summary(const Chart& chart, const std::string& specification, std::uint64_t seed);

/// All that is known of each point, with the same keys beside "series", "kind", "method", "values", "seeds",
/// "ok", "weak", "refused", "crashed", "reason", "error_low_px", "error_high_px" (the quartiles), "error_mm",
/// "bound", "seconds_low", "seconds_high", "stages", "peak_mib", "pictures", "capture_seconds", "x"; beside
/// "chart", "against" and "threads".
nlohmann::json chart_json(const Chart& chart, const std::string& specification, std::uint64_t seed);

/// What holds on every machine: as chart_json(), with seconds over those of the fastest point
/// ("seconds_ratio"), without stages, memory, commands and threads.
nlohmann::json chart_reference(const Chart& chart);

/// What chart_json() or chart_reference() wrote; of the latter, seconds are ratios. Throws nlohmann's
/// exception where a key is missing or of another type.
Chart read_chart(const nlohmann::json& json);

/// What chart_reference() wrote; seconds are ratios. Throws InputError, beginning with `place`, for anything
/// else.
Chart read_chart_reference(const std::string& text, const std::string& place);

/// One line per point, a comma between its values, "quoted" where it must be (RFC 4180); empty: not finite.
std::string chart_csv(const Chart& chart);

/// A table of the points, those on the front marked with *, and what refused or crashed.
std::string chart_text(const Chart& chart);

}  // namespace laterna
