#include "sim/uninitialised.h"

#include <sys/mman.h>

namespace laterna {

namespace {

std::align_val_t alignment_of(std::size_t bytes) {
  return std::align_val_t(bytes < huge_page ? cache_line : huge_page);
}

}  // namespace

void* allocate_uninitialised(std::size_t bytes) {
  void* memory = ::operator new(bytes, alignment_of(bytes));
  if (bytes >= huge_page) madvise(memory, bytes, MADV_HUGEPAGE);
  return memory;
}

void free_uninitialised(void* memory, std::size_t bytes) { ::operator delete(memory, alignment_of(bytes)); }

}  // namespace laterna
