// The pixel pipeline on vectors of pixels of any quad, in double precision, bit for bit: what single precision
// (float_lanes.hpp) has no room for. Pixels on corners and on two edges are for the plain pipeline.
#pragma once

#include "model/fast/lane_quad.hpp"

namespace quadrille {

/// A quad, or a tile of it where bits of D and r² are dropped: what is dropped then depends on the tile.
struct WideQuad : LaneQuadOf<double> {
  /// value + gx dx + gy dy + q (dx² + dy²).
  struct Form {
    double value = 0, gx = 0, gy = 0, q = 0;
  };

  bool homogeneous = false, hull = false;
  bool w_may_vanish = false;  ///< the sum of W; the depth is then `high`
  std::int32_t marks = 0;     ///< of all its pixels, as in PixelList::marks
  double a_scale = 1;         ///< of A's last place in that of D and r²
  // From the pixel (x0, y0).
  std::array<LinearForm, linear_count> linear{};
  std::array<QuadraticForm, quadratic_count> quadratic{};
  std::array<std::uint64_t, linear_count> length2{};
  // The same where doubles hold every part and sum of them.
  bool in_doubles = false;
  std::array<Form, linear_count> linear_forms;
  std::array<Form, quadratic_count> quadratic_forms;
  std::array<double, linear_count> length2_values{};
};

class WideLanes {
 public:
  explicit WideLanes(const PipelineContext& c);

  void take(const SetupResult& setup, const QuadData& data, const QuadLanes& values, WideQuad& out) const;
  /// Bits are dropped: each tile is a list of its own, from its own origin pixel.
  bool by_tile() const { return by_tile_; }
  void move_to(const TileEntry& tile, WideQuad& quad) const;

  /// As FloatLanes::draw.
  void draw(const WideQuad& quad, const PixelList& list, int count, LaneResults& out) const;

 private:
  LaneFormatOf<double> format_;
  DrawState state_;
  double attribute_limit_, a_scale_;
  int tile_log2_, qdrop_;
  bool by_tile_;
};

}  // namespace quadrille
