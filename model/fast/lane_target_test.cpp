// Which instruction sets the lanes' code runs on here.
#include "model/support/lane_target.hpp"
#include "model/fast/each_lane_target.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <stdexcept>
#include <string>

namespace quadrille {
namespace {

TEST(LaneTarget, WhatRunsHere) {
  std::size_t run = 0;
  for (const LaneTarget target : lane_targets()) {
    std::printf("lanes %s: %s\n", std::string(name(target)).c_str(),
                can_run(target) ? "run" : "NOT run, this processor lacks them");
    run += can_run(target);
    if (!can_run(target)) {
      EXPECT_THROW(set_lane_target(target), std::invalid_argument);
    }
  }
  EXPECT_TRUE(can_run(LaneTarget::baseline));
  EXPECT_GE(run, 1u);
  std::size_t visited = 0;
  const LaneTarget before = lane_target();
  on_each_lane_target([&] { ++visited; });
  EXPECT_EQ(visited, run);
  EXPECT_EQ(lane_target(), before);
  EXPECT_FALSE(before < LaneTarget::v4 && can_run(LaneTarget::v4)) << "the best is in use unless another is chosen";
}

TEST(LaneTarget, ByName) {
  const LaneTarget before = lane_target();
  set_lane_target("baseline");
  EXPECT_EQ(lane_target(), LaneTarget::baseline);
  set_lane_target(before);
  try {
    set_lane_target("v5");
    FAIL() << "there is no v5";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("\"v5\"; expected one of baseline"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace quadrille
