#include "sim/parallel.h"

#ifdef LATERNA_PLAIN_THREADS
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>
#else
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <memory>
#endif

namespace laterna {

#ifdef LATERNA_PLAIN_THREADS  // for ThreadSanitizer, which cannot see how oneTBB's threads wait for each
                              // other

namespace {

std::atomic<int> threads_set{0};
thread_local bool is_worker = false;

// One parallel_for: its threads take the next index until none is left or one has failed.
struct Work {
  std::size_t count;
  const std::function<void(std::size_t)>& body;
  std::atomic<std::size_t> next{0};
  std::mutex mutex{};
  std::exception_ptr fault{};

  void run() {
    is_worker = true;
    try {
      // Relaxed: any stronger order would tie the threads to each other, and hide races between their bodies.
      for (std::size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) body(i);
    } catch (...) {
      const std::scoped_lock lock(mutex);
      if (!fault) fault = std::current_exception();
      next = count;
    }
  }
};

}  // namespace

void set_thread_count(int threads) { threads_set = threads; }

int thread_count() {
  const int set = threads_set;
  return set > 0 ? set : std::max(1, int(std::thread::hardware_concurrency()));
}

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
  if (is_worker) {  // a nested call stays on its thread
    for (std::size_t i = 0; i < count; ++i) body(i);
    return;
  }
  Work work{count, body};
  {
    std::vector<std::jthread> threads;  // joined here
    for (std::size_t k = std::min<std::size_t>(thread_count(), count); k > 0; --k)
      threads.emplace_back([&] { work.run(); });
  }
  if (work.fault) std::rethrow_exception(work.fault);
}

#else

namespace {

std::unique_ptr<tbb::global_control>& control() {
  static std::unique_ptr<tbb::global_control> instance;
  return instance;
}

}  // namespace

void set_thread_count(int threads) {
  control().reset();
  if (threads > 0) {
    control() = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, threads);
  }
}

int thread_count() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
  if (count == 1) return body(0);  // no task: a waiting thread would take up others meanwhile
  tbb::parallel_for(std::size_t{0}, count, body);
}

#endif

}  // namespace laterna
