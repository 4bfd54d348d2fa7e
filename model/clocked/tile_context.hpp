#pragma once

#include "model/front/tile_context.hpp"
#include "model/port/latency.hpp"
#include "model/port/stages.hpp"

#include <array>

namespace quadrille::clocked {

/// The control half of tile_context: a tile's steps, one a clock, and the words on their way to the ring.
struct TileContext {
  int pairs = 1;  ///< of dot units
  bool active = false, homogeneous = false, end = false;
  int step = 0;
  std::array<bool, tile_context_result_clocks> way{};  ///< last steps; the last one makes its entry visible

  int last_step() const { return end ? 1 : tile_context_last_step(homogeneous, pairs); }
  bool ready() const { return !active || step == last_step(); }
  /// The step is a job for the dot units, which then do none of the setup.
  bool issues() const {
    if (!active || step == 0 || end) return false;
    if (!homogeneous) return true;
    return step <= tile_context_last_move(pairs) || step >= tile_context_first_product;
  }

  /// The edge; an entry (or nullptr) comes in, of a homogeneous quad's tile or not.
  void clock(const TileEntry* push, bool push_homogeneous) {
    for (std::size_t n = way.size() - 1; n > 0; --n) way[n] = way[n - 1];
    way[0] = active && step == last_step();
    if (active && step++ == last_step()) active = false;
    if (push != nullptr) {
      active = true;
      homogeneous = push_homogeneous;
      end = push->end;
      step = 0;
    }
  }
};

}  // namespace quadrille::clocked
