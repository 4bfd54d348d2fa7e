// The queue of jobs where the system refuses threads.
#include "tb/support/work_queue.hpp"

#include "model/support/refused_threads.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

namespace quadrille::tb {
namespace {

TEST(WorkQueue, DoesAllWithTheThreadsThatItGets) {
  for (const int given : {0, 1, 2}) {
    const ThreadLimit limit(given);
    std::atomic<int> done = 0;
    {
      WorkQueue queue(4, 8);
      for (int i = 0; i < 100; ++i) queue.push([&] { ++done; });
      queue.drain();
      EXPECT_EQ(done, 100);
      queue.push([] { throw std::runtime_error("a job"); });
      EXPECT_THROW(queue.drain(), std::runtime_error);
    }
    EXPECT_EQ(limit.refused(), 1);
  }
}

}  // namespace
}  // namespace quadrille::tb
