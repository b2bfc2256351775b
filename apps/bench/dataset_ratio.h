// What a data set's samples cost beside encoding and writing the same pictures.
#pragma once

namespace laterna {

/// `samples` samples of one camera of 640×480, 42 pictures in fast PNG, 50,000 triangles: drawn, traced,
/// captured with truth, mask, correspondences and record, written, packed; over the seconds that encoding and
/// writing their pictures again in the same way takes in the same run, on `threads` threads; the median of
/// three turns. Both reach the disk (fsync).
struct DatasetTimes {
  double over_write = 0;         ///< the ratio
  double samples_per_s_one = 0;  ///< on one thread
  double samples_per_s = 0;      ///< on `threads`
  double cpu_s_per_sample = 0;   ///< on one thread
  double bytes_per_sample = 0;
};
DatasetTimes time_dataset(int samples, int threads);

}  // namespace laterna
