// The list of stage suites.
#include "golden/vectors/stage_suites.hpp"

#include "model/port/latency.hpp"

#include <string>
#include <utility>

namespace quadrille::vectors {

void add_stage_suites(std::vector<std::unique_ptr<Suite>>& suites) {
  const auto add = [&](SuiteInfo info, StageSuite::Make make) {
    suites.push_back(std::make_unique<StageSuite>(std::move(info), make));
  };
  const std::string numbers = "a number whose top bit of sig is 0, but for all fields 0; ";
  add({"snapping", "snapping", "Quads as given to the integers of the port", "none", 0,
       "nothing: any double may occur"},
      make_snapping);
  add({"setup", "handshake", "Edge functions, squared lengths, tiles and visibility of a quad", "quad_setup", 0,
       "|x| or |y| above 2^(POS_INT+FRAC); |w| above 2^FRAC; x = y = w = 0; a scissor rectangle beyond 2^VIEWPORT_BITS "
       "or with x0 > x1 or y0 > y1"},
      make_setup);
  add({"tile_context", "handshake", "Quadratic functions of a tile from its quad's vertices", "tile_context", 0,
       "a column or row beyond 2^VIEWPORT_BITS pixels; |w| above 2^FRAC; a homogeneous quad's |x| or |y| above "
       "2^(POS_INT+FRAC); an ordinary quad's w other than 2^FRAC, or its vertices beyond 2^(POS_INT+FRAC) from the "
       "viewport's origin wherever the first tile is, as long as the tile is in the viewport"},
      make_tile_context);
  add({"coverage", "handshake", "Covered pixels of a tile", "stamp_coverage", 0,
       "a function beyond VAL_BITS anywhere on the tile; a tile beyond 2^VIEWPORT_BITS; cull = 3; visible bits 0 and "
       "2, "
       "or 1 and 3, both set, unless all four are"},
      make_coverage);
  add({"forward_difference", "stage", "A, D and squared distances at a pixel from those of its tile",
       "forward_difference", latency::forward_difference_stages + latency::law_of_cosines_stages,
       "results beyond VAL_BITS (A) or QVAL_BITS (D, r2), though partial sums may be; a negative q of a squared "
       "distance"},
      make_forward_difference);
  add({"normalise", "stage", "Significand numbers of A, D and squared distances; the singular class", "normalise",
       latency::normalise_stages, "the most negative value of a width; r2 below -256"},
      make_normalise);
  add({"sqrt", "stage", "Square roots of the squared distances", "sqrt", latency::sqrt_stages,
       numbers + "exponents below 0 or above QVAL_BITS - 2"},
      make_sqrt);
  add({"reciprocal", "stage", "Reciprocal of a denominator", "reciprocal", latency::reciprocal_stages,
       numbers + "exponents that no sum has (see interpolation)"},
      make_reciprocal);
  add({"ratios", "stage", "Half-angle tangents of the edges and diagonals as v/u or u/v", "mean_value_ratios",
       latency::ratio_stage - latency::root_stage, numbers + "|A| or |D| above r r' by more than the rounding of r"},
      make_ratios);
  add({"weights", "stage", "Mean value weights up to a common factor", "mean_value_weights",
       latency::weight_stage - latency::ratio_stage,
       numbers +
           "r = 0 elsewhere than at a corner, and another r there; u = 0 elsewhere than at a corner, and another u "
           "or v there; v above u, or 0 elsewhere than where A is 0, or not 0 there"},
      make_weights);
  add({"interpolation", "stage", "Weighted sums over the corners, of attributes over three", "interpolate",
       latency::sum_stage - latency::weight_stage,
       numbers + "exponents of M that neither three factors nor a number of the port have; |W| above 1"},
      make_interpolation);
  add({"depth", "stage", "Quotients rounded and added to their bases, clamps and discard", "fragment_output",
       latency::fragment_stage - latency::sum_stage,
       numbers + "exponents that no sum has; attributes above ATTRIBUTE_SLOTS; znear, zfar or base_depth above 1; "
                 "depth_low above depth_high, "
                 "or one of them below -1 or above 2^DEPTH_BITS + 1; the most negative base_attr"},
      make_depth);
}

}  // namespace quadrille::vectors
