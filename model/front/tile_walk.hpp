// Twin of rtl/quadrille_tile_walk.sv: three-valued coverage of a square of pixels, and the serpentine walk over blocks
// and tiles. Linear functions alone are walked; a tile that is hit gets its quadratic ones from tile_context.
//
// The walk is one state machine that both models run: the clocked shell once per clock, the untimed model in a loop. A
// step back subtracts what a step forth adds; forward differences of exact integers are reversible, so no row start is
// kept.
//
// The tiles of a homogeneous quad begin at the screen's. With skip_walk those left of the scissor rectangle and above
// it are left out, in the order of the whole walk.
#pragma once

#include "model/front/inside_expression.hpp"
#include "model/port/stages.hpp"
#include "model/skips/hierarchical_z.hpp"

#include <algorithm>

namespace quadrille {

/// Addition modulo 2^64. Sums of in-range terms can pass through values outside 64 bits when the value at a pixel is
/// composed term by term; two's complement makes the final value right.
inline std::int64_t wrap_add(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

/// Whether a zero of the edge function counts as positive: by the direction of (+ε, +ε²). An all-zero edge has no sign.
inline bool tie_positive(const LinearForm& e) { return e.gx > 0 || (e.gx == 0 && e.gy > 0); }
inline bool tie_negative(const LinearForm& e) { return e.gx < 0 || (e.gx == 0 && e.gy < 0); }

/// What the front needs of a quad; constant while the quad is drawn.
struct QuadConstants {
  std::array<std::int64_t, linear_count> gx{}, gy{};
  bool homogeneous = false;
  std::array<RelativeVertex, 4> vertex{};             ///< SetupResult::vertex
  std::array<std::uint64_t, linear_count> length2{};  ///< SetupResult::length2
  std::array<bool, 5> tie_pos{}, tie_neg{};
  unsigned visible = 0;
  int tile_x0 = 0, tile_y0 = 0, tiles_x = 0, tiles_y = 0, last_row = 0;

  explicit QuadConstants(const SetupResult& s)
      : homogeneous(s.homogeneous),
        vertex(s.vertex),
        length2(s.length2),
        visible(s.visible),
        tile_x0(s.tile_x0),
        tile_y0(s.tile_y0),
        tiles_x(s.tiles_x),
        tiles_y(s.tiles_y),
        last_row(s.last_row) {
    for (std::size_t k = 0; k < linear_count; ++k) {
      gx[k] = s.linear[k].gx;
      gy[k] = s.linear[k].gy;
    }
    for (std::size_t k = 0; k < 5; ++k) {
      tie_pos[k] = tie_positive(s.linear[k]);
      tie_neg[k] = tie_negative(s.linear[k]);
    }
  }
  QuadConstants() = default;
};

/// Values of the linear functions at one pixel.
struct WalkState {
  std::array<std::int64_t, linear_count> linear{};
};

/// False only when no pixel of the extent×extent square at the state's origin can be drawn.
bool may_cover(const WalkState& at, const QuadConstants& quad, int extent, Cull cull);

/// True only when every pixel of that square is drawn but for its depth: of an ordinary quad, whose clauses are all
/// visible.
bool covers(const WalkState& at, const QuadConstants& quad, int extent, Cull cull);

/// Moves the origin by (dx, dy) pixels; exact.
void walk_step(WalkState& at, const QuadConstants& quad, int dx, int dy);

/// A tile, and the linear functions at its origin pixel.
struct TileCorner {
  int tile_x = 0, tile_y = 0;
  std::array<std::int64_t, linear_count> linear{};
};

/// The tiles of a block that the quad's box has.
struct TileBlock {
  int tile_x = 0, tile_y = 0, columns = 0, rows = 0;
};

/// The state machine.
class TileWalk {
 public:
  enum class State { idle, approach, block, tile, end };

  TileWalk() = default;
  TileWalk(const Config& config, const DrawState& state)
      : tile_(config.tile()),
        drop_(config.qdrop()),
        cull_(state.cull),
        reject_(state.skip & skip_tiles),
        scissor_x_((state.skip & skip_walk) != 0 ? state.scissor_x0 >> config.tile_log2 : 0),
        scissor_y_((state.skip & skip_walk) != 0 ? state.scissor_y0 >> config.tile_log2 : 0),
        whole_(config, state) {}

  State state() const { return state_; }
  const QuadConstants& constants() const { return quad_; }

  /// Loads a quad, when the one before has no tile left. With `memory` hidden tiles are left out, and it learns what
  /// the quad hides.
  void take(const SetupResult& setup, HierarchicalZ* memory = nullptr, const DepthInterval& depth = {});
  /// The square under test may be drawn: a BLOCK is entered, a TILE is pushed.
  bool hit() const;
  /// The square under test is left out because nothing of it can be seen.
  bool hidden() const;
  /// Ring entry of the current tile, or the end entry in state END.
  TileEntry entry() const;
  /// The current tile's, without the quadratic functions.
  TileCorner corner() const { return {tile_x(), tile_y(), at_.linear}; }
  /// The block under test, or that of the current tile.
  TileBlock block() const {
    return {quad_.tile_x0 + bx_ * Config::block_tiles, quad_.tile_y0 + by_ * Config::block_tiles,
            tiles_in_block(quad_.tiles_x, bx_), tiles_in_block(quad_.tiles_y, by_)};
  }
  /// One clock's work, once the entry (if any) has been accepted. Never call it for a hit tile or END while the ring is
  /// full.
  void advance();

 private:
  void approach();
  void step_block();
  void move_block(int columns, int rows);
  bool tested() const;
  int tile_x() const { return quad_.tile_x0 + bx_ * Config::block_tiles + tx_; }
  int tile_y() const { return quad_.tile_y0 + by_ * Config::block_tiles + ty_; }
  static int tiles_in_block(int tiles, int block) {
    return std::min(Config::block_tiles, tiles - block * Config::block_tiles);
  }

  int tile_ = 8;
  int drop_ = 0;
  Cull cull_ = Cull::none;
  bool reject_ = true;
  int scissor_x_ = 0, scissor_y_ = 0;  ///< the scissor's first tile
  WholeTiles whole_;
  HierarchicalZ* memory_ = nullptr;
  DepthInterval depth_;
  State state_ = State::idle;
  std::uint32_t slot_ = 0;
  QuadConstants quad_;
  int first_x_ = 0, first_y_ = 0;  ///< the same from the quad's first tile; of an ordinary quad, whose box is inside, 0
  WalkState block_, at_;
  int bx_ = 0, by_ = 0, tx_ = 0, ty_ = 0;
  bool block_right_ = true, tile_right_ = true;
};

}  // namespace quadrille
