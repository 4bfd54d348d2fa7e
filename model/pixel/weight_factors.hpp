// Twin of rtl/quadrille_weight_factors.sv.
#pragma once

#include "model/pixel/pixel_pipeline.hpp"

namespace quadrille {

/// A weight M_i is the product of the three.
struct WeightFactors {
  PipelineFloat x, y, z;
};

/// Of the four corners of a pixel that is not on two edges.
std::array<WeightFactors, 4> weight_factors(const PixelTrace& p, const QuadData& quad, const PipelineContext& c);

/// |r_j k_i + r_i k_j| of edge e = (i, j): what the interpolation along it has as its denominator.
PipelineFloat edge_denominator(const PixelTrace& p, std::size_t e, const QuadData& quad, const PipelineContext& c);

}  // namespace quadrille
