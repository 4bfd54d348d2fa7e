// Draws through the clocked model, with the clock of every fragment.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

namespace quadrille::vectors {

/// What may happen in one clock.
struct StallClock {
  bool offer = true;  ///< a vertex beat that is not on offer yet may be offered
  bool ready = true;  ///< a fragment is taken
};

/// `length` clocks of a random pattern: bursts and lone stalls of both sides. The first clock offers, and some clock
/// does both, so that every draw ends.
std::vector<StallClock> make_stalls(std::uint64_t seed, std::size_t length);

struct TimedFragment {
  Fragment fragment;
  std::uint32_t clock = 0;  ///< in which it is handed over
};

struct MachineRun {
  std::vector<TimedFragment> fragments;
  std::vector<std::uint32_t> taken;  ///< the clock in which each vertex beat is taken, four a quad
};

/// Draws the quads from reset. Clock 0 is the first clock after it; the first beat is offered in it. A beat stays on
/// offer until it is taken. `stalls` is used cyclically from clock 0; empty: never a stall.
MachineRun run_machine(std::span<const SnappedQuad> quads, const Config& config, const DrawState& state,
                       std::span<const StallClock> stalls);

/// Stalls change what the machine draws: it is broken.
struct MachineError : std::logic_error {
  using std::logic_error::logic_error;
};

/// A draw without stalls and with them.
struct DrawRun {
  MachineRun free, stalled;
};
/// Throws MachineError unless both have as many fragments.
DrawRun run_both(std::span<const SnappedQuad> quads, const Config& config, const DrawState& state,
                 std::span<const StallClock> stalls);

}  // namespace quadrille::vectors
