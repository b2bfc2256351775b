// Speed against accuracy: every point of a sweep measured on several seeds, and the front of what nothing
// beats.
#pragma once

#include "apps/lab/runner.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace laterna {

struct ChartOptions {
  std::uint64_t seed = 1;  ///< all seeds of points are drawn from it and the cell's name
  bool resume = false;
  std::vector<std::string> points{};  ///< labels of the only points to measure; empty: all
  int repeats = 0;                    ///< in place of the grids' own; 0: those
};

/// Lower quartile, median and upper quartile, by linear interpolation between order statistics.
struct Quartiles {
  double low = NAN, middle = NAN, high = NAN;
};

/// NaN for no values.
Quartiles quartiles(std::vector<double> values);

/// One combination of a grid under one method. What cannot be told is NaN.
struct ChartPoint {
  std::string label;   ///< "GRID: KEY=VALUE ... method=METHOD" of the keys that are swept; unique
  std::string series;  ///< what it is joined with: the grid, and the method where it has several
  std::string kind, method;
  nlohmann::json values;  ///< of the condition

  int seeds = 0, ok = 0, weak = 0, refused = 0, crashed = 0;  ///< of the seeds, how many ended so
  std::string reason;                                         ///< of the first seed that gave one

  Quartiles error_px;     ///< true volume rms, over the seeds that answered (ok or weak)
  double error_mm = NAN;  ///< pictures: of the light on the lit surface, rms, median
  double bound_px = NAN;  ///< median over the seeds
  std::string bound;      ///< what the bound is: "cramer_rao", or for pictures the solver's own
                          ///< "predicted_volume_rms_independent_px"
  double seconds = NAN;   ///< median over the seeds of the median of the repeats
  double seconds_low = NAN, seconds_high = NAN;        ///< the same of the repeats' least and largest
  std::vector<std::pair<std::string, double>> stages;  ///< seconds by stage, medians over all runs
  double peak_mib = NAN;                               ///< peak_memory.h, while a seed ran: median over them
  int pictures = 0;                                    ///< that are shown
  double capture_seconds = NAN;                        ///< pictures × seconds_per_picture
  double x = NAN;                                      ///< what the chart draws it against
};

struct Chart {
  std::string name;                 ///< the specification's file name without its extension
  std::string against = "seconds";  ///< what x is
  bool ratios = false;              ///< seconds are ratios to the fastest point's: a stored reference
  std::vector<ChartPoint> points;   ///< in the order of the specification, method by method
  bool interrupted = false;
  std::size_t done = 0, all = 0;
};

/// Indices of the points that no other beats: none has as little x and as little error, and one of them less.
/// A point that did not answer on every seed is not among them and beats nothing. Ascending in x.
std::vector<std::size_t> pareto_front(const std::vector<ChartPoint>& points);

/// Measures the points of a specification: grids (grid_file.h) of the kinds of atlas/cell_kinds.h, with the
/// settings
///
///   seeds = 5                    how many problems a point is tried on, the same ones by every method
///   repeats = 3                  how often each is solved, for the seconds
///   methods = ["laterna"]        of the kind's
///   against = "seconds"          the chart's x, the same in every grid: seconds (of solving; of pictures the
///                                whole trial but what only holds it against the truth), capture_seconds
///                                (pictures alone), or a key of the grids that holds numbers
///   seconds_per_picture = 1/60   for capture_seconds: a projector's frame at 60 Hz
///
/// Points run one after the other, each with all threads. A point's seeds depend on its cell's name and
/// `seed` alone. An exception while a problem is solved is a crash of that seed. `folder` holds the journal
/// (runner.h); a resumed run ends with what an uninterrupted one does, but for seconds. Throws InputError for
/// a malformed specification, a method that a kind has not, a label that no point bears.
Chart run_chart(const std::filesystem::path& specification, const std::filesystem::path& folder,
                const ChartOptions& options, const Progress& progress = {});

}  // namespace laterna
