// The clocked machine, clock by clock: what each of its units has in a clock.
#pragma once

#include "model/clocked.hpp"
#include "model/page/drawing.hpp"
#include "model/support/prng.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace quadrille::page {

class Stepper {
 public:
  /// After reset, with the drawing's quads on offer. Its fragments are those of a draw without attributes.
  explicit Stepper(const Drawing& drawing);

  /// So many clocks, fewer if the machine is done. `stall`: of a hundred clocks those in which nobody takes fragments.
  void run(int clocks, int stall);

  /// The last clock: its number, what bound it, the places of tile, stamp and pixels by unit, and totals.
  std::string json() const;
  /// x | y << 16 of the fragments that left since the call before.
  std::vector<std::uint32_t> take_fragments() { return std::exchange(left_, {}); }

 private:
  struct Place {
    bool any = false;
    int x = 0, y = 0;
  };
  struct Tile {
    int x = 0, y = 0;
  };
  void clock(bool ready);
  void look(const ClockedOutputs& outputs);

  Config config_;
  BareQuads bare_;
  ClockedModel model_;
  golden::Prng prng_;
  std::size_t beats_ = 0;  ///< taken
  std::uint64_t clocks_ = 0, stalled_ = 0, fragments_ = 0;
  bool done_ = false;
  std::vector<std::uint32_t> left_;
  std::vector<Tile> ring_;  ///< tiles by their entry
  std::size_t tiles_ = 0;   ///< so many were entered
  // In the last clock.
  bool vertex_taken_ = false, setup_ = false, stalls_ = false;
  std::size_t setup_quad_ = 0;
  Place tile_, stamp_;  ///< of a tile: its first pixel; of a stamp: the first one of its row
  std::uint32_t stamp_mask_ = 0;
  std::array<std::vector<Place>, 7> lanes_;  ///< by lane: diff, norm, sqrt, ratio, weight, sum, fragment
  std::string bound_;
};

}  // namespace quadrille::page
