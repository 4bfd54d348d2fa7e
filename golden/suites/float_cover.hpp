// Coverage, visibility and singular classes from the integers of a quad, in long double: undecided where that cannot
// tell. Of the float engine alone.
#pragma once

#include "golden/suites/float_judge.hpp"
#include "model/records.hpp"
#include "model/stages.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace quadrille::vectors::floating {

// ---- Coverage ----

/// Expression (12) at one pixel from the five edge functions and their steps: 0 decides by the direction of (+eps,
/// +eps^2); an all-zero function has no sign.
struct PixelCover {
  bool decided = true, covered = false, front = false, tie = false;
};

inline PixelCover cover(const std::array<IntegerSum, 5>& e, const std::array<std::int64_t, 5>& gx,
                        const std::array<std::int64_t, 5>& gy, unsigned visible, Cull cull) {
  PixelCover out;
  std::array<int, 5> sign{};
  for (std::size_t k = 0; k < 5; ++k) {
    out.decided = out.decided && e[k].decided();
    sign[k] = e[k].sign();
    if (sign[k] != 0) continue;
    const std::int64_t by_tie = gx[k] != 0 ? gx[k] : gy[k];
    sign[k] = (by_tie > 0) - (by_tie < 0);
    out.tie = out.tie || sign[k] != 0;
  }
  const auto clause = [&](int o, unsigned first, unsigned second) {
    const bool one = sign[4] == o && sign[0] == o && sign[1] == o && (sign[2] == o || sign[3] == o);
    const bool two = sign[4] == -o && sign[2] == o && sign[3] == o && (sign[0] == o || sign[1] == o);
    return (one && (visible & first)) || (two && (visible & second));
  };
  const bool back = clause(1, 1, 2) && cull != Cull::back;
  out.front = clause(-1, 4, 8) && cull != Cull::front;
  out.covered = back || out.front;
  out.tie = out.tie && out.covered;
  return out;
}

/// The quad's edge functions and their steps at a pixel, from the integers of its vertices.
struct PixelEdges {
  std::array<Real, 4> sx{}, sy{};
  std::array<IntegerSum, 5> e{};
  std::array<std::int64_t, 5> gx{}, gy{};

  PixelEdges(const SnappedQuad& quad, int x, int y) {
    for (std::size_t i = 0; i < 4; ++i) {
      const SnappedVertex& v = quad.vertex[i];
      sx[i] = static_cast<Real>(v.x) - static_cast<Real>(v.w) * x;
      sy[i] = static_cast<Real>(v.y) - static_cast<Real>(v.w) * y;
    }
    for (std::size_t n = 0; n < 5; ++n) {
      const auto [i, j] = vertex_pair[n];
      const SnappedVertex &p = quad.vertex[i], &q = quad.vertex[j];
      e[n].add(sx[i] * sy[j]);
      e[n].add(-sy[i] * sx[j]);
      gx[n] = std::int64_t{p.y} * q.w - std::int64_t{p.w} * q.y;
      gy[n] = std::int64_t{p.w} * q.x - std::int64_t{p.x} * q.w;
    }
  }
};

/// Which clauses may be drawn and whether the eye is in the hull: signs of the determinants of three vertices.
struct Visibility {
  bool decided = true, hull = false;
  unsigned visible = 15;
};

inline Visibility visibility(const SnappedQuad& quad, const Config& config) {
  Visibility out;
  bool ordinary = true;
  for (const SnappedVertex& v : quad.vertex) ordinary = ordinary && v.w == 1 << config.frac();
  if (ordinary) return out;
  // A factor that a coordinate of all vertices has in common does not change a sign, but what Real must hold.
  std::array<std::array<Real, 4>, 3> c{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::uint32_t bits = 0;
    const auto coordinate = [&](std::size_t i) {
      const SnappedVertex& v = quad.vertex[i];
      return axis == 0 ? v.x : axis == 1 ? v.y : v.w;
    };
    for (std::size_t i = 0; i < 4; ++i) bits |= static_cast<std::uint32_t>(coordinate(i));
    const int common = bits == 0 ? 0 : std::countr_zero(bits);
    for (std::size_t i = 0; i < 4; ++i) c[axis][i] = ldexpl(static_cast<Real>(coordinate(i)), -common);
  }
  const auto determinant = [&](std::size_t i, std::size_t j, std::size_t k) {
    IntegerSum sum;
    sum.add(c[0][i] * c[1][j] * c[2][k]);
    sum.add(c[1][i] * c[2][j] * c[0][k]);
    sum.add(c[2][i] * c[0][j] * c[1][k]);
    sum.add(-(c[2][i] * c[1][j] * c[0][k]));
    sum.add(-(c[0][i] * c[2][j] * c[1][k]));
    sum.add(-(c[1][i] * c[0][j] * c[2][k]));
    out.decided = out.decided && sum.decided();
    return sum.sign();
  };
  const int d012 = determinant(0, 1, 2), d023 = determinant(0, 2, 3), d123 = determinant(1, 2, 3),
            d013 = determinant(0, 1, 3);
  const std::array<int, 4> signs{d123, -d023, d013, -d012};
  out.hull = std::ranges::none_of(signs, [](int v) { return v > 0; }) ||
             std::ranges::none_of(signs, [](int v) { return v < 0; });
  if (!out.hull)
    out.visible = (d012 > 0 ? 1u : 0u) | (d023 > 0 ? 2u : 0u) | (d012 < 0 ? 4u : 0u) | (d023 < 0 ? 8u : 0u);
  return out;
}

/// Flags that a pixel's exact integers give, rtl/SPEC.md, fragment_output.
struct SingularClass {
  int corners = 0, edges = 0;
  std::array<bool, 4> corner{}, edge{};

  bool two_corner() const { return corners > 1; }
  bool on_vertex() const { return corners == 1; }
  bool two_edge() const { return corners == 0 && edges > 1; }
  bool on_edge() const { return corners == 0 && edges == 1; }
};

template <class Corner, class Edge>
inline SingularClass singular_class(Corner&& at_corner, Edge&& on_edge) {
  SingularClass out;
  for (std::size_t i = 0; i < 4; ++i) {
    out.corners += out.corner[i] = at_corner(i);
    out.edges += out.edge[i] = on_edge(i);
  }
  return out;
}

}  // namespace quadrille::vectors::floating
