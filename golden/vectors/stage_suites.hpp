// The stage suites of golden/vectors/README.md.
#pragma once

#include "golden/vectors/stage_suite.hpp"

#include <memory>
#include <vector>

namespace quadrille::vectors {

/// Appends snapping to depth, in order.
void add_stage_suites(std::vector<std::unique_ptr<Suite>>& suites);

using Stage = std::unique_ptr<const StageUnderTest>;
Stage make_snapping(const Config& config);
Stage make_setup(const Config& config);
Stage make_tile_context(const Config& config);
Stage make_coverage(const Config& config);
Stage make_forward_difference(const Config& config);
Stage make_normalise(const Config& config);
Stage make_sqrt(const Config& config);
Stage make_reciprocal(const Config& config);
Stage make_ratios(const Config& config);
Stage make_weights(const Config& config);
Stage make_interpolation(const Config& config);
Stage make_depth(const Config& config);

}  // namespace quadrille::vectors
