#include "model/support/parallel.hpp"

#include "model/support/refused_threads.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace quadrille {
namespace {

TEST(RunUnits, EveryUnitOnceOnAThreadOfItsOwn) {
  for (const unsigned threads : {0u, 1u, 3u}) {
    std::array<std::atomic<int>, 200> runs{};
    std::array<std::atomic<bool>, 3> busy{};
    run_units(runs.size(), threads, [&](std::size_t unit, unsigned thread) {
      ASSERT_LT(thread, std::max(threads, 1u));
      EXPECT_FALSE(busy[thread].exchange(true));
      ++runs[unit];
      std::this_thread::sleep_for(std::chrono::microseconds(100));
      busy[thread] = false;
    });
    for (const auto& count : runs) EXPECT_EQ(count, 1);
    run_units(0, threads, [](std::size_t, unsigned) { FAIL(); });
  }
}

TEST(RunUnits, AnExceptionOfAUnitEndsTheCall) {
  for (const unsigned threads : {1u, 3u}) {
    std::atomic<int> begun = 0;
    const auto body = [&](std::size_t unit, unsigned) {
      ++begun;
      if (unit == 5) throw std::runtime_error("unit 5");
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    EXPECT_THROW(run_units(1000, threads, body), std::runtime_error);
    EXPECT_LT(begun, 500);
  }
}

TEST(RunUnits, ProgressComesOnTheCallingThreadAndMayThrow) {
  const auto caller = std::this_thread::get_id();
  for (const unsigned threads : {1u, 2u}) {
    std::atomic<int> begun = 0;
    const auto body = [&](std::size_t, unsigned) {
      ++begun;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    };
    const auto progress = [&](std::size_t finished) {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      if (finished > 0) throw std::runtime_error("enough");
    };
    EXPECT_THROW(run_units(200, threads, body, progress), std::runtime_error);
    EXPECT_LT(begun, 200);
  }
}

TEST(OrderedParallel, ResultsInOrderOnTheCallingThread) {
  const auto caller = std::this_thread::get_id();
  for (const unsigned threads : {0u, 1u, 3u, 7u}) {
    for (const std::size_t units : {0u, 1u, 300u}) {
      std::atomic<std::size_t> ahead = 0;
      std::vector<std::size_t> consumed;
      ordered_parallel(
          units, threads,
          [&](std::size_t unit) {
            // Early units take longest, so later ones are done before them.
            std::this_thread::sleep_for(std::chrono::microseconds(unit % 7 == 0 ? 500 : 5));
            ++ahead;
            return unit * unit;
          },
          [&](std::size_t unit, std::size_t square) {
            EXPECT_EQ(std::this_thread::get_id(), caller);
            EXPECT_EQ(square, unit * unit);
            EXPECT_LE(ahead - consumed.size(), std::size_t{5} * std::max(threads, 1u)) << "results that wait";
            consumed.push_back(unit);
          });
      ASSERT_EQ(consumed.size(), units);
      for (std::size_t unit = 0; unit < units; ++unit) EXPECT_EQ(consumed[unit], unit);
    }
  }
}

TEST(OrderedParallel, TheLowestUnitThatThrewIsToldWhateverTheThreads) {
  for (const unsigned threads : {1u, 2u, 5u}) {
    std::size_t consumed = 0;
    try {
      ordered_parallel(
          100, threads,
          [](std::size_t unit) {
            // Unit 11 throws at once, unit 10 later.
            if (unit == 10) std::this_thread::sleep_for(std::chrono::milliseconds(20));
            if (unit == 10 || unit == 11) throw std::runtime_error(std::to_string(unit));
            return unit;
          },
          [&](std::size_t, std::size_t) { ++consumed; });
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "10");
    }
    EXPECT_EQ(consumed, 10u);
  }
}

TEST(OrderedParallel, AnExceptionOfTheConsumerEndsTheCall) {
  for (const unsigned threads : {1u, 3u}) {
    std::atomic<int> begun = 0;
    EXPECT_THROW(ordered_parallel(
                     1000, threads, [&](std::size_t) { return ++begun; },
                     [](std::size_t unit, int) {
                       if (unit == 5) throw std::runtime_error("unit 5");
                     }),
                 std::runtime_error);
    EXPECT_LT(begun, 100);
  }
}

TEST(ParallelFor, EveryUnitOnceAndExceptions) {
  for (const unsigned threads : {0u, 1u, 4u}) {
    std::array<std::atomic<int>, 100> runs{};
    parallel_for(runs.size(), threads, [&](std::size_t unit) { ++runs[unit]; });
    for (const auto& count : runs) EXPECT_EQ(count, 1);
    parallel_for(0, threads, [](std::size_t) { FAIL(); });
    EXPECT_THROW(parallel_for(9, threads, [](std::size_t) { throw std::runtime_error("a unit"); }), std::runtime_error);
  }
}

// ---- Fewer threads than wanted ----

TEST(RefusedThreads, RunUnitsDoesAllWithThoseThatItGets) {
  for (const int given : {0, 1, 2}) {
    const ThreadLimit limit(given);
    std::array<std::atomic<int>, 100> runs{};
    std::size_t finished = 0;
    const auto caller = std::this_thread::get_id();
    run_units(
        runs.size(), 5,
        [&](std::size_t unit, unsigned thread) {
          EXPECT_LT(thread, static_cast<unsigned>(std::max(given, 1)));
          EXPECT_EQ(std::this_thread::get_id() == caller, given == 0);
          ++runs[unit];
        },
        [&](std::size_t done) { finished = done; });
    for (const auto& count : runs) EXPECT_EQ(count, 1);
    EXPECT_LE(finished, runs.size());
    EXPECT_EQ(limit.refused(), 1) << "of five threads the first that is refused is the last one asked for";
    EXPECT_THROW(run_units(9, 5, [](std::size_t, unsigned) { throw std::runtime_error("a unit"); }),
                 std::runtime_error);
  }
}

TEST(RefusedThreads, OrderedParallelGivesAllInOrder) {
  for (const int given : {0, 1, 2}) {
    const ThreadLimit limit(given);
    std::vector<std::size_t> consumed;
    ordered_parallel(
        100, 5, [](std::size_t unit) { return unit * unit; },
        [&](std::size_t unit, std::size_t square) {
          EXPECT_EQ(square, unit * unit);
          consumed.push_back(unit);
        });
    ASSERT_EQ(consumed.size(), 100u);
    EXPECT_TRUE(std::ranges::is_sorted(consumed));
    EXPECT_EQ(limit.refused(), 1);
  }
}

}  // namespace
}  // namespace quadrille
