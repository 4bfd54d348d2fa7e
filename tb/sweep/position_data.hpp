// What depends on snapped positions alone, for the whole input: which pixels the machine covers, and the truth there up
// to the numbers k, Z and b.
#pragma once

#include "tb/sweep/given_truth.hpp"
#include "tb/sweep/measured_columns.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille::sweep {

/// Weights M of exact arithmetic at eight pixels, of either sign, scaled to Σ|M| = 1.
struct TruthWeights {
  LaneReals m[4];
};

/// Covered pixels in blocks of eight of one quad (the last block of a quad repeats a pixel to fill up), quads in order,
/// within a quad by y, then x. So every difference setting fills the same lanes, whatever its tiles.
struct PositionData {
  PositionData(const SweepInput& input, const GivenTruth& given, const Config& config, unsigned threads,
               const Stop& stop = {});

  std::size_t blocks() const { return quad.size(); }
  std::size_t bytes() const;

  std::vector<SnappedQuad> snapped;  ///< without attributes
  std::size_t fragments = 0;         ///< covered, not culled, in the scissor
  std::size_t covering = 0;          ///< quads with such

  std::vector<std::size_t> first_block;  ///< of each quad, and the end

  // Per block.
  std::vector<std::uint32_t> quad;
  std::vector<std::uint8_t> count;  ///< lanes in use
  std::vector<std::array<std::uint32_t, lane_count>> pixel;
  std::vector<TruthWeights> truth;
  // Lane masks.
  std::vector<std::uint8_t> visible;   ///< in front of the eye by exact arithmetic
  std::vector<std::uint8_t> singular;  ///< corner and two-edge pixels, whose M hold k: see PortQuads
  std::vector<std::uint8_t> given;     ///< the given quad draws the pixel too
  std::vector<std::array<std::uint32_t, lane_count>> given_at;  ///< position in GivenTruth where it does
};

}  // namespace quadrille::sweep
