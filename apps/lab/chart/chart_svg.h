// The chart as a picture.
#pragma once

#include "apps/lab/chart/chart.h"

#include <string>

namespace laterna {

/// An SVG of 1000×600: error (rms over the volume, projector pixels) over the chart's x, both logarithmic.
/// Each series has a colour (of Okabe and Ito's, which the colour-blind can tell apart) and a marker; it is
/// joined where one key is swept. Bars: quartiles over the seeds; in seconds, from the least to the largest
/// of the repeats. Dashed: the bound. The broad grey line steps along the front. A word at a marker names the
/// swept value where x does not. Points without a finite error above 0 are counted in the legend, not drawn.
std::string chart_svg(const Chart& chart);

}  // namespace laterna
