// The largest numbers that a scene may hold.
#pragma once

namespace laterna {

/// Farther out, a millimetre is lost in a double's last bits once it is squared.
inline constexpr double farthest_m = 1e9;

/// More rays than that in a pixel are a slip of the pen.
inline constexpr int most_samples_per_pixel = 4096;

/// Light that has been reflected more often is gone.
inline constexpr int most_bounces = 64;
inline constexpr int most_paths = 4096;

/// Samples × paths × bounces: what a pixel's row may hold, so that a region's rows fit in memory.
inline constexpr int most_entries_per_pixel = 1 << 18;

}  // namespace laterna
