// The stage suites of golden/vectors/README.md.
#pragma once

#include "golden/vectors/stage_suite.hpp"

#include <memory>
#include <vector>

namespace quadrille::vectors {

/// Appends snapping to depth, in order.
void add_stage_suites(std::vector<std::unique_ptr<Suite>>& suites);

void add_front_stages(std::vector<std::unique_ptr<Suite>>& suites);  ///< snapping to forward_difference
void add_pixel_stages(std::vector<std::unique_ptr<Suite>>& suites);  ///< normalise to depth

}  // namespace quadrille::vectors
