#pragma once

#include "model/front/tile_walk.hpp"
#include "model/port/performance_counters.hpp"

#include <array>

namespace quadrille::clocked {

/// The clocks of the walk: what is tested goes through two registers to the ring, and a block's test is known a clock
/// after the walk went on.
struct TileWalk {
  using State = quadrille::TileWalk::State;
  struct Step {
    bool push = false;
    TileEntry entry;
  };

  /// Tests whose result is known in this clock.
  struct Tests {
    bool block = false, enter = false, block_hidden = false, tile = false, hidden = false;
  };

  quadrille::TileWalk walk;
  Tests tests;
  bool wait = false;          ///< the walk stands: the block tested in the clock before is entered, or was the last
  bool finishing = false;     ///< the end entry is on its way
  std::array<Step, 2> way{};  ///< steps on their way to the ring, the last one pushes

  /// The end entry waits to be pushed, and all tiles are in the ring.
  bool at_end() const { return finishing && way.back().push && way.back().entry.end; }
  bool ready() const { return walk.state() == State::idle || at_end(); }
  /// The next quad comes in, once ready(); after clock(), if the walk moves.
  void take(const SetupResult& setup, quadrille::HierarchicalZ* memory, const DepthInterval& depth) {
    walk.take(setup, memory, depth);
    finishing = false;
  }

  /// The edge, unless a push waits for the ring.
  void clock() {
    if (at_end()) {
      walk.advance();
      finishing = false;
    }
    for (std::size_t n = way.size() - 1; n > 0; --n) {
      way[n].push = way[n - 1].push;
      if (way[n].push) way[n].entry = way[n - 1].entry;  // most steps push nothing, and an entry is large
    }
    Step& step = way.front();
    step.push = false;
    tests = {};
    if (wait) {
      wait = false;
      return;
    }
    switch (walk.state()) {
      case State::idle:
        break;
      case State::approach:
        walk.advance();
        break;
      case State::block:
        wait = walk.hit();
        tests.block = true;
        tests.enter = wait;
        tests.block_hidden = walk.hidden();
        walk.advance();
        wait = wait || walk.state() == State::end;
        break;
      case State::tile:
        step.push = walk.hit();
        tests.tile = true;
        tests.hidden = walk.hidden();
        if (step.push) step.entry = walk.entry();
        walk.advance();
        break;
      case State::end:
        step.push = !finishing;
        if (step.push) step.entry = walk.entry();
        finishing = true;
        break;
    }
  }

  /// `moves`: clock() comes with this edge; `pushes`: the ring takes the last step's entry.
  void count(PerformanceCounters& to, bool moves, bool pushes) const {
    using enum PerformanceCounter;
    to[tiles_entered] += pushes && !way.back().entry.end;
    if (!moves) return;
    to[blocks_tested] += tests.block;
    to[blocks_entered] += tests.enter;
    to[blocks_hidden] += tests.block_hidden;
    to[tiles_tested] += tests.tile;
    to[tiles_hidden] += tests.hidden;
  }
};

}  // namespace quadrille::clocked
