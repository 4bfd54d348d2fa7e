#include "tb/sweep/parallel_units.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

namespace quadrille::sweep {
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

}  // namespace
}  // namespace quadrille::sweep
