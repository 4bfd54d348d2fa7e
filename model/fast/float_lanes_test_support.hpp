// What the tests of float lanes share.
#pragma once

#include "model/fast/each_lane_target.hpp"
#include "model/fast/float_lanes.hpp"
#include "model/front/quad_setup.hpp"
#include "model/support/prng.hpp"
#include "model/untimed.hpp"

#include <array>
#include <cmath>
#include <vector>

namespace quadrille {
namespace {

using golden::Prng;

constexpr int size = 40;

inline DrawState square() {
  DrawState s;
  s.width = s.height = s.scissor_x1 = s.scissor_y1 = size;
  return s;
}

/// Codes that differences of 2^exponent codes and more are added to: 0, about a power of two, or at the end of the
/// range but for some.
inline std::int64_t random_base(Prng& rng, std::int64_t limit) {
  const auto some = static_cast<std::int64_t>(rng.log2_spread(0, 30));
  const std::int64_t magnitude = rng.chance(0.3) ? 0 : rng.chance(0.5) ? some : rng.chance(0.2) ? limit : limit - some;
  return (rng.chance(0.5) ? -1 : 1) * std::clamp<std::int64_t>(magnitude, 0, limit);
}

/// Bases and depth limits: one code, a few, about the whole range, or all of it.
inline QuadBase random_bases(Prng& rng, const Config& c) {
  QuadBase base;
  for (std::size_t j = 0; j < static_cast<std::size_t>(c.attribute_slots); ++j)
    base.attribute[j] = random_base(rng, c.attribute_limit());
  const std::int32_t one = 1 << c.depth_bits;
  base.depth = rng.chance(0.2) ? 0 : rng.chance(0.2) ? one : static_cast<std::uint32_t>(rng.integer(0, one));
  base.depth_high = one + 1;
  if (rng.chance(0.5)) return base;
  const auto reach = static_cast<std::int32_t>(rng.chance(0.3) ? rng.below(3) : rng.below(static_cast<unsigned>(one)));
  const auto at = static_cast<std::int32_t>(base.depth);
  base.depth_low = std::max(-1, at - reach);
  base.depth_high = rng.chance(0.2) ? base.depth_low : std::min(one - at, reach) + at + (rng.chance(0.2) ? 1 : 0);
  return base;
}

/// Corners on pixel centres, on a coarse grid, or anywhere, some far outside; numbers of the port of either sign with
/// exponents up to `exponents`, so that sums cancel, saturate, and are 0. Of vertex 0 the attributes are not looked at.
inline SnappedQuad random_quad(Prng& rng, const Config& c, int exponents) {
  const int s = c.significand_bits;
  const auto number = [&](bool sign) {
    const std::uint32_t low = 1u << (s - 1), ones = 2 * low - 1;
    const std::uint32_t sig = rng.chance(0.3)   ? ones
                              : rng.chance(0.2) ? low
                                                : static_cast<std::uint32_t>(low + rng.below(low));
    return PortNumber{sign && rng.chance(0.5), static_cast<int>(rng.integer(-exponents, exponents)), sig};
  };
  const double grid = rng.chance(0.3) ? 1 : rng.chance(0.3) ? 4 : 256;
  const bool far = rng.chance(0.1), same_k = rng.chance(0.2);
  const PortNumber k = number(false);
  SnappedQuad q;
  q.id = static_cast<std::uint32_t>(rng.below(1u << c.quad_id_bits));
  q.base = random_bases(rng, c);
  std::array<int, max_attribute_slots> signs{};  // 0 one, 1 the other, 2 mixed; 3: a constant
  for (int& sign : signs) sign = static_cast<int>(rng.below(4));
  const int less = rng.chance(0.3) ? static_cast<int>(rng.below(120)) : 0;  // differences may be far below k
  const auto difference = [&](int sign) {
    if (sign == 3 || rng.chance(0.1)) return PortNumber{};
    PortNumber n = number(true);
    if (sign < 2) n.neg = sign != 0;
    n.exp -= less;
    return n;
  };
  const int depth_sign = static_cast<int>(rng.below(4));
  for (SnappedVertex& v : q.vertex) {
    const auto position = [&] {
      const double at = far ? rng.uniform(-20000, 20000) : rng.uniform(-4, size + 4);
      const double step = std::ldexp(1.0, -c.subpixel_bits);
      return static_cast<std::int32_t>(std::floor(at / std::max(step, 1 / grid)) *
                                       std::ldexp(std::max(step, 1 / grid), c.frac()));
    };
    v.x = position();
    v.y = position();
    v.w = 1 << c.frac();
    v.k = same_k ? k : number(false);
    v.z = difference(depth_sign);
    for (std::size_t j = 0; j < static_cast<std::size_t>(c.attribute_slots); ++j)
      v.attribute[j] = &v == q.vertex.data() ? number(true) : difference(signs[j]);
  }
  if (rng.chance(0.1)) {  // a bow tie that crosses at a pixel centre
    const auto x = static_cast<std::int32_t>(rng.below(20)) << c.frac(), edge = std::int32_t{16} << c.frac();
    for (std::size_t i = 0; i < 4; ++i) {
      q.vertex[i].x = x + (i == 1 || i == 2 ? edge : 0);
      q.vertex[i].y = i % 2 == 0 ? 0 : edge;
    }
  }
  return q;
}

inline std::vector<Fragment> draw(UntimedModel& model, const SnappedQuad& quad) {
  std::vector<Fragment> out;
  model.draw(quad, [&](std::span<const Fragment> some) { out.insert(out.end(), some.begin(), some.end()); });
  return out;
}

inline bool taken(const SnappedQuad& quad, const Config& c, const DrawState& s) {
  const PipelineContext context(c, s);
  const FloatLanes lanes(context);
  const SetupResult setup = quad_setup(quad, c, s);
  const QuadData data = quad_data(quad, setup, c, s);
  FloatQuad out;
  return lanes.take(setup, data, QuadLanes(data, context), out);
}

inline std::vector<std::uint64_t> counts(const DrawStats& d) {
  std::vector<std::uint64_t> all{d.blocks_tested, d.tiles_tested,  d.tiles_entered, d.stamps_covered,
                                 d.pixels,        d.fragments,     d.on_edge,       d.on_vertex,
                                 d.two_corner,    d.two_edge,      d.tie,           d.notch,
                                 d.saturated,     d.blocks_hidden, d.tiles_hidden,  d.tiles_masked};
  all.insert(all.end(), d.rejected.begin(), d.rejected.end());
  return all;
}

}  // namespace
}  // namespace quadrille
