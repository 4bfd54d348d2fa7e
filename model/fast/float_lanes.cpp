#include "model/fast/float_lanes.hpp"

#include "model/fast/targets.hpp"
#include "model/fast/toward_zero.hpp"
#include "model/skips/plane_quad.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace quadrille {
namespace {

/// Exponents of the port's numbers that the lanes take, of k and W not below its negative either; lesser differences
/// than the least one count for nothing (float_front.hpp, range).
constexpr int largest_exponent = 30, least_difference = -90;

/// FloatLanes::Format::may_face: all combinations of signs at once.
std::uint64_t may_face() {
  constexpr std::uint64_t bit[6]{0xaaaaaaaaaaaaaaaa, 0xcccccccccccccccc, 0xf0f0f0f0f0f0f0f0,
                                 0xff00ff00ff00ff00, 0xffff0000ffff0000, 0xffffffff00000000};
  SignWords<std::uint64_t> e[5];
  for (std::size_t k = 0; k < 5; ++k) e[k].positive = bit[k];
  e[4].negative = bit[5];
  return inside_expression(e, 0xf, Cull::front).back;
}

/// The largest float that is not above the integer; 0 of a negative one.
float at_most(std::int64_t value) {
  if (value <= 0) return 0;
  const auto v = static_cast<std::uint64_t>(value);
  const int drop = std::max(0, static_cast<int>(std::bit_width(v)) - 24);
  return static_cast<float>(v >> drop << drop);
}

/// Below it a float has no last place above 1.
constexpr std::int64_t single_codes = 1 << 24;

/// False when the base or a limit is no code that a quad can have.
bool float_codes(const FloatLanes::Format& format, const QuadBase& base, FloatQuad& out) {
  const std::int32_t one = std::int32_t{1} << format.depth_bits;
  if (format.depth) {
    if (base.depth > static_cast<std::uint32_t>(one) || base.depth_low < -1 || base.depth_high > one + 1) return false;
    out.depth = {static_cast<std::int32_t>(base.depth), base.depth_low, base.depth_high, at_most(single_codes)};
  }
  const std::int64_t limit = (std::int64_t{1} << (format.attribute_int_bits + format.attribute_frac)) - 1;
  for (std::size_t j = 0; j < static_cast<std::size_t>(format.attributes); ++j) {
    const std::int64_t of = base.attribute[j], room = limit - std::abs(of);
    if (room < 0) return false;
    out.attribute[j] = {static_cast<std::int32_t>(of), static_cast<std::int32_t>(-limit),
                        static_cast<std::int32_t>(limit), at_most(std::min(room, single_codes))};
  }
  return true;
}

constexpr int most_words = PixelList::widest / 64;  ///< of a tile

/// Rows and columns of a tile, from .. to - 1.
struct Range {
  int from, to;
};

/// What there is once for each target.
struct Functions {
  using Format = FloatLanes::Format;
  using Counts = FloatLanes::TileCounts;

  Counts (*cover)(const Format&, const PixelBounds&, const TileCorner&, const QuadConstants&, MaskedDepth*, PixelList&);
  void (*draw)(const LaneFormatOf<float>&, const FloatQuad&, const PixelList&, int, LaneResults&);
  PlaceSigns place_signs;
  // From v3 on.
  std::optional<QuadReject> (*take_small)(const Format&, const DepthLimits&, const SnappedQuad&, FloatQuad&,
                                          SmallQuad&);
  void (*walk_small)(const Format&, const SmallQuad&, SmallWalk&);
  Counts (*cover_narrow)(const Format&, const PixelBounds&, const std::array<std::int32_t, 5>&, int, int,
                         const NarrowEdges&, MaskedDepth*, PixelList&);
};

// Each function of the kernel is compiled for the target around it.
namespace baseline {
#include "model/fast/float_portable.hpp"

#include "model/fast/float_cover.hpp"

#include "model/fast/float_front.hpp"

#include "model/fast/kernel.hpp"
constexpr Functions functions{cover, draw, plain_place_signs, nullptr, nullptr, nullptr};
}  // namespace baseline
#ifdef QUADRILLE_LANE_TARGETS
QUADRILLE_TARGET_V2
namespace v2 {
#include "model/fast/float_portable.hpp"

#include "model/fast/float_cover.hpp"

#include "model/fast/float_front.hpp"

#include "model/fast/kernel.hpp"
constexpr Functions functions{cover, draw, plain_place_signs, nullptr, nullptr, nullptr};
}  // namespace v2
QUADRILLE_TARGET_END
QUADRILLE_TARGET_V3
namespace v3 {
#include "model/fast/float_avx2.hpp"

#include "model/fast/edge_signs_avx2.hpp"

#include "model/fast/float_cover.hpp"

#include "model/fast/float_front.hpp"

#include "model/fast/kernel.hpp"

#include "model/fast/float_small_quad.hpp"
constexpr Functions functions{cover, draw, place_signs, take_small, walk_small, cover_narrow};
}  // namespace v3
QUADRILLE_TARGET_END
QUADRILLE_TARGET_V4
namespace v4 {
#include "model/fast/float_avx512.hpp"

#include "model/fast/edge_signs_avx2.hpp"

#include "model/fast/float_cover.hpp"

#include "model/fast/float_front.hpp"

#include "model/fast/kernel.hpp"

#include "model/fast/float_small_quad.hpp"
constexpr Functions functions{cover, draw, place_signs, take_small, walk_small, cover_narrow};
}  // namespace v4
QUADRILLE_TARGET_END
#endif

const Functions& functions() {
  /// By LaneTarget.
  static constexpr const Functions* of_target[]{
      &baseline::functions,
#ifdef QUADRILLE_LANE_TARGETS
      &v2::functions,
      &v3::functions,
      &v4::functions,
#endif
  };
  return *of_target[static_cast<std::size_t>(lane_target())];
}

/// Whether the integers of kernel.hpp's polynomials() stay exact with 2^23 added.
bool fits(const Table& table) {
  return std::ranges::all_of(table.entries, [](const TableEntry& e) {
    return std::max({e.c0, e.c1, e.c2}) < 1u << 23;
  });
}

/// False when an exponent is out of range.
bool float_column(std::array<double, 4> values, int prec, FloatColumnOf what, LaneColumnOf<float>& out) {
  const bool differences = what != FloatColumnOf::weight;
  for (double& v : values) {
    if (v == 0) continue;
    const int exponent = std::ilogb(v);
    if (differences && exponent < least_difference)
      v = 0;
    else if (exponent > largest_exponent || (!differences && exponent < -largest_exponent))
      return false;
  }
  out = LaneColumnOf<float>(values, prec);
  return true;
}

/// FloatQuad::least_sum (float_front.hpp, range), of the columns in use.
float least_sum(const FloatQuad& quad, const LaneFormatOf<float>& format) {
  float largest = 0;
  const auto add = [&](bool used, const LaneColumnOf<float>& column) {
    if (used)
      for (const float align : column.align) largest = std::max(largest, align);
  };
  add(quad.sum_k, quad.k);
  add(quad.sum_w && !quad.w_of_k, quad.w);
  add(quad.sum_z, quad.z);
  for (std::size_t j = 0; j < static_cast<std::size_t>(format.attributes); ++j) add(quad.sum_b[j], quad.b[j]);
  // `align` is 2^(e + 23 - prec).
  return std::max(largest * static_cast<float>(power_of_two(format.prec - 23 - 65)), 0x1p-72f);
}

bool fits(const QuadLanes::Factor& factor) {
  return !factor || *factor == 0 || std::abs(std::ilogb(*factor)) <= largest_exponent;
}

}  // namespace

FloatLanes::FloatLanes(const PipelineContext& c)
    : config_(c.config), state_(c.state), depth_limits_(c.config, c.state) {
  const Config& config = c.config;
  static_cast<LaneFormatOf<float>&>(format_) = LaneFormatOf<float>(c);
  format_.attribute_int_bits = config.attribute_int_bits;
  format_.tile_log2 = config.tile_log2;
  format_.scissor_x0 = c.state.scissor_x0;
  format_.scissor_y0 = c.state.scissor_y0;
  format_.scissor_x1 = c.state.scissor_x1;
  format_.scissor_y1 = c.state.scissor_y1;
  format_.cull = c.state.cull;
  format_.perspective = c.state.perspective;
  format_.frac = frac_ = config.frac();
  format_.homogeneous_frac_bits = config.homogeneous_frac_bits;
  format_.subpixel_bits = config.subpixel_bits;
  val_bits_ = config.val_bits();
  qdrop_ = config.qdrop();
  // The last condition: exponents are as odd in pixels as in units of the last place.
  fits_ = c.format.s + c.format.g <= 20 && config.attribute_int_bits + c.attribute_frac <= 31 && fits(c.sqrt_table) &&
          fits(c.recip_table) && config.quadratic_frac() % 2 == 0;
#ifdef __wasm__
  fits_ = false;  // these lanes need a unit that rounds toward zero
#endif
  if (!fits_) return;
  // Where everything has its place in a double and nothing is dropped of D, whatever the positions on their grid.
  small_ = val_bits_ - 2 * config.homogeneous_frac_bits <= 53 && qdrop_ <= 2 * config.homogeneous_frac_bits &&
           config.tile_log2 == SmallQuad::tile_log2 && (c.state.skip & skip_tiles) != 0 &&
           (c.state.skip & skip_quads) != 0;
  format_.may_face = may_face();
}

bool FloatLanes::take(const SetupResult& setup, const QuadData& data, const QuadLanes& values, FloatQuad& out) const {
  if (!fits_ || setup.homogeneous) return false;
  // All positions are multiples of 2^low: products of two have 2 low bits of zeros, enough for a double to hold A, r²
  // and two of the latter's sum, and for nothing to be dropped of D.
  std::uint64_t positions = 0;
  std::int64_t left = setup.vertex[0].x, right = left, top = setup.vertex[0].y, bottom = top;
  for (const RelativeVertex& v : setup.vertex) {
    positions |= static_cast<std::uint64_t>(v.x) | static_cast<std::uint64_t>(v.y);
    left = std::min(left, v.x);
    right = std::max(right, v.x);
    top = std::min(top, v.y);
    bottom = std::max(bottom, v.y);
  }
  const auto extent = static_cast<std::uint64_t>(std::max(right - left, bottom - top));
  const int low = std::min(frac_, std::countr_zero(positions));
  if (val_bits_ - 2 * low > 53 || 2 * low < qdrop_) return false;

  // Less than 1 wide, and exponents of products as float_front.hpp's upper_halves wants them.
  const int scale = -(1023 - 127) / 2 - static_cast<int>(std::bit_width(extent));
  const double last_place2 = power_of_two(2 * scale), of_pixel = power_of_two(2 * scale + frac_);
  const double of_length2 = power_of_two(2 * scale + qdrop_);
  for (std::size_t k = 0; k < linear_count; ++k) {
    const LinearForm& e = setup.linear[k];
    out.a.value[k] = static_cast<double>(e.value) * last_place2;
    out.a.gx[k] = static_cast<double>(e.gx) * last_place2;
    out.a.gy[k] = static_cast<double>(e.gy) * last_place2;
    out.length2[k] = static_cast<double>(setup.length2[k]) * of_length2;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const auto [x, y, w] = setup.vertex[i];
    out.r2.value[i] = static_cast<double>(x * x + y * y) * last_place2;
    out.r2.gx[i] = static_cast<double>(-2 * x) * of_pixel;
    out.r2.gy[i] = static_cast<double>(-2 * y) * of_pixel;
  }
  out.unit2 = power_of_two(2 * (scale + frac_));
  out.areas = data.plane;
  out.x0 = setup.tile_x0 << format_.tile_log2;
  out.y0 = setup.tile_y0 << format_.tile_log2;
  const auto first = [&](std::int64_t v) { return static_cast<int>(-(-v >> frac_)); };  // ceil
  const auto last = [&](std::int64_t v) { return static_cast<int>(v >> frac_); };       // floor
  out.left = std::max(first(left), format_.scissor_x0 - out.x0);
  out.right = std::min(last(right), format_.scissor_x1 - 1 - out.x0);
  out.top = std::max(first(top), format_.scissor_y0 - out.y0);
  out.bottom = std::min(last(bottom), format_.scissor_y1 - 1 - out.y0);

  out.sum_k = values.sum_k;
  out.sum_w = values.sum_w;
  out.w_of_k = values.w_of_k;
  using Of = FloatColumnOf;
  const auto column = [&](bool wanted, const std::array<double, 4>& v, Of what, LaneColumnOf<float>& to) {
    return !wanted || float_column(v, format_.prec, what, to);
  };
  bool fit = float_codes(format_, data.base, out) && fits(values.w_of_k) &&
             column(values.sum_k, values.k, Of::weight, out.k) &&
             column(values.sum_w && !values.w_of_k, values.w, Of::weight, out.w) &&
             column(values.sum_z, values.z, Of::depth, out.z);
  out.sum_z = values.sum_z && out.z.any;
  for (std::size_t j = 0; j < static_cast<std::size_t>(format_.attributes); ++j) {
    fit = fit && column(values.sum_b[j], values.b[j], Of::attribute, out.b[j]);
    out.sum_b[j] = values.sum_b[j] && out.b[j].any;
  }
  out.least_sum = least_sum(out, format_);
  return fit;
}

NarrowEdges::NarrowEdges(const SetupResult& setup) : visible(setup.visible), fit(true) {
  for (std::size_t k = 0; k < 5; ++k) {
    const LinearForm& e = setup.linear[k];
    const int shift = std::countr_zero(static_cast<std::uint64_t>(e.value | e.gx | e.gy) | std::uint64_t{1} << 63);
    low[k] = static_cast<std::uint8_t>(shift);
    constexpr int most = limit >> (tile_log2 + 1);
    fit = fit && std::abs(e.gx >> shift) < most && std::abs(e.gy >> shift) < most;
    gx[k] = static_cast<std::int32_t>(e.gx >> shift);
    gy[k] = static_cast<std::int32_t>(e.gy >> shift);
    tie_positive[k] = quadrille::tie_positive(e) ? ~std::uint64_t{0} : 0;
    tie_negative[k] = quadrille::tie_negative(e) ? ~std::uint64_t{0} : 0;
  }
}

NarrowEdges FloatLanes::edges(const SetupResult& setup) const {
  const bool possible = functions().cover_narrow != nullptr && format_.tile_log2 == NarrowEdges::tile_log2;
  return possible ? NarrowEdges(setup) : NarrowEdges();
}

FloatLanes::TileCounts FloatLanes::cover(const PixelBounds& bounds, const TileCorner& corner, const QuadConstants& quad,
                                         const NarrowEdges& edges, MaskedDepth* masked, PixelList& list) const {
  if (!edges.fit) return functions().cover(format_, bounds, corner, quad, masked, list);
  std::array<std::int32_t, 5> value;
  for (std::size_t k = 0; k < 5; ++k) {
    const std::int64_t limit = NarrowEdges::limit;  // beyond it a function has one sign in the tile
    value[k] = static_cast<std::int32_t>(std::clamp(corner.linear[k] >> edges.low[k], -limit, limit));
  }
  return functions().cover_narrow(format_, bounds, value, (corner.tile_x << NarrowEdges::tile_log2) - bounds.x0,
                                  (corner.tile_y << NarrowEdges::tile_log2) - bounds.y0, edges, masked, list);
}

std::uint64_t FloatLanes::place_signs(std::int64_t value, std::int64_t right, std::int64_t down, int rows) {
  return functions().place_signs(value, right, down, rows);
}

bool FloatLanes::small() const { return small_ && functions().take_small != nullptr; }

std::optional<QuadReject> FloatLanes::take_small(const SnappedQuad& quad, FloatQuad& out, SmallQuad& small) const {
  const auto taken = functions().take_small(format_, depth_limits_, quad, out, small);
  if (taken == QuadReject::none) {
    out.areas = plane_quad(quad, config_, state_);
    out.least_sum = least_sum(out, format_);
  }
  return taken;
}

void FloatLanes::walk_small(const SmallQuad& quad, SmallWalk& out) const { functions().walk_small(format_, quad, out); }

FloatLanes::TileCounts FloatLanes::cover_small(const PixelBounds& bounds, const SmallQuad& quad, SmallWalk::Tile tile,
                                               MaskedDepth* masked, PixelList& list) const {
  const int x0 = tile.x << SmallQuad::tile_log2, y0 = tile.y << SmallQuad::tile_log2;
  std::array<std::int32_t, 5> value;
  for (std::size_t k = 0; k < 5; ++k) value[k] = quad.value[k] + x0 * quad.gx[k] + y0 * quad.gy[k];
  return functions().cover_narrow(format_, bounds, value, x0, y0, quad, masked, list);
}

void FloatLanes::draw(const FloatQuad& quad, const PixelList& list, int count, LaneResults& out) const {
  out.begin();
  const TowardZero mode;
  functions().draw(format_, quad, list, count, out);
}

}  // namespace quadrille
