// Errors of a picture's weights against exact ones.
#pragma once

#include "model/page/drawing.hpp"

#include <functional>

namespace quadrille::page {

/// A pixel that a picture of weights shows.
struct WeightError {
  int x = 0, y = 0;
  double error = 0;    ///< the largest |error| of its weights 1 to 3; NaN where one is no number
  bool inside = true;  ///< whether exact coverage has it
};

/// Of every `step`th pixel of every `step`th row, quad by quad. `weights`: a picture with four attributes.
void weight_errors(const Drawing& drawing, const DepthImage<double>& weights, int step,
                   const std::function<void(const WeightError&)>& take);

}  // namespace quadrille::page
