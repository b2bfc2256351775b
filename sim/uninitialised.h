// Memory left uninitialised, so that the thread that computes a row is the first to touch it.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>

namespace laterna {

inline constexpr std::size_t cache_line = 64;

/// An allocator that leaves numbers uninitialised where a vector is made with a size alone, and begins at a
/// cache line.
template <class T>
struct UninitialisedAllocator : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = UninitialisedAllocator<U>;
  };
  T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new(count * sizeof(T), std::align_val_t(cache_line)));
  }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory, std::align_val_t(cache_line)); }
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
