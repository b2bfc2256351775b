// Memory left uninitialised, so that the thread that computes a row is the first to touch it; large blocks
// ask for huge pages.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>

namespace laterna {

inline constexpr std::size_t cache_line = 64;

/// Of 2 MiB, as on x86-64 and, by default, arm64.
inline constexpr std::size_t huge_page = std::size_t{2} << 20;

/// As operator new, aligned to a cache line. A block of a huge page and more is aligned to one, and asks for
/// them: a stack of pictures is written once, and faults of 4 KiB each cost more than computing it does.
/// Where the kernel has none to give, nothing is lost.
void* allocate_uninitialised(std::size_t bytes);
void free_uninitialised(void* memory, std::size_t bytes);

/// An allocator that leaves numbers uninitialised where a vector is made with a size alone, and begins at a
/// cache line.
template <class T>
struct UninitialisedAllocator : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = UninitialisedAllocator<U>;
  };
  T* allocate(std::size_t count) { return static_cast<T*>(allocate_uninitialised(count * sizeof(T))); }
  void deallocate(T* memory, std::size_t count) { free_uninitialised(memory, count * sizeof(T)); }
  template <class U, class... Arguments>
  void construct(U* where, Arguments&&... arguments) {
    if constexpr (sizeof...(Arguments) == 0) {
      ::new (static_cast<void*>(where)) U;
    } else {
      ::new (static_cast<void*>(where)) U(std::forward<Arguments>(arguments)...);
    }
  }
};

}  // namespace laterna
