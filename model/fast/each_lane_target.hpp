// For tests: the same check on every instruction set of the lanes that this processor has.
#pragma once

#include "model/support/lane_target.hpp"

#include <gtest/gtest.h>

namespace quadrille {

/// Calls body() with each target in use in turn, then puts back the one that was.
template <class Body>
void on_each_lane_target(Body&& body) {
  const LaneTarget before = lane_target();
  for (const LaneTarget target : lane_targets()) {
    if (!can_run(target)) continue;
    set_lane_target(target);
    SCOPED_TRACE("lanes " + std::string(name(target)));
    body();
  }
  set_lane_target(before);
}

}  // namespace quadrille
