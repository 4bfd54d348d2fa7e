// Values at the ends of their range and close together: attributes up to 2^15, all within one code, far from 0; depths
// and limits a code apart. The engines agree, and every value lies where its corners' lie.
#include "model/fast/each_lane_target.hpp"
#include "model/port/snap.hpp"
#include "model/untimed.hpp"

#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace quadrille {
namespace {

using golden::Prng;

constexpr int size = 32;

std::vector<Fragment> draw(const Config& c, const DrawState& s, const SnappedQuad& quad, PixelEngine engine) {
  UntimedModel model(c, s, engine);
  std::vector<Fragment> out;
  model.draw(quad, [&](std::span<const Fragment> some) { out.insert(out.end(), some.begin(), some.end()); });
  return out;
}

/// By the plain engine; the lanes of each target must agree.
std::vector<Fragment> draw_every_way(const Config& c, const DrawState& s, const SnappedQuad& quad) {
  const std::vector<Fragment> plain = draw(c, s, quad, PixelEngine::plain);
  on_each_lane_target([&] { EXPECT_TRUE(draw(c, s, quad, PixelEngine::lanes) == plain); });
  return plain;
}

DrawState square() {
  DrawState s;
  s.width = s.height = s.scissor_x1 = s.scissor_y1 = size;
  s.attributes = 3;
  return s;
}

/// Around the viewport, each corner with its own w.
WindowQuad random_quad(Prng& rng, bool homogeneous) {
  WindowQuad q;
  for (std::size_t i = 0; i < 4; ++i) {
    const double x = (i == 1 || i == 2 ? size : 0) + rng.uniform(-6, 6), y = (i >= 2 ? size : 0) + rng.uniform(-6, 6);
    const double w = homogeneous && i == 3 ? -rng.uniform(0.1, 2) : rng.log2_spread(-2, 2);
    q.vertex[i] = {x * w, y * w, 0.5 * w, w};
  }
  return q;
}

Config with_attributes(int s, int int_bits, int frac_bits) {
  Config c;
  c.significand_bits = s;
  c.attribute_int_bits = int_bits;
  c.attribute_frac_bits = frac_bits;
  c.validate();
  return c;
}

/// Of a spread of n codes every fragment is within n/2^(s-4) and a code of its corners; one of 0 is exact.
TEST(ValueRange, AttributesLieBetweenTheirCorners) {
  Prng rng(21);
  std::uint64_t fragments = 0;
  for (const auto& [s, whole, frac] : {std::array{18, 7, 24},
                                       {18, 7, 18},
                                       {12, 15, 16},
                                       {19, 12, 19},
                                       {18, 15, 24},
                                       {24, 15, 26},
                                       {26, 15, 30},
                                       {8, 1, 30},
                                       {26, 1, 26}}) {
    const Config c = with_attributes(s, whole, frac);
    const double largest = std::ldexp(1.0, whole), code = std::ldexp(1.0, -frac);
    const double last = std::nextafter(largest, 0);
    for (int n = 0; n < 60; ++n) {
      DrawState state = square();
      state.perspective = rng.chance(0.7);
      WindowQuad q = random_quad(rng, false);
      // Slot 0 within some codes of a value, slot 1 a constant, slot 2 from one end to the other.
      const double base =
          rng.chance(0.3) ? rng.sign() * (largest - 3 * code) : rng.uniform(-1, 1) * (largest - 3 * code);
      const double spread = rng.chance(0.5) ? 1 : 2.5, constant = rng.chance(0.3) ? last : rng.uniform(-1, 1) * last;
      for (std::size_t i = 0; i < 4; ++i) {
        const double apart = rng.chance(0.5) ? spread : rng.uniform(0, spread);
        const double end = rng.chance(0.7) ? last : rng.uniform(0, largest);
        q.attribute[i] = {base + (rng.chance(0.5) ? apart : 0) * code, constant, rng.sign() * end};
      }
      const SnappedQuad snapped = snap_quad(q, c, state);
      SCOPED_TRACE("S " + std::to_string(s) + ", " + std::to_string(whole) + " + " + std::to_string(frac) + " bits");
      for (const Fragment& f : draw_every_way(c, state, snapped)) {
        ++fragments;
        for (std::size_t j = 0; j < 3; ++j) {
          const auto corner = [&](std::size_t i) { return q.attribute[i][j] / code; };
          const double low = std::min({corner(0), corner(1), corner(2), corner(3)});
          const double high = std::max({corner(0), corner(1), corner(2), corner(3)});
          const double allowed = std::ldexp(high - low, 4 - s) + 1;
          ASSERT_GE(static_cast<double>(f.attribute[j]), low - allowed) << "slot " << j;
          ASSERT_LE(static_cast<double>(f.attribute[j]), high + allowed) << "slot " << j;
        }
        ASSERT_EQ(f.attribute[1], snapped.base.attribute[1]);
      }
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(fragments, 100'000u);
}

/// Beyond its corners an attribute of a quad around the eye grows without limit: it ends at the largest code, flagged.
TEST(ValueRange, ExtrapolatedAttributesSaturate) {
  Prng rng(22);
  std::uint64_t at_limit = 0;
  for (const auto& [s, whole, frac] : {std::array{18, 7, 24}, {12, 1, 16}, {26, 15, 30}}) {
    const Config c = with_attributes(s, whole, frac);
    for (int n = 0; n < 240; ++n) {
      WindowQuad q = random_quad(rng, true);
      for (auto& a : q.attribute) a = {rng.uniform(-1, 1) * std::ldexp(1.0, whole), 0.25, 0.25};
      DrawState state = square();
      state.perspective = rng.chance(0.5);
      for (const Fragment& f : draw_every_way(c, state, snap_quad(q, c, state))) {
        ASSERT_LE(std::abs(f.attribute[0]), c.attribute_limit());
        const bool flagged = (f.flags & flag_saturated) != 0;
        if (flagged) {
          ASSERT_EQ(std::abs(f.attribute[0]), c.attribute_limit());
        }
        at_limit += flagged;
      }
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(at_limit, 100u);
}

/// Depths within some codes: every fragment lies between its corners, limits that hold them all lose none, and limits a
/// code inside lose those beyond and no other.
TEST(ValueRange, DepthsAndLimitsACodeApart) {
  Prng rng(23);
  std::uint64_t lost = 0, kept = 0;
  for (const auto& [s, depth_bits] : {std::array{18, 24}, {8, 24}, {18, 30}, {26, 30}, {12, 8}, {19, 25}}) {
    Config c;
    c.significand_bits = s;
    c.depth_bits = depth_bits;
    c.validate();
    const std::int32_t one = 1 << depth_bits;
    for (int n = 0; n < 60; ++n) {
      WindowQuad q = random_quad(rng, false);
      const std::int64_t reach = rng.chance(0.3) ? 0 : rng.chance(0.5) ? 2 : 200;
      const std::int64_t from = rng.chance(0.2) ? 0 : rng.chance(0.2) ? one - reach : rng.integer(0, one - reach);
      std::array<std::int64_t, 4> code{};
      for (std::size_t i = 0; i < 4; ++i) {
        code[i] = from + rng.integer(0, reach);
        q.vertex[i].w = std::exp2(std::round(std::log2(q.vertex[i].w)));  // z/w is exactly the code
        q.vertex[i].z = std::ldexp(static_cast<double>(code[i]), -depth_bits) * q.vertex[i].w;
        q.attribute[i] = {0, 0, 0};
      }
      const auto [least, greatest] = std::minmax_element(code.begin(), code.end());
      const auto with_limits = [&, bits = depth_bits](std::int64_t near, std::int64_t far) {
        DrawState state = square();
        state.znear = std::ldexp(static_cast<double>(near), -bits);
        state.zfar = std::ldexp(static_cast<double>(far), -bits);
        return draw_every_way(c, state, snap_quad(q, c, state));
      };
      SCOPED_TRACE("S " + std::to_string(s) + ", " + std::to_string(depth_bits) + " bits of depth");
      const std::vector<Fragment> all = with_limits(0, one);
      for (const Fragment& f : all) {
        ASSERT_GE(f.depth, *least);
        ASSERT_LE(f.depth, *greatest);
      }
      EXPECT_EQ(with_limits(*least, *greatest), all);
      for (const auto& [near, far] : {std::pair{*least + 1, *greatest}, {*least, *greatest - 1}}) {
        if (near > far || near > one || far < 0) continue;
        std::vector<Fragment> inside;
        std::ranges::copy_if(all, std::back_inserter(inside), [&, first = near, last = far](const Fragment& f) {
          return f.depth >= first && f.depth <= last;
        });
        EXPECT_EQ(with_limits(near, far), inside);
        lost += all.size() - inside.size();
        kept += inside.size();
      }
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(lost, 1000u);
  EXPECT_GT(kept, 10'000u);
}

}  // namespace
}  // namespace quadrille
