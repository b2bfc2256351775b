// Memory left uninitialised, so that the thread that computes a row is the first to touch it.
#pragma once

#include <memory>
#include <new>
#include <utility>

namespace laterna {

/// An allocator that leaves numbers uninitialised where a vector is made with a size alone.
template <class T>
struct UninitialisedAllocator : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = UninitialisedAllocator<U>;
  };
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
