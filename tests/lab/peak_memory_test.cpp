#include "apps/lab/peak_memory.h"

#include <gtest/gtest.h>

#include <vector>

namespace laterna {
namespace {

TEST(PeakMemory, RemembersWhatIsNoLongerHeld) {
  if (!restart_peak_memory()) GTEST_SKIP() << "/proc/self/clear_refs cannot be written here";
  const double before = peak_memory_mib();
  { const std::vector<char> touched(std::size_t(64) << 20, 1); }
  const double peak = peak_memory_mib();
  EXPECT_GT(peak, before + 60);   // 64 MiB, less what the heap already held
  EXPECT_LT(peak, before + 100);  // and little else
  ASSERT_TRUE(restart_peak_memory());
  EXPECT_LT(peak_memory_mib(), peak - 30);  // the vector went back to the system
}

}  // namespace
}  // namespace laterna
