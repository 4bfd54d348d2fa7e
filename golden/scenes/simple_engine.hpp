// A small double-precision quad engine for choosing and testing inputs: the homogeneous form of the weights, without
// tie rules and without bounds. It is no reference.
#pragma once

#include "model/records.hpp"

#include <array>
#include <optional>

namespace quadrille::golden {

struct SimpleSample {
  std::array<double, 4> lambda{};  ///< perspective-correct weights
  double z = 0;                    ///< window z
};

/// What quad shows at window position (x, y): nothing outside it or behind the eye; depth is not clipped. Points on an
/// edge may go either way. + − × ÷ √ only, so the answer is the same on every machine.
std::optional<SimpleSample> simple_sample(const std::array<WindowVertex, 4>& quad, double x, double y);

/// Number of visible samples among 16 × 16 pixel centres spread evenly over the viewport.
int visible_probes(const std::array<WindowVertex, 4>& quad, int width, int height);

}  // namespace quadrille::golden
