// What the tests of pixel pipeline share.
#pragma once

#include "golden/scenes/corner_quads.hpp"
#include "golden/scenes/stress.hpp"
#include "model/clocked.hpp"
#include "model/clocked/clocked_stream_test_support.hpp"
#include "model/fast/each_lane_target.hpp"
#include "model/port/snap.hpp"
#include "model/support/prng.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace quadrille {
namespace {

using golden::Prng;
using Wide = __int128;

struct Result {
  std::vector<Fragment> fragments;
  DrawStats stats;
};

inline Result draw_all(const std::vector<SnappedQuad>& quads, const Config& c, const DrawState& s, PixelEngine engine) {
  UntimedModel model(c, s, engine);
  Result r;
  for (const SnappedQuad& q : quads)
    model.draw(q, [&](std::span<const Fragment> f) { r.fragments.insert(r.fragments.end(), f.begin(), f.end()); });
  r.stats = model.stats();
  return r;
}

inline std::string text(const Fragment& f) {
  std::ostringstream s;
  s << "quad " << f.quad << " (" << f.x << ", " << f.y << ") front " << f.front << " flags " << +f.flags << " depth "
    << f.depth << " attributes";
  for (const std::int64_t a : f.attribute) s << " " << a;
  return s.str();
}

inline void expect_same(const std::vector<Fragment>& a, const std::vector<Fragment>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_EQ(a[i], b[i]) << text(a[i]) << "\n" << text(b[i]);
}

inline void expect_same_stats(const DrawStats& a, const DrawStats& b) {
  const auto list = [](const DrawStats& s) {
    return std::array{s.quads,         s.homogeneous_quads, s.hull_quads, s.blocks_tested, s.tiles_tested,
                      s.tiles_entered, s.stamps_covered,    s.pixels,     s.fragments,     s.on_edge,
                      s.on_vertex,     s.two_corner,        s.two_edge,   s.tie,           s.notch,
                      s.saturated};
  };
  ASSERT_EQ(list(a), list(b));
}

inline std::vector<SnappedQuad> snapped_stress(golden::StressFamily family, std::size_t count, std::uint64_t seed,
                                               int size, int attributes, const Config& c, const DrawState& s) {
  std::vector<SnappedQuad> out;
  for (const WindowQuad& q : golden::make_stress(family, count, seed, 1.0, size, size, attributes)) {
    try {
      out.push_back(snap_quad(q, c, s));
    } catch (const SnapError&) {  // a random attribute may exceed a small attribute_int_bits; the rest is drawn
    }
  }
  return out;
}

inline DrawState square(int size) {
  DrawState s;
  s.width = s.height = s.scissor_x1 = s.scissor_y1 = size;
  return s;
}

/// Any configuration that validate() accepts and a viewport of 64 pixels fits into.
inline Config random_config(Prng& rng) {
  for (;;) {
    Config c;
    c.viewport_bits = static_cast<int>(rng.integer(6, 14));
    if (rng.chance(0.5)) {
      c.guard_bits = static_cast<int>(rng.integer(1, 4));
      c.subpixel_bits = static_cast<int>(rng.integer(2, 8));
      c.homogeneous_frac_bits = static_cast<int>(rng.integer(4, 10));
    }
    c.significand_bits = static_cast<int>(rng.integer(8, 26));
    c.notch_exact = static_cast<int>(rng.below(2));
    c.align_guard_bits = static_cast<int>(rng.below(7));
    c.quadratic_frac_bits = rng.chance(0.5) ? -1 : static_cast<int>(rng.integer(0, 30));
    c.attribute_slots = static_cast<int>(rng.integer(1, 8));
    c.attribute_int_bits = static_cast<int>(rng.integer(1, 15));
    c.depth_bits = static_cast<int>(rng.integer(8, 30));
    c.tile_log2 = static_cast<int>(rng.integer(2, 4));
    if (rng.chance(0.3)) c.attribute_frac_bits = std::max(c.significand_bits, static_cast<int>(rng.integer(8, 30)));
    if (rng.chance(0.3)) c.sqrt_degree = c.recip_degree = 1;
    try {
      c.validate();
      return c;
    } catch (const ConfigError&) {
    }
  }
}

}  // namespace
}  // namespace quadrille
