// What writing a stack of pictures costs beside copying its bytes in memory.
#pragma once

namespace laterna {

/// Median over `repeats` of the seconds that 44 noisy 8-bit pictures take to reach a new folder under the
/// system's temporary folder, over the seconds of a copy of the same bytes by one thread. fsync included: it
/// depends on the disk.
struct PictureTimes {
  double png_over_copy = 0, tif_over_copy = 0, pages_over_copy = 0;
};
PictureTimes time_pictures(int repeats);

}  // namespace laterna
