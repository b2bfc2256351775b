#include "sim/parallel.h"

#include <gmock/gmock.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace laterna {
namespace {

/// Threads as they were before the test.
struct ThreadCount {
  explicit ThreadCount(int threads) { set_thread_count(threads); }
  ~ThreadCount() { set_thread_count(0); }
};

TEST(ParallelFor, CallsEachIndexOnce) {
  for (const int threads : {1, 2, 7}) {
    const ThreadCount count(threads);
    EXPECT_EQ(thread_count(), threads);
    std::vector<int> calls(1000, 0);
    parallel_for(calls.size(), [&](std::size_t i) { ++calls[i]; });
    EXPECT_THAT(calls, ::testing::Each(1));
  }
  parallel_for(0, [](std::size_t) { FAIL(); });
}

TEST(ParallelFor, ShowsWhatWasWrittenToTheCaller) {
  const ThreadCount count(4);
  for (int round = 0; round < 50; ++round) {
    std::vector<std::size_t> squares(97);
    parallel_for(squares.size(), [&](std::size_t i) { squares[i] = i * i; });
    std::size_t sum = 0;
    for (const std::size_t square : squares) sum += square;
    EXPECT_EQ(sum, 96u * 97u * 193u / 6u);  // Σ i² = n(n+1)(2n+1)/6
  }
}

TEST(ParallelFor, Nests) {
  const ThreadCount count(3);
  std::vector<std::vector<int>> calls(20, std::vector<int>(30, 0));
  parallel_for(calls.size(),
               [&](std::size_t i) { parallel_for(calls[i].size(), [&](std::size_t j) { ++calls[i][j]; }); });
  EXPECT_THAT(calls, ::testing::Each(::testing::Each(1)));
}

TEST(ParallelFor, ThrowsABodysExceptionAgain) {
  for (const int threads : {1, 4}) {
    const ThreadCount count(threads);
    try {
      parallel_for(100, [](std::size_t i) {
        if (i % 10 == 3) throw std::out_of_range("third");
      });
      FAIL() << "nothing was thrown";
    } catch (const std::out_of_range& error) {
      EXPECT_STREQ(error.what(), "third");
    }
    std::atomic<int> calls = 0;
    parallel_for(10, [&](std::size_t) { ++calls; });
    EXPECT_EQ(calls, 10);
  }
}

}  // namespace
}  // namespace laterna
