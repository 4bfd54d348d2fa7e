// Corner groups about positions: determinants, singular pixels, ends of the ranges.
#include "golden/scenes/corner_batch.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace quadrille::golden {
namespace {

using LatticeQuad = std::array<LatticePoint, 4>;

std::int64_t determinant(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c) {
  return a.x * (b.y * c.w - b.w * c.y) - a.y * (b.x * c.w - b.w * c.x) + a.w * (b.x * c.y - b.y * c.x);
}

int sign(std::int64_t v) { return (v > 0) - (v < 0); }

/// One window z for the whole quad, whatever the signs of w, so that no visible pixel is discarded.
void set_flat_depth(Batch& b, std::array<WindowVertex, 4>& quad) {
  const double z = b.rng.uniform(0.1, 0.9);
  for (WindowVertex& v : quad) v.z = z * v.w;
}

void emit_lattice(Batch& b, const LatticeQuad& lattice, double step) {
  const LatticePoint pixel = b.pixel();
  std::array<WindowVertex, 4> quad;
  for (std::size_t i = 0; i < 4; ++i) quad[i] = vertex_at(pixel, lattice[i], step);
  set_flat_depth(b, quad);
  b.quads.push_back(quad);
}

/// Any lattice point but the origin; w = 0 points have a ratio of x and y that is exact at any scale.
LatticePoint lattice_point(Batch& b) {
  LatticePoint p;
  do {
    p.x = b.integer(-2, 2);
    p.y = b.integer(-2, 2);
    p.w = b.integer(-1, 1);
  } while (p.x == 0 && p.y == 0 && p.w == 0);
  return p;
}

/// A vertex of the given sign of W at (x, y) ends of the guard band, −1 to 1: k is 1, and X, Y, W are exact.
WindowVertex at_limit(const Config& config, double x, double y, double w) {
  const double limit = std::ldexp(1.0, config.pos_int());
  return {limit * x + w / 2, limit * y + w / 2, 0, w};
}

}  // namespace

/// Four vectors of three dimensions have one relation, V0 d_123 − V1 d_023 + V2 d_013 − V3 d_012 = 0, so that exactly
/// one determinant cannot differ from 0; all other 73 combinations of signs exist.
void face_plane(Batch& b) {
  constexpr int quads_each = 2, tries = 20'000;
  for (int pattern = 0; pattern < 81; ++pattern) {
    const std::array<int, 4> wanted{pattern % 3 - 1, pattern / 3 % 3 - 1, pattern / 9 % 3 - 1, pattern / 27 - 1};
    if (std::ranges::count(wanted, 0) == 3) continue;
    int found = 0;
    for (int i = 0; i < tries && found < quads_each; ++i) {
      LatticeQuad q;
      for (LatticePoint& p : q) p = lattice_point(b);
      const std::array<int, 4> signs{sign(determinant(q[0], q[1], q[2])), sign(determinant(q[0], q[2], q[3])),
                                     sign(determinant(q[1], q[2], q[3])), sign(determinant(q[0], q[1], q[3]))};
      if (signs != wanted) continue;
      emit_lattice(b, q, b.integer(1, 4));
      ++found;
    }
  }
}

/// Points (s, w) of a plane with the eye, at s·u around a pixel: every edge function is c_ij = s_i w_j − w_i s_j times
/// one and the same form, so that all decide alike and expression (12) becomes one of the c_ij.
void flat(Batch& b) {
  constexpr std::array<std::array<int, 2>, 4> directions{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
  for (int count = 0; count < 60;) {
    std::array<int, 4> s{}, w{};
    for (std::size_t i = 0; i < 4; ++i) {
      w[i] = b.integer(-2, 2) == 0 ? 0 : b.integer(0, 1) * 2 - 1;
      s[i] = w[i] == 0 ? b.integer(0, 1) * 2 - 1 : b.integer(-2, 2);
    }
    const auto c = [&](std::size_t i, std::size_t j) { return s[i] * w[j] - w[i] * s[j]; };
    const auto covers = [&](int o) {
      return (o * c(2, 0) > 0 && o * c(0, 1) > 0 && o * c(1, 2) > 0 && (o * c(2, 3) > 0 || o * c(3, 0) > 0)) ||
             (o * c(2, 0) < 0 && o * c(2, 3) > 0 && o * c(3, 0) > 0 && (o * c(0, 1) > 0 || o * c(1, 2) > 0));
    };
    if (!covers(1) && !covers(-1)) continue;
    const auto& u = directions[static_cast<std::size_t>(b.integer(0, 3))];
    LatticeQuad q;
    for (std::size_t i = 0; i < 4; ++i) q[i] = {s[i] * u[0], s[i] * u[1], w[i]};
    constexpr std::array<double, 3> steps{1, 0x1p-2, 0x1p-6};  // the small ones for dropped bits of D and r²
    emit_lattice(b, q, steps[b.rng.below(steps.size())]);
    ++count;
  }
}

/// V0 = (L, W0·y, W0) and V1 = (−L, −W1·y, −W1) with W1 = W0 − 1 and L the end of the guard band: every pixel of row y
/// is on edge 01, and sum(M W) there is L (W0 − W1) = L, next to nothing beside the terms L·W0 that cancel. Where S
/// bits hold W0 (odd, FRAC bits) and W1 alike, what is left is 0. Also along columns.
void den_w_zero(Batch& b) {
  const Config& config = b.config;
  const double limit = std::ldexp(1.0, config.pos_int());
  const std::int64_t half = std::int64_t{1} << (config.frac() - 1);
  for (int count = 0; count < 40; ++count) {
    const std::int64_t odd =
        half + 1 + 2 * static_cast<std::int64_t>(b.rng.below(static_cast<std::uint64_t>(half) / 2));
    const double w0 = std::ldexp(static_cast<double>(odd), -config.frac());
    const double w1 = -std::ldexp(static_cast<double>(odd - 1), -config.frac());
    const double row = b.integer(11, 20) + 0.5;
    std::array<WindowVertex, 4> quad;
    quad[0] = {limit + w0 / 2, w0 * row, b.rng.uniform(0.1, 0.9), w0};
    quad[1] = {-limit + w1 / 2, w1 * row, b.rng.uniform(0.1, 0.9), w1};
    const double side = b.rng.sign();
    for (std::size_t i : {2, 3}) {
      const double x = b.integer(0, 31);
      quad[i] = {x, row + side * b.integer(2, 11), b.rng.uniform(0.1, 0.9), 1};
    }
    if (b.rng.chance(0.5)) std::swap(quad[2], quad[3]);
    if (b.rng.chance(0.5)) std::swap(quad[0], quad[1]);
    if (b.rng.chance(0.5))
      for (WindowVertex& v : quad) std::swap(v.x, v.y);
    std::rotate(quad.begin(), quad.begin() + b.integer(0, 3), quad.end());
    b.quads.push_back(quad);
  }
}

/// The machine's r² is floor(value) + dx·floor(gx) + …: below the true one by up to 1 + |dx| + |dy| units. A vertex
/// with W = −1 is not held to the subpixel grid, which makes gx odd in more of its low bits.
void negative_r2(Batch& b) {
  for (int count = 0; count < 60; ++count) {
    const LatticePoint pixel = b.pixel();
    const bool small = count % 3 == 0;  // all corners within a pixel
    std::array<WindowVertex, 4> quad;
    for (WindowVertex& v : quad) {
      const double reach = small ? 0.75 : b.rng.log2_spread(-8, -1);
      const double x = (small ? 0 : b.integer(-12, 11)) + b.rng.uniform(-reach, reach);
      const double y = (small ? 0 : b.integer(-12, 11)) + b.rng.uniform(-reach, reach);
      const double w = count % 2 == 0 ? 1 : b.rng.sign();
      v = {w * (static_cast<double>(pixel.x) + 0.5 + x), w * (static_cast<double>(pixel.y) + 0.5 + y), 0, w};
    }
    set_flat_depth(b, quad);
    b.quads.push_back(quad);
  }
}

void two_corner(Batch& b) {
  for (int count = 0; count < 60; ++count) {
    std::array<WindowVertex, 4> quad = lattice_polygon(b);
    const auto i = static_cast<std::size_t>(b.integer(0, 3));
    const std::size_t j = (i + 1) % 4;
    quad[j] = quad[i];
    for (WindowVertex& v : quad) v.z = b.rng.uniform(0.1, 0.9);
    const auto scale = [&](WindowVertex& v, int exponent) {
      const double w = std::ldexp(1 + b.rng.uniform() / 2, exponent);
      v = {v.x * w, v.y * w, v.z * w, w};
    };
    scale(quad[i], b.integer(-3, 0));
    scale(quad[j], b.integer(1, 3));
    b.quads.push_back(quad);
  }
}

/// At the pixel S_0 = u, S_1 = −c u and S_2 = v, S_3 = −c' v (edges 0 and 2), or S_2 = c'' u (edges 0 and 1), turned to
/// any corner; the signs of W are drawn freely, V_i = (S_i + W_i p, W_i).
void two_edge(Batch& b) {
  const auto direction = [&](int reach) {
    LatticePoint p;
    while (p.x == 0 && p.y == 0) {
      p.x = b.integer(-reach, reach);
      p.y = b.integer(-reach, reach);
    }
    return p;
  };
  const auto times = [](int f, const LatticePoint& p) { return LatticePoint{f * p.x, f * p.y, 0}; };
  for (int count = 0; count < 160; ++count) {
    const LatticePoint u = direction(3);
    LatticeQuad q;
    q[0] = u;
    q[1] = times(b.integer(-3, -1), u);
    if (count % 2 == 0) {
      q[2] = direction(3);
      q[3] = times(b.integer(-3, -1), q[2]);
    } else {
      q[2] = times(b.integer(1, 3), u);
      q[3] = direction(6);
    }
    for (LatticePoint& p : q) p.w = b.integer(0, 1) * 2 - 1;
    std::rotate(q.begin(), q.begin() + b.integer(0, 3), q.end());
    emit_lattice(b, q, 1);
  }
}

void tall(Batch& b) {
  const double bottom = b.state.height - 1, block = 8.0 * b.config.tile();
  const double reach = std::min(b.state.width - 8.0, 2.5 * block);
  for (int count = 0; count < 6; ++count) {
    const double x = b.rng.uniform(1, 4);
    double top = x, low = reach + x;
    if (count % 2 == 1) std::swap(top, low);
    std::array<WindowVertex, 4> quad{
        {{top, 1, 0, 1}, {top + 2, 1, 0, 1}, {low + 2, bottom, 0, 1}, {low, bottom, 0, 1}}};
    if (count >= 4) quad[2] = quad[3] = {std::ldexp(low > top ? 1.0 : -1.0, -2), 1, 0, 0};  // endless
    set_flat_depth(b, quad);
    b.quads.push_back(quad);
  }
}

void burst(Batch& b) {
  for (int count = 0; count < 200; ++count) {
    const LatticePoint pixel = b.pixel();
    const double spread = count % 50 == 0 ? 5 : 0;  // more pixels than the fragment FIFO has places
    const auto corner = [&](int x, int y) {
      const double dx = 0.5 + x * (spread + b.rng.uniform(0.1, 0.4)), dy = 0.5 + y * (spread + b.rng.uniform(0.1, 0.4));
      return WindowVertex{static_cast<double>(pixel.x) + dx, static_cast<double>(pixel.y) + dy, b.rng.uniform(0.1, 0.9),
                          1};
    };
    std::array<WindowVertex, 4> quad;
    quad[0] = corner(-1, -1);
    quad[1] = corner(1, -1);
    quad[2] = corner(1, 1);
    quad[3] = corner(-1, 1);
    if (count % 8 == 7) quad[2] = quad[3] = quad[0];  // nothing is covered
    b.quads.push_back(quad);
  }
}

void extreme(Batch& b) {
  for (int count = 0; count < 40; ++count) {
    std::array<WindowVertex, 4> quad;
    for (WindowVertex& v : quad) {
      const double x = b.rng.sign();
      const double y = b.rng.sign();
      const double least = std::ldexp(1.0, -b.config.frac());  // one unit of W
      const std::array<double, 5> w{1, 1, 0, least, 1 - least};
      v = at_limit(b.config, x, y, b.rng.sign() * w[b.rng.below(w.size())]);
    }
    set_flat_depth(b, quad);
    b.quads.push_back(quad);
  }
}

/// A vertex with W = −1 stands for the point mirrored in the origin, far beyond the upper left: what is visible of its
/// edges runs from their other ends, near the last pixel, away from that point.
void far_corner(Batch& b) {
  const double right = b.state.width - 1, bottom = b.state.height - 1;
  for (int count = 0; count < 12; ++count) {
    std::array<WindowVertex, 4> quad;
    for (WindowVertex& v : quad) {
      const double x = right - b.integer(0, 12);
      v = {x + 0.5, bottom - b.integer(0, 12) + 0.5, 0, 1};
    }
    const auto first = static_cast<std::size_t>(b.integer(0, 3));
    quad[first] = at_limit(b.config, 1, 1, -1);
    if (count % 3 != 0) quad[(first + 1) % 4] = at_limit(b.config, count % 3 == 1 ? 1 : -1, 1 - 0x1p-6, -1);
    set_flat_depth(b, quad);
    b.quads.push_back(quad);
  }
}

}  // namespace quadrille::golden
