// What the tests of coverage share.
#pragma once

#include "model/port/boundaries.hpp"
#include "model/support/prng.hpp"

#include <algorithm>

namespace quadrille {
namespace {

using golden::Prng;
using Wide = __int128;

constexpr std::size_t edges[6][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {2, 0}, {1, 3}};

/// S_i = V_i - W_i p.
struct Relative {
  Wide x[4], y[4];
  Relative(const SnappedQuad& q, int px, int py) {
    for (std::size_t i = 0; i < 4; ++i) {
      x[i] = q.vertex[i].x - static_cast<Wide>(q.vertex[i].w) * px;
      y[i] = q.vertex[i].y - static_cast<Wide>(q.vertex[i].w) * py;
    }
  }
  Wide cross(std::size_t i, std::size_t j) const { return x[i] * y[j] - y[i] * x[j]; }
  Wide dot(std::size_t i, std::size_t j) const { return x[i] * x[j] + y[i] * y[j]; }
};

inline int sign(Wide v) { return (v > 0) - (v < 0); }

inline Wide det(const SnappedQuad& q, std::size_t a, std::size_t b, std::size_t c) {
  const auto& A = q.vertex[a];
  const auto& B = q.vertex[b];
  const auto& C = q.vertex[c];
  return static_cast<Wide>(A.x) * (static_cast<Wide>(B.y) * C.w - static_cast<Wide>(B.w) * C.y) +
         static_cast<Wide>(A.y) * (static_cast<Wide>(B.w) * C.x - static_cast<Wide>(B.x) * C.w) +
         static_cast<Wide>(A.w) * (static_cast<Wide>(B.x) * C.y - static_cast<Wide>(B.y) * C.x);
}

inline bool hull_of(const SnappedQuad& q) {
  const int s[4] = {sign(det(q, 1, 2, 3)), -sign(det(q, 0, 2, 3)), sign(det(q, 0, 1, 3)), -sign(det(q, 0, 1, 2))};
  return !(std::ranges::count(s, 1) > 0 && std::ranges::count(s, -1) > 0);
}

inline bool homogeneous(const SnappedQuad& q, const Config& c) {
  return std::ranges::any_of(q.vertex, [&](const SnappedVertex& v) { return v.w != 1 << c.frac(); });
}

enum class Kind { ordinary, grid, collapsed, sliver, homogeneous, small_integers, antipodal, mixed, kinds };

inline SnappedQuad random_quad(Prng& rng, Kind kind, const Config& c) {
  SnappedQuad q;
  const int one = 1 << c.frac(), span = 1 << c.viewport_bits;
  const std::int64_t limit = std::int64_t{1} << (c.pos_int() + c.frac());
  const auto px = [&](double v) {
    return static_cast<std::int32_t>(std::floor(v * (1 << c.subpixel_bits))) * (1 << c.homogeneous_frac_bits);
  };
  const auto ordinary = [&](SnappedVertex& v, double reach) {
    v = {px(rng.uniform(-reach, span + reach)), px(rng.uniform(-reach, span + reach)), one, {}, {}, {}};
  };
  const auto full = [&](SnappedVertex& v) {
    do {
      // Mostly a point near the viewport scaled by W, sometimes anything.
      v.w = static_cast<std::int32_t>(rng.chance(0.15) ? 0 : rng.integer(-one, one));
      if (rng.chance(0.5)) {
        v.x = static_cast<std::int32_t>(rng.integer(-span, 2 * span) * v.w + rng.integer(-one, one));
        v.y = static_cast<std::int32_t>(rng.integer(-span, 2 * span) * v.w + rng.integer(-one, one));
      } else {
        v.x = static_cast<std::int32_t>(rng.integer(-limit, limit) >> rng.below(12));
        v.y = static_cast<std::int32_t>(rng.integer(-limit, limit) >> rng.below(12));
      }
      if (rng.chance(0.05)) v.x = static_cast<std::int32_t>(rng.chance(0.5) ? limit : -limit);
      if (rng.chance(0.05)) v.y = static_cast<std::int32_t>(rng.chance(0.5) ? limit : -limit);
      v.x = static_cast<std::int32_t>(std::clamp<std::int64_t>(v.x, -limit, limit));
      v.y = static_cast<std::int32_t>(std::clamp<std::int64_t>(v.y, -limit, limit));
    } while (v.x == 0 && v.y == 0 && v.w == 0);
  };
  for (SnappedVertex& v : q.vertex) {
    switch (kind) {
      case Kind::ordinary:
      case Kind::collapsed:
      case Kind::sliver:
        ordinary(v, rng.chance(0.2) ? ((1 << c.guard_bits) - 1.0) * span : span / 4.0);
        break;
      case Kind::grid:
        v = {static_cast<std::int32_t>(rng.integer(-4, span + 4)) * one,
             static_cast<std::int32_t>(rng.integer(-4, span + 4)) * one,
             one,
             {},
             {},
             {}};
        break;
      case Kind::small_integers:
        do {
          v.w = static_cast<std::int32_t>(rng.integer(-1, 1)) * one;
          v.x = static_cast<std::int32_t>(rng.integer(-8, 8)) * one;
          v.y = static_cast<std::int32_t>(rng.integer(-8, 8)) * one;
        } while (v.x == 0 && v.y == 0 && v.w == 0);
        break;
      case Kind::mixed:
        if (rng.chance(0.7)) {
          ordinary(v, span / 2.0);
          break;
        }
        full(v);
        break;
      default:
        full(v);
    }
  }
  if (kind == Kind::collapsed) q.vertex[rng.below(4)] = q.vertex[rng.below(4)];
  if (kind == Kind::sliver) {
    const std::size_t i = rng.below(4);
    q.vertex[i] = q.vertex[(i + 1) & 3];
    q.vertex[i].y += 1 << c.homogeneous_frac_bits;
  }
  if (kind == Kind::antipodal) {
    const std::size_t i = rng.below(4);
    q.vertex[i] = q.vertex[(i + 1) & 3];
    q.vertex[i].x = -q.vertex[i].x, q.vertex[i].y = -q.vertex[i].y, q.vertex[i].w = -q.vertex[i].w;
  }
  return q;
}

inline DrawState state_of(const Config& c) {
  DrawState s;
  s.width = s.height = s.scissor_x1 = s.scissor_y1 = 1 << c.viewport_bits;
  return s;
}

/// A value of `width` bits, signed.
inline bool fits(std::int64_t v, int width) {
  return width >= 64 || (v >= -(std::int64_t{1} << (width - 1)) && v < std::int64_t{1} << (width - 1));
}

/// A field of a boundary holds the value.
template <class T>
bool holds(const FieldType& type, T value) {
  const auto v = static_cast<std::int64_t>(value);
  if (type.is_signed) return fits(v, type.width);
  return type.width == 64 || static_cast<std::uint64_t>(v) >> type.width == 0;
}

}  // namespace
}  // namespace quadrille
