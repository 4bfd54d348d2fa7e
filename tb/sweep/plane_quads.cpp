#include "tb/sweep/plane_quads.hpp"

#include "model/skips/plane_quad.hpp"
#include "model/support/parallel.hpp"
#include "tb/sweep/work_units.hpp"

#include <algorithm>

namespace quadrille::sweep {
namespace {

constexpr std::size_t judged_per_unit = 64;

}  // namespace

PlaneQuads::PlaneQuads(const SweepInput& input, const PositionData& positions, const Config& config, unsigned threads)
    : taken_(input.quads.size()) {
  DrawState state = input.state;
  state.attributes = input.attributes;
  for (const std::uint32_t quad : positions.quad) taken_[quad] = 1;
  run_units(units_of(taken_.size(), judged_per_unit), threads, [&](std::size_t unit, unsigned) {
    for (std::size_t q = unit * judged_per_unit; q < std::min((unit + 1) * judged_per_unit, taken_.size()); ++q)
      if (taken_[q] != 0)
        taken_[q] = plane_quad(own_port(input.quads[q], static_cast<std::size_t>(input.attributes), config, state),
                               config, state);
  });
  count_ = static_cast<std::uint64_t>(std::ranges::count(taken_, 1));
}

}  // namespace quadrille::sweep
