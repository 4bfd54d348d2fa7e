// Co-simulation of selected points of a sweep: the RTL with those widths in lockstep with the model.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace quadrille::tb {

struct CosimPoint {
  std::size_t row = 0;
  std::string why;  ///< it was selected
  Config config;
  std::uint64_t cycles = 0;  ///< that the sweep states; 0: not known
};

struct CosimRow {
  std::size_t row = 0;
  std::string why;
  std::uint64_t fragments = 0, cycles = 0;
  std::uint64_t mismatches = 0;  ///< bits of any stage boundary, fragments against the truth, and a wrong cycle count
  std::uint64_t cycle_mismatches = 0;
  std::string first_difference;
  double seconds = 0;
  bool complete = true;  ///< the whole draw, not ended by the limit

  bool ok() const { return fragments > 0 && mismatches == 0 && cycle_mismatches == 0; }
};

/// The weights of the quads (in one pass, as many as there are slots) through RTL and model, at most `limit` fragments
/// a point; where plane_quads counts their own attributes (the first of `attributes` that have a slot), since
/// no weight is plane; results in the order of `points`. `done` counts finished points. Throws EnvironmentError without
/// Verilator.
std::vector<CosimRow> cosimulate(std::span<const CosimPoint> points, std::span<const WindowQuad> quads, int attributes,
                                 const DrawState& state, std::uint64_t limit, std::uint64_t seed, unsigned threads,
                                 const std::function<void(std::size_t)>& done);

}  // namespace quadrille::tb
