// The largest numbers that a scene may hold.
#pragma once

namespace laterna {

/// Farther out, a millimetre is lost in a double's last bits once it is squared.
inline constexpr double farthest_m = 1e9;

/// More rays than that in a pixel are a slip of the pen.
inline constexpr int most_samples_per_pixel = 4096;

}  // namespace laterna
