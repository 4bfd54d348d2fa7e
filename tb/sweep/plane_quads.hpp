// Which quads of an input a configuration draws with areas for weights (plane_quads): what positions,
// significand_bits and that key fix together.
#pragma once

#include "tb/sweep/position_data.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille::sweep {

/// Judged on the draw of all the input's own attributes at once, with depth where it is on: no weight is a plane
/// function of its quad, so that a pass of weights, or of the colours beside them, takes mean values for every quad.
class PlaneQuads {
 public:
  PlaneQuads(const SweepInput& input, const PositionData& positions, const Config& config, unsigned threads);

  /// By position in the input, 1: taken (model/skips/plane_quad.hpp), and covers a pixel.
  const std::vector<std::uint8_t>& taken() const { return taken_; }
  std::uint64_t count() const { return count_; }
  std::size_t bytes() const { return taken_.size(); }

 private:
  std::vector<std::uint8_t> taken_;
  std::uint64_t count_ = 0;
};

}  // namespace quadrille::sweep
