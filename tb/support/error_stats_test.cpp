// Statistics of errors: what a NaN does to them.
#include "tb/support/error_stats.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using quadrille::tb::ErrorStats;

TEST(ErrorStats, ANanStaysWhateverFollows) {
  ErrorStats stats;
  stats.add(0.25);
  EXPECT_EQ(stats.max(), 0.25);
  stats.add(std::numeric_limits<double>::quiet_NaN());
  stats.add(0.5);
  EXPECT_TRUE(std::isnan(stats.max()));
  EXPECT_EQ(stats.count(), 3u);

  ErrorStats clean;
  clean.add(1);
  ErrorStats merged = stats;
  merged.merge(clean);
  EXPECT_TRUE(std::isnan(merged.max()));
  clean.merge(stats);
  EXPECT_TRUE(std::isnan(clean.max()));
}

}  // namespace
