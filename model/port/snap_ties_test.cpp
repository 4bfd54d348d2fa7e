// Ties and what lies next to them, nearer than doubles keep apart: what snap_quad makes of each is known from how its
// numbers were made, and again by slow_snap.hpp.
#include "model/port/quick_snap.hpp"
#include "model/port/snap_exact_test_support.hpp"

#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

namespace quadrille {
namespace {

using golden::Prng;

/// Three numbers: a tie, and its neighbours on either side.
std::array<double, 3> around(double tie) { return {tie, std::nextafter(tie, 1e300), std::nextafter(tie, -1e300)}; }

/// Half-way between two places of the grid, and the next doubles; w = 3/4 has a quotient that no double holds.
TEST(SnapTies, OfPositions) {
  const Config c;
  Prng rng(12);
  for (int n = 0; n < 200; ++n) {
    const auto place = static_cast<std::int32_t>(rng.integer(-100'000, 100'000));
    const auto octave = static_cast<int>(rng.integer(-8, 8));
    const double w = std::ldexp(rng.chance(0.5) ? 3 : 5, octave);
    const auto tied = around(w * (0.5 + (place + 0.5) / 256));
    const std::int32_t even = place + (place & 1);
    for (std::size_t side = 0; side < 3; ++side) {
      WindowQuad q = square_of(w);
      q.vertex[1].x = tied[side];
      const std::int32_t expected = side == 0 ? even : side == 1 ? place + 1 : place;
      for (const SnappedQuad& s : in_every_mode(q, c, DrawState())) ASSERT_EQ(s.vertex[1].x >> 7, expected) << place;
      expect_exact(q, c, DrawState(), false);
    }
  }
}

/// x/w is 2^-45 above a tie, less than a quotient in double precision keeps apart.
TEST(SnapTies, AQuotientNextToATie) {
  WindowQuad q = square_of(0x1.d2d2d2d2f7d3fp+0);
  q.vertex[2].x = 0x1.6428ed2d4968ap+9;
  for (const SnappedQuad& s : in_every_mode(q, Config(), DrawState())) EXPECT_EQ(s.vertex[2].x >> 7, 99873);
}

/// Differences half-way between two significands of S bits, and the next doubles.
TEST(SnapTies, OfDifferences) {
  Prng rng(13);
  for (const int s : {8, 18, 22}) {
    Config c;
    c.significand_bits = s;
    for (int n = 0; n < 100; ++n) {
      const std::uint32_t low = 1u << (s - 1),
                          sig = n == 0 ? 2 * low - 1 : static_cast<std::uint32_t>(low + rng.below(low));
      const int exponent = static_cast<int>(rng.integer(-4, 3));
      const double base = 100 * rng.sign(), tie = std::ldexp(sig + 0.5, exponent - (s - 1));
      const auto tied = around(base + tie);
      for (std::size_t side = 0; side < 3; ++side) {
        WindowQuad q = square_of(1);
        q.attribute[0][0] = base;
        q.attribute[2][0] = tied[side];
        const std::uint32_t up = side == 1 || (side == 0 && sig % 2 == 1);
        const bool carry = sig + up == 2 * low;
        for (const SnappedQuad& snapped : in_every_mode(q, c, DrawState())) {
          const PortNumber& d = snapped.vertex[2].attribute[0];
          ASSERT_EQ(d.sig, carry ? low : sig + up);
          ASSERT_EQ(d.exp, exponent + carry);
          ASSERT_FALSE(d.neg);
        }
        expect_exact(q, c, DrawState(), false);
      }
    }
  }
}

/// Doubles of 53 bits whose quotient is next to an integer: multiple / divisor = odd - rest / divisor, exactly.
struct NearQuotient {
  double multiple, divisor;
};
/// `odd` below 2^45, `rest` odd and small.
NearQuotient near_quotient(std::int64_t odd, std::int64_t rest, Prng& rng) {
  const auto low = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(odd)));
  std::uint64_t inverse = 1;  // of odd modulo 2^64, by Newton
  for (int step = 0; step < 6; ++step) inverse *= 2 - static_cast<std::uint64_t>(odd) * inverse;
  const std::uint64_t mask = (std::uint64_t{1} << low) - 1;
  const std::uint64_t divisor = std::uint64_t{1} << 52 | (rng.below(std::uint64_t{1} << 52) & ~mask) |
                                (inverse * static_cast<std::uint64_t>(rest) & mask);
  const __int128 multiple = static_cast<__int128>(odd) * divisor - rest;
  EXPECT_EQ(static_cast<std::uint64_t>(multiple) & mask, 0u);
  return {std::ldexp(static_cast<double>(static_cast<std::int64_t>(multiple >> low)), low),
          static_cast<double>(divisor)};
}

/// Each kind of value 2^-50 to 2^-72 of it beside a tie, less than doubles keep apart.
TEST(SnapTies, NextToTies) {
  Config c;
  Prng rng(15);
  for (int n = 0; n < 150; ++n) {
    c.significand_bits = n % 2 == 0 ? 18 : static_cast<int>(rng.integer(10, 22));
    const int s = c.significand_bits;
    const std::int64_t rest = 2 * rng.integer(-2, 1) + 1;
    const auto rounded = [&](std::int64_t twice) { return rest > 0 ? (twice - 1) / 2 : (twice + 1) / 2; };
    const std::int64_t twice_sig = (std::int64_t{1} << s) + 2 * rng.integer(1, (1 << (s - 1)) - 2) + 1;

    WindowQuad position = square_of(1), depth = square_of(1), difference = square_of(1), deep = square_of(1);
    const std::int64_t twice_place = 2 * rng.integer(0, 100'000) + 1;
    const NearQuotient at = near_quotient(twice_place + 256, rest, rng);  // + 256: half a pixel
    position.vertex[2] = {std::ldexp(at.multiple, -52 - 9), 0, 0, std::ldexp(at.divisor, -52)};

    const std::int64_t twice_code = 2 * rng.integer(1000, (1 << 24) - 1) + 1;
    const NearQuotient z = near_quotient(twice_code, rest, rng);
    for (WindowVertex& v : depth.vertex) v.z = 1;
    depth.vertex[2] = {0, 0, std::ldexp(z.multiple, -52 - 25), std::ldexp(z.divisor, -52)};

    const NearQuotient a = near_quotient(twice_sig, rest, rng);
    difference.vertex[2].w = std::ldexp(a.divisor, -52);
    difference.attribute[2][0] = std::ldexp(a.multiple, -52 - s);

    const std::int64_t base = rng.integer(1, 1 << 22);
    const int below = static_cast<int>(rng.integer(s, 20 + s / 2));
    deep.vertex[0].z = std::ldexp(static_cast<double>(base), -24);
    const NearQuotient over = near_quotient((base << (below - 10)) + twice_sig, rest, rng);  // base and a difference
    deep.vertex[2] = {0, 0, std::ldexp(over.multiple, -52 - 14 - below), std::ldexp(over.divisor, -52)};

    for (const SnappedQuad& q : in_every_mode(position, c, DrawState()))
      ASSERT_EQ(q.vertex[2].x >> 7, rounded(twice_place));
    for (const SnappedQuad& q : in_every_mode(depth, c, DrawState())) ASSERT_EQ(q.base.depth_low, rounded(twice_code));
    for (const SnappedQuad& q : in_every_mode(difference, c, DrawState())) {
      ASSERT_EQ(q.vertex[2].attribute[0].sig, rounded(twice_sig));
      ASSERT_EQ(q.vertex[2].attribute[0].exp, 0);
    }
    for (const SnappedQuad& q : in_every_mode(deep, c, DrawState())) ASSERT_EQ(q.vertex[2].z.sig, rounded(twice_sig));
    for (const WindowQuad* q : {&position, &depth, &difference, &deep}) expect_exact(*q, c, DrawState(), false);
    if (HasFailure()) return;
  }
}

/// The same of k = 1/w: w (2 sig + 1) is next to a power of two.
TEST(SnapTies, KNextToATie) {
  const Config c;
  Prng rng(16);
  int found = 0;
  while (found < 40) {
    const std::int64_t twice_sig = (1 << 18) + 2 * rng.integer(1, (1 << 17) - 2) + 1;
    const __int128 whole = __int128{1} << 71;
    const auto divisor = static_cast<std::int64_t>((whole + twice_sig / 2) / twice_sig);
    const auto rest = static_cast<std::int64_t>(divisor * __int128{twice_sig} - whole);
    if (std::abs(rest) > 40) continue;
    ++found;
    const WindowQuad quad = square_of(std::ldexp(static_cast<double>(divisor), -52));
    for (const SnappedQuad& q : in_every_mode(quad, c, DrawState()))
      ASSERT_EQ(q.vertex[0].k.sig, rest > 0 ? (twice_sig - 1) / 2 : (twice_sig + 1) / 2) << rest;
    expect_exact(quad, c, DrawState(), false);
  }
}

/// Quads of a mesh before the eye are quick; a tie is not.
TEST(SnapTies, OrdinaryQuadsAreQuick) {
  Prng rng(17);
  int quick = 0;
  for (int n = 0; n < 400; ++n) {
    Config c;
    c.significand_bits = static_cast<int>(rng.integer(8, 26));
    c.depth_bits = static_cast<int>(rng.integer(8, 30));
    DrawState state;
    state.perspective = rng.chance(0.8);
    WindowQuad q;
    for (std::size_t i = 0; i < 4; ++i) {
      const double w = rng.log2_spread(-10, 10);
      q.vertex[i] = {w * rng.uniform(-100, 700), w * rng.uniform(-100, 700), w * rng.uniform(-0.1, 1.1), w};
      for (int j = 0; j < 3; ++j) q.attribute[i].push_back(rng.uniform(-1, 1));
    }
    SnappedQuad out;
    quick += quick_snap(q, 3, c, state, out);
    expect_exact(q, c, state);
    if (HasFailure()) return;
  }
  EXPECT_GE(quick, 396);
  WindowQuad tied = square_of(1);
  tied.vertex[1].x = 3 + 0.5 / 256;
  SnappedQuad out;
  EXPECT_FALSE(quick_snap(tied, 1, Config(), DrawState(), out));
}

/// In the last half step of the guard band a vertex is rounded to its end and so is not ordinary.
TEST(SnapTies, TheLastHalfStepIsOutside) {
  for (const double from_end : {0.25 / 256, 0.75 / 256})
    for (const double side : {-1.0, 1.0})
      for (const bool along_x : {false, true}) {
        WindowQuad q = square_of(1);
        (along_x ? q.vertex[2].x : q.vertex[2].y) = side * (0x1p15 - from_end) + 0.5;
        expect_exact(q, Config(), DrawState());
        EXPECT_EQ(has_ordinary_vertices(snap_quad(q, Config(), DrawState()), Config()), from_end * 256 > 0.5);
      }
}

}  // namespace
}  // namespace quadrille
