// cosim --draws: an input cut into draws that one machine draws one after the other, with clears, resets and other draw
// states between them.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"
#include "model/support/prng.hpp"
#include "tb/lockstep/wait_pattern.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace quadrille::tb {

struct PlannedDraw {
  std::vector<WindowQuad> quads;     ///< of port quads, ids alone
  std::vector<SnappedQuad> at_port;  ///< what the port gets in their place; empty: the quads snapped
  DrawState state;
  bool reset = false;         ///< before it, whatever the machine is doing
  bool power_on = false;      ///< before it: another machine, whose registers hold random bits from `seed`
  unsigned clears = 0;        ///< of what is hidden, before it
  std::uint64_t limit = 0;    ///< the draw is cut off after so many fragments, and a reset follows; 0: it is complete
  std::uint32_t id_bits = 0;  ///< flipped in the position of each quad: the id that the port gets
  std::uint64_t seed = 1;     ///< of its waits
  WaitKind waits = WaitKind::chance;
  double stall = 0, gap = 0;  ///< chances of waits
  double flush = 0;           ///< chance per clock that an incomplete quad is discarded, which comes again
};

/// PlannedDraw::id_bits: any bits of an id.
std::uint32_t random_id_bits(const Config& config, golden::Prng& rng);

/// PlannedDraw::flush of draw number `draw`: a third of them have flushes.
double flush_chance(std::size_t draw);

/// `count` draws of the quads, in order; of an input with fewer quads some come again. About half of the draws begin
/// with the quads of an earlier one: what a machine keeps of those must not hide them after a clear. Draw states are
/// random_draw_state()'s, a third of them nearly the default. Between draws there are no clears, one, two, or half of
/// the epochs; a few draws are cut off by a reset. The same arguments give the same draws everywhere.
std::vector<PlannedDraw> plan_draws(std::span<const WindowQuad> quads, std::size_t count, const Config& config,
                                    int width, int height, std::uint64_t seed);

}  // namespace quadrille::tb
