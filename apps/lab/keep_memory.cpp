#include "apps/lab/keep_memory.h"

#include <limits>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace laterna {

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int largest_of_heap = 32 << 20;  // glibc's upper limit; larger blocks are the kernel's
  mallopt(M_MMAP_THRESHOLD, largest_of_heap);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
}

}  // namespace laterna
