// The one place that starts threads.
#pragma once

#include <cstddef>
#include <functional>

namespace laterna {

/// Sets how many threads parallel_for uses from now on; 0: as many as the machine has.
void set_thread_count(int threads);

/// How many threads parallel_for uses.
int thread_count();

/// Calls body(i) once for each i in [0, count), on several threads and in no stated order. The result is the
/// same for any number of threads as long as each call writes only what belongs to its own i. An exception of
/// a body is thrown again.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body);

}  // namespace laterna
