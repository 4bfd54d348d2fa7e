// What both halves of `bench` make of their timings.
#pragma once

#include "tb/support/stopwatch.hpp"

#include <algorithm>
#include <vector>

namespace quadrille::tb {

/// The upper one of two middle values; 0 of nothing.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace quadrille::tb
