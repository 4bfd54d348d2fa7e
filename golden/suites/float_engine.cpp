#include "golden/suites/float_engine.hpp"

#include "golden/io/error.hpp"
#include "golden/reference/port_number.hpp"
#include "golden/suites/table_suite.hpp"
#include "model/support/parallel.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <optional>
#include <string>

namespace quadrille::vectors {
namespace {

using Real = long double;
static_assert(std::numeric_limits<Real>::digits >= 64, "64-bit integers must fit a long double");

/// Relative rounding of a few operations in Real: 2^-64 each.
constexpr Real rounding = 0x1p-60L;

const VectorOutcome undefined{VectorOutcome::Kind::undefined, {}, false};

// ---- Verdicts ----

/// Collects what the fields of one vector say; the first difference counts.
class Judge {
 public:
  void same(const char* name, int index, Real actual, Real expected) {
    within(name, index, actual, expected, expected);
  }

  void within(const char* name, int index, Real actual, Real lowest, Real highest) {
    compared_ = true;
    if (!(actual >= lowest && actual <= highest)) differs(name, index, actual, lowest, highest);
  }

  void differs(const char* name, int index, Real actual, Real lowest, Real highest) {
    char text[200];
    const std::string label = index < 0 ? name : std::string(name) + "[" + std::to_string(index) + "]";
    if (lowest == highest)
      std::snprintf(text, sizeof text, "%s: expected %.12Lg, actual %.12Lg", label.c_str(), lowest, actual);
    else
      std::snprintf(text, sizeof text, "%s: expected %.12Lg to %.12Lg, actual %.12Lg", label.c_str(), lowest, highest,
                    actual);
    differs(text);
  }
  void differs(std::string text) {
    if (difference_.empty()) difference_ = std::move(text);
  }

  void undecided() { undecided_ = true; }

  VectorOutcome outcome() const {
    if (!difference_.empty()) return {VectorOutcome::Kind::mismatch, difference_};
    return {undecided_ ? VectorOutcome::Kind::undefined : VectorOutcome::Kind::match, {}, compared_ || !undecided_};
  }

 private:
  std::string difference_;
  bool undecided_ = false, compared_ = false;
};

// ---- Significand numbers ----

/// Fp or PortNumber.
template <class Number>
Real value_of(const Number& v, int s) {
  const Real magnitude = ldexpl(static_cast<Real>(v.sig), v.exp - (s - 1));
  return v.neg ? -magnitude : magnitude;
}

/// Where a real number lies.
struct Span {
  Real lo = 0, hi = 0;
};

Span exactly(Real v) { return {v, v}; }
Span operator+(Span a, Span b) { return {a.lo + b.lo, a.hi + b.hi}; }
/// Of magnitudes.
Span operator*(Span a, Span b) { return {a.lo * b.lo, a.hi * b.hi}; }
Span magnitude(Span v) {
  if (v.lo >= 0) return v;
  if (v.hi <= 0) return {-v.hi, -v.lo};
  return {0, std::max(-v.lo, v.hi)};
}

/// What a configuration loses where, rtl/README.md section 2.
struct Losses {
  explicit Losses(const Config& c)
      : s(c.significand_bits), unit(ldexpl(1, -(s - 1))), grain(ldexpl(1, -c.prec_bits())) {
    // A polynomial through Chebyshev points misses by f^(n)/n! · 2 (h/4)^n, n = degree + 1, h the width of a segment;
    // of 1/x and x^(-1/2), relative to them, that is largest at x = 1.
    const Real h_recip = ldexpl(1, -c.recip_segments()), h_rsqrt = ldexpl(1, -c.rsqrt_segments());
    reciprocal = unit + (c.recip_degree == 2 ? h_recip * h_recip * h_recip / 32 : h_recip * h_recip / 8);
    rsqrt = unit + (c.rsqrt_degree == 2 ? 5 * h_rsqrt * h_rsqrt * h_rsqrt / 512 : 3 * h_rsqrt * h_rsqrt / 64);
  }

  int s;
  Real unit;               ///< u = 2^-(s-1): a truncation to S bits leaves (1 - u, 1] of the value
  Real grain;              ///< of the largest term: a term of an aligned sum loses less than that
  Real reciprocal, rsqrt;  ///< relative errors: u, and what the polynomial of a segment misses

  /// Truncated toward zero to S bits.
  Span cut(Span v) const { return {v.lo > 0 ? v.lo * (1 - unit) : v.lo, v.hi < 0 ? v.hi * (1 - unit) : v.hi}; }

  /// A sum of exact terms, aligned and truncated: every term loses magnitude, so positive ones pull down, negative ones
  /// up. The largest exponent is never above that of the largest term.
  template <std::size_t Count>
  Span sum(const std::array<Real, Count>& terms) const {
    Real total = 0, largest = 0, size = 0;
    for (const Real t : terms) total += t, size += fabsl(t), largest = std::max(largest, fabsl(t));
    Span v{total - rounding * size, total + rounding * size};
    for (const Real t : terms) (t > 0 ? v.lo : v.hi) += (t > 0 ? -1 : t < 0 ? 1 : 0) * grain * largest;
    return cut(v);
  }
};

/// The number must be normalised (or zero with all fields 0) and in the span, but for Real's own rounding.
template <class Number>
void check_number(Judge& judge, const char* name, int index, const Number& actual, Span expected, const Losses& l) {
  const Real v = value_of(actual, l.s);
  if (actual.sig == 0 ? actual.neg || actual.exp != 0 : actual.sig >> (l.s - 1) != 1)
    return judge.differs(std::string(name) + (index < 0 ? "" : "[" + std::to_string(index) + "]") +
                         ": not a normalised number");
  const Real lo = expected.lo - rounding * fabsl(expected.lo), hi = expected.hi + rounding * fabsl(expected.hi);
  judge.within(name, index, v, lo, hi);
}

// ---- Integers ----

/// A sum of integers, evaluated in Real: exact where all of it stays below 2^63.
struct IntegerSum {
  Real value = 0, size = 0;

  void add(Real term) {
    value += term;
    size += fabsl(term);
  }
  Real tolerance() const { return size < 0x1p63L ? 0 : size * rounding; }
  bool decided() const { return value == 0 ? tolerance() == 0 : fabsl(value) > tolerance(); }
  int sign() const { return (value > 0) - (value < 0); }
};

void check_integer(Judge& judge, const char* name, int index, Real actual, const IntegerSum& expected) {
  judge.within(name, index, actual, expected.value - expected.tolerance(), expected.value + expected.tolerance());
}

/// The same after an arithmetic shift right.
void check_shifted(Judge& judge, const char* name, int index, Real actual, const IntegerSum& expected, int drop) {
  judge.within(name, index, actual, floorl(ldexpl(expected.value - expected.tolerance(), -drop)),
               floorl(ldexpl(expected.value + expected.tolerance(), -drop)));
}

// ---- Coverage ----

/// Expression (12) at one pixel from the five edge functions and their steps: 0 decides by the direction of (+eps,
/// +eps^2); an all-zero function has no sign.
struct PixelCover {
  bool decided = true, covered = false, front = false, tie = false;
};

PixelCover cover(const std::array<IntegerSum, 5>& e, const std::array<std::int64_t, 5>& gx,
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

Visibility visibility(const SnappedQuad& quad, const Config& config) {
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

// ---- Stages: one function each ----

/// Stimulus and response of one vector.
struct Vector {
  const StageData& in;
  const StageData& out;
  const Config& config;
  const Losses& losses;
};

/// An ordinary vertex is its window position on the subpixel grid, to nearest: half a step. Others are scaled by k =
/// 1/max(|x|/2^pos_int, |y|/2^pos_int, |w|) and rounded on the 2^-frac grid. Real's x - w/2 is off by 2^-64 of its
/// terms. k, Z, b are rounded to nearest: half of u.
void snapping(Judge& judge, const Vector& t) {
  const Config& c = t.config;
  const WindowVertex& v = t.in.vertex;
  const auto slots = static_cast<std::size_t>(c.attribute_slots);
  const double extent_given = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.w)});
  bool refused = !std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z) || !std::isfinite(v.w) ||
                 !(extent_given <= 0x1p80) || !(extent_given >= 0x1p-80) || !(std::fabs(v.z) <= 0x1p80);
  for (std::size_t j = 0; j < slots; ++j)
    refused = refused || !(std::fabs(t.in.attribute[j]) < std::ldexp(1.0, c.attribute_int_bits));
  const SnappedVertex& p = t.out.snapped;
  const auto check_refused = [&] {
    judge.same("refused", -1, t.out.refused, 1);
    judge.undecided();
  };
  if (refused) return check_refused();

  const Real w = v.w, x = static_cast<Real>(v.x) - w / 2, y = static_cast<Real>(v.y) - w / 2;
  const Real error = rounding * (std::max(fabsl(v.x), fabsl(v.y)) + fabsl(w));  // of x and y, generously
  const Real extent = std::max({ldexpl(fabsl(x), -c.pos_int()), ldexpl(fabsl(y), -c.pos_int()), fabsl(w)});
  if (extent == 0) return check_refused();
  bool ordinary = false;
  if (w > 0) {
    // Rounding decides on which side of the guard band a position in its last half step is.
    const Real reach = std::max(fabsl(x), fabsl(y)) / w, edge = ldexpl(1, c.pos_int());
    const Real last = edge - ldexpl(1, -c.subpixel_bits - 1), doubt = error / w;
    if (fabsl(reach - last) <= doubt) return judge.undecided();
    ordinary = reach < last;
  }
  const Real k = ordinary ? 1 / w : 1 / extent;
  const int fraction = ordinary ? c.subpixel_bits : c.frac();

  // Products with k that the port cannot hold are refused, those below its exponents are zero.
  const Real half = ldexpl(1, -c.significand_bits) * (1 + rounding) + rounding;
  const auto too_large = ldexpl(1, 1 << (Config::port_exp_bits - 1)), too_small = 1 / too_large;
  const Real scale = t.in.state.perspective ? k : ldexpl(static_cast<Real>(p.w), -c.frac());
  std::array<Real, max_attribute_slots> b{};
  Real largest = std::max(k, fabsl(k * static_cast<Real>(v.z)));
  for (std::size_t j = 0; j < slots; ++j) {
    b[j] = scale * static_cast<Real>(t.in.attribute[j]);
    largest = std::max(largest, fabsl(b[j]));
  }
  if (largest * (1 + 2 * half) >= too_large) {
    if (largest >= too_large) return check_refused();
    return judge.undecided();
  }
  judge.same("refused", -1, t.out.refused, 0);
  if (t.out.refused) return;

  const auto position = [&](const char* name, std::int32_t actual, Real exact, Real doubt) {
    const Real step = ldexpl(1, -fraction), value = ldexpl(static_cast<Real>(actual), -c.frac());
    const Real tolerance = step / 2 + doubt + rounding * fabsl(exact);
    judge.within(name, -1, value, exact - tolerance, exact + tolerance);
    if (ordinary && actual % (1 << c.homogeneous_frac_bits) != 0)
      judge.differs(std::string(name) + ": not on the grid of an ordinary vertex");
  };
  position("x", p.x, k * x, k * error);
  position("y", p.y, k * y, k * error);
  if (ordinary)
    judge.same("w", -1, p.w, ldexpl(1, c.frac()));
  else
    position("w", p.w, k * w, k * error);
  const auto number = [&](const char* name, int index, const PortNumber& actual, Real exact) {
    const Real tolerance = (half + k * error * (ordinary ? 0 : 1)) * fabsl(exact);
    Span span{exact - tolerance, exact + tolerance};
    if (fabsl(exact) * (1 - half) < too_small) {
      // Zero, or what rounds up to the smallest exponent.
      if (fabsl(exact) * (1 + half) < too_small) span = {};
      span = {std::min(span.lo, 0.0L), std::max(span.hi, 0.0L)};
    }
    check_number(judge, name, index, actual, span, t.losses);
  };
  number("k_sig", -1, p.k, k);
  number("z_sig", -1, p.z, k * static_cast<Real>(v.z));
  for (std::size_t j = 0; j < slots; ++j) number("attr_sig", static_cast<int>(j), p.attribute[j], b[j]);
}

/// Exact integers; visibility by the signs of determinants.
void setup(Judge& judge, const Vector& t) {
  const Config& c = t.config;
  const DrawState& state = t.in.state;
  const SetupResult& r = t.out.setup;
  const auto& v = t.in.quad.vertex;
  const std::int32_t one = 1 << c.frac();
  const bool homogeneous = std::ranges::any_of(v, [&](const SnappedVertex& a) { return a.w != one; });
  judge.same("slot", -1, r.slot, 0);
  judge.same("homogeneous", -1, r.homogeneous, homogeneous);

  // Pixels [lo, hi] in x and y, then tiles.
  struct Interval {
    Real lo, hi;
  };
  const auto pixels = [&](auto coordinate, int first, int end) -> Interval {
    if (homogeneous) return {first < end ? 0.0L : 1.0L, first < end ? static_cast<Real>(end) - 1 : 0.0L};
    const auto [least, most] = std::ranges::minmax(v, {}, coordinate);
    return {std::max(ceill(static_cast<Real>(least.*coordinate) / one), static_cast<Real>(first)),
            std::min(floorl(static_cast<Real>(most.*coordinate) / one), static_cast<Real>(end) - 1)};
  };
  const Interval x = pixels(&SnappedVertex::x, state.scissor_x0, state.scissor_x1);
  const Interval y = pixels(&SnappedVertex::y, state.scissor_y0, state.scissor_y1);
  const bool empty = x.lo > x.hi || y.lo > y.hi;
  const auto first = [&](Interval i) { return empty ? 0 : floorl(i.lo / c.tile()); };
  const auto count = [&](Interval i) { return empty ? 0 : floorl(i.hi / c.tile()) - first(i) + 1; };
  judge.same("tile_x0", -1, r.tile_x0, first(x));
  judge.same("tile_y0", -1, r.tile_y0, first(y));
  judge.same("tiles_x", -1, r.tiles_x, count(x));
  judge.same("tiles_y", -1, r.tiles_y, count(y));

  const Visibility seen = visibility(t.in.quad, c);
  if (seen.decided) {
    judge.same("hull", -1, r.hull, seen.hull);
    judge.same("visible", -1, r.visible, seen.visible);
  } else {
    judge.undecided();
  }

  // Relative to the origin pixel.
  std::array<Real, 4> tx{}, ty{}, w{};
  for (std::size_t i = 0; i < 4; ++i) {
    w[i] = static_cast<Real>(v[i].w);
    tx[i] = static_cast<Real>(v[i].x) - w[i] * first(x) * c.tile();
    ty[i] = static_cast<Real>(v[i].y) - w[i] * first(y) * c.tile();
  }
  const auto two = [](Real a, Real b) {
    IntegerSum sum;
    sum.add(a);
    sum.add(b);
    return sum;
  };
  for (std::size_t n = 0; n < linear_count; ++n) {
    const auto [i, j] = vertex_pair[n];
    const int index = static_cast<int>(n);
    const auto& f = r.linear[n];
    check_integer(judge, "lin_value", index, static_cast<Real>(f.value), two(tx[i] * ty[j], -ty[i] * tx[j]));
    check_integer(judge, "lin_gx", index, static_cast<Real>(f.gx), two(ty[i] * w[j], -w[i] * ty[j]));
    check_integer(judge, "lin_gy", index, static_cast<Real>(f.gy), two(w[i] * tx[j], -tx[i] * w[j]));
  }
  for (std::size_t n = 0; n < quadratic_count; ++n) {
    const std::size_t i = n < 6 ? vertex_pair[n][0] : n - 6, j = n < 6 ? vertex_pair[n][1] : n - 6;
    const int index = static_cast<int>(n), drop = c.qdrop();
    const auto& f = r.quadratic[n];
    check_shifted(judge, "quad_value", index, static_cast<Real>(f.value), two(tx[i] * tx[j], ty[i] * ty[j]), drop);
    check_shifted(judge, "quad_gx", index, static_cast<Real>(f.gx), two(-tx[i] * w[j], -w[i] * tx[j]), drop);
    check_shifted(judge, "quad_gy", index, static_cast<Real>(f.gy), two(-ty[i] * w[j], -w[i] * ty[j]), drop);
    check_shifted(judge, "quad_q", index, static_cast<Real>(f.q), two(w[i] * w[j], 0), drop);
  }
}

/// Signs of exact integers; a pixel is left out where Real cannot tell one.
void coverage(Judge& judge, const Vector& t) {
  const Config& c = t.config;
  const DrawState& state = t.in.state;
  const TileEntry& tile = t.in.tile;
  std::array<std::int64_t, 5> gx{}, gy{};
  std::copy_n(t.in.constants.gx.begin(), 5, gx.begin());
  std::copy_n(t.in.constants.gy.begin(), 5, gy.begin());
  for (int row = 0; row < c.tile(); ++row)
    for (int dx = 0; dx < c.tile(); ++dx) {
      std::array<IntegerSum, 5> e{};
      for (std::size_t k = 0; k < 5; ++k) {
        e[k].add(static_cast<Real>(tile.linear[k]));
        e[k].add(static_cast<Real>(gx[k]) * dx);
        e[k].add(static_cast<Real>(gy[k]) * row);
      }
      const int x = tile.tile_x * c.tile() + dx, y = tile.tile_y * c.tile() + row;
      PixelCover pixel;
      if (x >= state.scissor_x0 && x < state.scissor_x1 && y >= state.scissor_y0 && y < state.scissor_y1)
        pixel = cover(e, gx, gy, t.in.constants.visible, state.cull);
      if (!pixel.decided) {
        judge.undecided();
        continue;
      }
      const StampMasks& masks = t.out.row_masks[static_cast<std::size_t>(row)];
      judge.same("mask", row, masks.mask >> dx & 1, pixel.covered);
      judge.same("front", row, masks.front >> dx & 1, pixel.front);
      judge.same("tie", row, masks.tie >> dx & 1, pixel.tie);
    }
}

/// Exact integers.
void forward_differences(Judge& judge, const Vector& t) {
  const TileEntry& tile = t.in.tile;
  const Real dx = t.in.dx, row = t.in.row;
  for (std::size_t k = 0; k < linear_count; ++k) {
    IntegerSum sum;
    sum.add(static_cast<Real>(tile.linear[k]));
    sum.add(static_cast<Real>(t.in.constants.gx[k]) * dx);
    sum.add(static_cast<Real>(t.in.constants.gy[k]) * row);
    check_integer(judge, "a", static_cast<int>(k), static_cast<Real>(t.out.pixel.a[k]), sum);
  }
  for (std::size_t k = 0; k < quadratic_count; ++k) {
    IntegerSum sum;
    sum.add(static_cast<Real>(tile.quadratic[k].value));
    sum.add(static_cast<Real>(tile.quadratic[k].gx) * dx);
    sum.add(static_cast<Real>(tile.quadratic[k].gy) * row);
    sum.add(static_cast<Real>(t.in.constants.q[k]) * (dx * dx + row * row));
    if (k < 6)
      check_integer(judge, "d", static_cast<int>(k), static_cast<Real>(t.out.pixel.d[k]), sum);
    else
      check_integer(judge, "r2", static_cast<int>(k) - 6, static_cast<Real>(t.out.pixel.r2[k - 6]), sum);
  }
}

/// Flags that a pixel's exact integers give, rtl/README.md section 5.
struct SingularClass {
  int corners = 0, edges = 0;
  std::array<bool, 4> corner{}, edge{};

  bool two_corner() const { return corners > 1; }
  bool on_vertex() const { return corners == 1; }
  bool two_edge() const { return corners == 0 && edges > 1; }
  bool on_edge() const { return corners == 0 && edges == 1; }
};

template <class Corner, class Edge>
SingularClass singular_class(Corner&& at_corner, Edge&& on_edge) {
  SingularClass out;
  for (std::size_t i = 0; i < 4; ++i) {
    out.corners += out.corner[i] = at_corner(i);
    out.edges += out.edge[i] = on_edge(i);
  }
  return out;
}

/// One truncation: (1 - u, 1] of the integer.
void normalised(Judge& judge, const Vector& t) {
  const PixelTrace &in = t.in.pixel, &out = t.out.pixel;
  const SingularClass is = singular_class([&](std::size_t i) { return in.r2[i] <= 0; },
                                          [&](std::size_t i) { return in.a[i] == 0 && in.d[i] < 0; });
  judge.same("two_corner", -1, out.two_corner, is.two_corner());
  judge.same("on_vertex", -1, out.on_vertex, is.on_vertex());
  judge.same("two_edge", -1, out.two_edge, is.two_edge());
  judge.same("on_edge", -1, out.on_edge, is.on_edge());
  const auto check = [&](const char* name, std::size_t i, const Fp& actual, Real exact) {
    check_number(judge, name, static_cast<int>(i), actual, t.losses.cut(exactly(exact)), t.losses);
  };
  for (std::size_t i = 0; i < 6; ++i) {
    check("a_sig", i, out.a_fp[i], ldexpl(static_cast<Real>(in.a[i]), -t.config.qdrop()));
    check("d_sig", i, out.d_fp[i], static_cast<Real>(in.d[i]));
  }
  for (std::size_t i = 0; i < 4; ++i)
    check("r2_sig", i, out.r2_fp[i], static_cast<Real>(std::max<std::int64_t>(in.r2[i], 0)));
}

/// Relative error u, and the table's polynomial (Losses).
void rsqrts(Judge& judge, const Vector& t) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Real r2 = value_of(t.in.pixel.r2_fp[i], t.losses.s), exact = r2 == 0 ? 0 : 1 / sqrtl(r2);
    check_number(judge, "sig", static_cast<int>(i), t.out.pixel.rho[i],
                 {exact * (1 - t.losses.rsqrt), exact * (1 + t.losses.rsqrt)}, t.losses);
  }
}

void reciprocals(Judge& judge, const Vector& t) {
  const Real v = value_of(t.in.number, t.losses.s), exact = v == 0 ? 0 : 1 / v,
             tolerance = t.losses.reciprocal * fabsl(exact);
  check_number(judge, "sig", -1, t.out.inverse, {exact - tolerance, exact + tolerance}, t.losses);
}

/// t = n/d by the half-angle formulas: v = |A| rho rho loses two truncations, 2u; u' = 1 + |D| rho rho one of rho rho,
/// one grain of the alignment (1 is exact in it) and one of the sum, at most 3u with no guard bits. All toward zero.
void ratios(Judge& judge, const Vector& t) {
  const Losses& l = t.losses;
  const PixelTrace &in = t.in.pixel, &out = t.out.pixel;
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [i, j] = vertex_pair[k];
    const Span scale = l.cut(exactly(value_of(in.rho[i], l.s) * value_of(in.rho[j], l.s)));
    const Span v = l.cut(exactly(fabsl(value_of(in.a_fp[k], l.s))) * scale);
    const Span term = exactly(fabsl(value_of(in.d_fp[k], l.s))) * scale;
    const Real grain = term.hi > 0 ? l.grain * std::max(1.0L, term.hi) : 0;
    const Span u = l.cut({1 + term.lo - grain, 1 + term.hi});
    const bool swapped = in.d_fp[k].neg;
    check_number(judge, "n_sig", static_cast<int>(k), out.n[k], swapped ? u : v, l);
    check_number(judge, "d_sig", static_cast<int>(k), out.dn[k], swapped ? v : u, l);
  }
}

/// rtl/README.md section 5. Truncations of N, e, h, M, with the cure of f and g as well: below 6u and two grains of N's
/// alignment, at most 8u, all toward zero. Sums with terms of both signs (an edge whose k differ in sign, NOTCH_EXACT =
/// 0) are off by a grain of their largest term to either side. Corners are exact.
void weights(Judge& judge, const Vector& t) {
  const Losses& l = t.losses;
  const PixelTrace& in = t.in.pixel;
  const SingularClass is = singular_class([&](std::size_t i) { return t.in.corner[i]; },
                                          [&](std::size_t i) { return t.in.a_sign[i] == 0 && t.in.d_negative[i]; });
  std::array<Real, 6> n{}, d{};
  std::array<Real, 4> rho{}, k{};
  for (std::size_t i = 0; i < 6; ++i) n[i] = value_of(in.n[i], l.s), d[i] = value_of(in.dn[i], l.s);
  for (std::size_t i = 0; i < 4; ++i) rho[i] = value_of(in.rho[i], l.s), k[i] = value_of(t.in.data.k[i], l.s);

  std::array<Span, 4> m{};
  if (is.corners > 0) {
    std::array<std::size_t, 2> at{};
    for (std::size_t i = 0, found = 0; i < 4; ++i)
      if (is.corner[i] && found < 2) at[found++] = i;
    if (is.two_corner())
      m[at[0]] = exactly(fabsl(k[at[1]])), m[at[1]] = exactly(fabsl(k[at[0]]));
    else
      m[at[0]] = exactly(1);
  } else if (is.two_edge()) {
    // The mean of the interpolations along the two lowest edges: each vertex takes the other edge's denominator.
    std::array<std::size_t, 2> at{};
    for (std::size_t i = 0, found = 0; i < 4; ++i)
      if (is.edge[i] && found < 2) at[found++] = i;
    const auto denominator = [&](std::size_t e) {
      return magnitude(l.sum(std::array{rho[e] * k[e], rho[(e + 1) % 4] * k[(e + 1) % 4]}));
    };
    const Span a = denominator(at[0]), b = denominator(at[1]);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto on = [&](std::size_t e) { return i == e || i == (e + 1) % 4; };
      Span sum = a + b;
      const Real grains = 2 * l.grain * std::max(a.hi, b.hi);
      sum = l.cut({std::max(0.0L, sum.lo - grains), sum.hi});
      const Span factor = on(at[0]) && on(at[1]) ? sum : on(at[0]) ? b : on(at[1]) ? a : Span{};
      m[i] = l.cut(factor * exactly(rho[i]));
    }
  } else {
    std::array<bool, 4> differ{};
    for (std::size_t i = 0; i < 4; ++i) differ[i] = t.in.a_sign[(i + 3) % 4] * t.in.a_sign[i] < 0;
    const bool cured = t.config.notch_exact && std::ranges::any_of(differ, [](bool v) { return v; });
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t before = (i + 3) % 4;
      const Span sum = cured && differ[i]
                           ? l.sum(std::array{n[before] * n[i], d[before] * d[i]})
                           : l.sum(std::array{n[before] * d[i], (differ[i] ? -1 : 1) * n[i] * d[before]});
      const Span e = l.cut(exactly(d[(i + 1) % 4] * d[(i + 2) % 4]));
      Span g = exactly(rho[i]);
      if (cured) {
        const Real f = !differ[i] ? d[5] * d[4] : i % 2 == 0 ? n[5] * d[4] : n[4] * d[5];
        g = l.cut(g * l.cut(exactly(f)));
      }
      m[i] = l.cut(l.cut(magnitude(sum) * e) * g);
    }
  }
  for (std::size_t i = 0; i < 4; ++i) check_number(judge, "sig", static_cast<int>(i), t.out.pixel.m[i], m[i], l);
}

/// Four exact products: at most four grains of the largest and one truncation, 5u with no guard bits.
void interpolation(Judge& judge, const Vector& t) {
  const Losses& l = t.losses;
  const PixelTrace& out = t.out.pixel;
  const QuadData& q = t.in.data;
  const auto check = [&](const char* name, int index, const Fp& actual, auto&& factor) {
    std::array<Real, 4> terms{};
    for (std::size_t i = 0; i < 4; ++i) terms[i] = value_of(t.in.pixel.m[i], l.s) * value_of(factor(i), l.s);
    check_number(judge, name, index, actual, l.sum(terms), l);
  };
  for (std::size_t j = 0; j < static_cast<std::size_t>(t.config.attribute_slots); ++j)
    check("attr_sig", static_cast<int>(j), out.num_a[j], [&](std::size_t i) { return q.b[i][j]; });
  check("z_sig", -1, out.num_z, [&](std::size_t i) { return q.z[i]; });
  check("den_k_sig", -1, out.den_k, [&](std::size_t i) { return q.k[i]; });
  check("den_w_sig", -1, out.den_w, [&](std::size_t i) { return q.w[i]; });
}

/// Codes that |num/den| may have with `fraction` fraction bits below 2^integer, den != 0: the reciprocal's relative
/// error, then truncation.
Span quotient_codes(Real num, Real den, int integer, int fraction, const Losses& l) {
  const Real q = fabsl(num / den), top = ldexpl(1, integer + fraction) - 1;
  const auto code = [&](Real v) { return std::min(top, floorl(ldexpl(v, fraction))); };
  return {code(q * (1 - l.reciprocal - rounding)), code(q * (1 + l.reciprocal + rounding))};
}

void depth(Judge& judge, const Vector& t) {
  const Config& c = t.config;
  const Losses& l = t.losses;
  const PixelTrace &in = t.in.pixel, &out = t.out.pixel;
  const DrawState& state = t.in.state;
  const Real num_z = value_of(in.num_z, l.s), den_k = value_of(in.den_k, l.s), den_w = value_of(in.den_w, l.s);

  // Codes of a drawn pixel's depth.
  Span codes;
  bool may_draw = !(t.in.data.hull && !(den_w > 0)), must_draw = may_draw;
  if (state.depth) {
    const Real infinite = ldexpl(2, c.depth_bits) - 1;
    codes = den_w == 0 ? exactly(infinite) : quotient_codes(num_z, den_w, 1, c.depth_bits, l);
    Span limits{static_cast<Real>(t.in.znear), static_cast<Real>(t.in.zfar)};
    if (den_w != 0 && num_z * den_w < 0) limits.hi = std::min(limits.hi, 0.0L);
    must_draw = must_draw && codes.lo >= limits.lo && codes.hi <= limits.hi;
    codes = {std::max(codes.lo, limits.lo), std::min(codes.hi, limits.hi)};
    may_draw = may_draw && codes.lo <= codes.hi;
  }
  if (may_draw == must_draw) judge.same("valid", -1, out.drawn, may_draw);
  if (may_draw != must_draw) judge.undecided();
  const Fragment& g = out.fragment;
  if (!out.drawn) {
    judge.same("saturated", -1, g.flags, 0);
    judge.same("depth", -1, g.depth, 0);
    for (std::size_t j = 0; j < static_cast<std::size_t>(c.attribute_slots); ++j)
      judge.same("attr", static_cast<int>(j), static_cast<Real>(g.attribute[j]), 0);
    return;
  }
  judge.within("depth", -1, g.depth, codes.lo, codes.hi);
  bool may_saturate = false, must_saturate = false;
  for (int j = 0; j < c.attribute_slots; ++j) {
    const Real actual = static_cast<Real>(g.attribute[static_cast<std::size_t>(j)]);
    if (j >= state.attributes) {
      judge.same("attr", j, actual, 0);
      continue;
    }
    if (den_k == 0) {
      may_saturate = true;
      judge.undecided();
      continue;
    }
    const Real num = value_of(in.num_a[static_cast<std::size_t>(j)], l.s);
    const Span q = quotient_codes(num, den_k, c.attribute_int_bits, c.attribute_frac(), l);
    judge.within("attr", j, num * den_k < 0 ? -actual : actual, q.lo, q.hi);
    const Real size = fabsl(num / den_k), limit = ldexpl(1, c.attribute_int_bits);
    may_saturate = may_saturate || size * (1 + l.reciprocal + rounding) >= limit;
    must_saturate = must_saturate || size * (1 - l.reciprocal - rounding) >= limit;
  }
  if (may_saturate != must_saturate)
    judge.undecided();
  else
    judge.same("saturated", -1, g.flags, may_saturate);
}

using StageCheck = void (*)(Judge&, const Vector&);

StageCheck find_stage(std::string_view suite) {
  static const std::map<std::string_view, StageCheck> stages{
      {"snapping", snapping},
      {"setup", setup},
      {"coverage", coverage},
      {"forward_difference", forward_differences},
      {"normalise", normalised},
      {"rsqrt", rsqrts},
      {"reciprocal", reciprocals},
      {"ratios", ratios},
      {"weights", weights},
      {"interpolation", interpolation},
      {"depth", depth},
  };
  const auto found = stages.find(suite);
  if (found == stages.end()) throw golden::InputError("the float engine does not know suite " + std::string(suite));
  return found->second;
}

VectorOutcome check_stage(StageCheck check, const Stage& stage, const Losses& losses, const Record& stimulus,
                          const Record& response) {
  StageData in, out;
  stage.unpack_stimulus(stimulus, in);
  stage.unpack_response(response, out);
  Judge judge;
  check(judge, {in, out, stage.config(), losses});
  return judge.outcome();
}

// ---- Tables ----

/// Relative error of a segment's polynomial (Losses), at places from one end of it to the other.
VectorOutcome check_table(bool rsqrt, const Losses& l, const Table& table, const Record& stimulus,
                          const TableEntry& entry) {
  Judge judge;
  const std::uint64_t index = stimulus.get(0, stimulus.bits()), segments = std::uint64_t{1} << table.segments_log2;
  const int octave = index >= segments ? 1 : 0;
  for (int part = 0; part <= 8; ++part) {
    const Real u = ldexpl(static_cast<Real>(part), -3);
    const Real x = ldexpl(1 + (static_cast<Real>(index % segments) + u) / static_cast<Real>(segments), octave);
    const Real y =
        ldexpl(static_cast<Real>(entry.c0) - (static_cast<Real>(entry.c1) - static_cast<Real>(entry.c2) * u) * u,
               -(l.s + Config::table_guard));
    const Real exact = rsqrt ? 1 / sqrtl(x) : 1 / x, tolerance = (rsqrt ? l.rsqrt : l.reciprocal) * exact;
    judge.within("c0", -1, y, exact - tolerance, exact + tolerance);
  }
  return judge.outcome();
}

// ---- The machine ----

/// Pixels that a quad must draw and does not, or draws twice, count as further vectors.
void check_complete(VerifyResult& total, const SuiteReader& reader, const std::vector<MachineDraw>& draws,
                    unsigned threads) {
  const std::uint64_t lines = reader.lines("response");
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> pixels;
  for (const DrawnFragment& drawn : read_fragments(reader, 0, lines))
    pixels[{drawn.draw, drawn.fragment.quad}].push_back(std::uint32_t{drawn.fragment.y} << 16 | drawn.fragment.x);
  for (auto& [quad, list] : pixels) std::ranges::sort(list);

  struct Missing {
    std::uint64_t count = 0;
    std::string first;
  };
  const auto one_draw = [&](std::size_t d) {
    const DrawState& state = draws[d].state;
    Missing missing;
    const auto add = [&](const SnappedQuad& quad, int x, int y, const char* what) {
      if (missing.count++ == 0)
        missing.first = std::string(what) + " of quad " + std::to_string(quad.id) + " of draw " + std::to_string(d) +
                        " at (" + std::to_string(x) + ", " + std::to_string(y) + ")";
    };
    for (const SnappedQuad& quad : draws[d].quads) {
      const FloatQuad real(quad, reader.set().config, state);
      const auto found = pixels.find({static_cast<std::uint32_t>(d), quad.id});
      const std::vector<std::uint32_t> none, &list = found == pixels.end() ? none : found->second;
      for (auto same = std::ranges::adjacent_find(list); same != list.end();
           same = std::adjacent_find(same + 1, list.end()))
        add(quad, static_cast<int>(*same & 0xffff), static_cast<int>(*same >> 16), "a second fragment");
      for (int y = state.scissor_y0; y < state.scissor_y1; ++y)
        for (int x = state.scissor_x0; x < state.scissor_x1; ++x)
          if (real.must_draw(x, y) &&
              !std::ranges::binary_search(list, static_cast<std::uint32_t>(y) << 16 | static_cast<std::uint32_t>(x)))
            add(quad, x, y, "no fragment");
    }
    return missing;
  };
  ordered_parallel(draws.size(), threads, one_draw, [&](std::size_t, const Missing& missing) {
    if (missing.count > 0 && total.mismatches == 0)
      total.first_difference = reader.place("response", std::max<std::uint64_t>(lines, 1) - 1) + ": " + missing.first;
    total.vectors += missing.count;
    total.mismatches += missing.count;
  });
}

VerifyResult verify_machine(const SuiteReader& reader, unsigned threads) {
  const Config& config = reader.set().config;
  const std::vector<MachineDraw> draws = read_draws(reader);
  std::vector<std::map<std::uint32_t, std::size_t>> quad_of_id(draws.size());
  for (std::size_t d = 0; d < draws.size(); ++d)
    for (std::size_t q = 0; q < draws[d].quads.size(); ++q)
      if (!quad_of_id[d].emplace(draws[d].quads[q].id, q).second)
        throw golden::InputError(reader.place("stimulus", 0) +
                                 ": two quads of a draw have the same id, so their fragments cannot be told apart");

  constexpr std::uint64_t chunk = 1024;
  const std::uint64_t lines = reader.lines("response");
  VerifyResult total;
  ordered_parallel((lines + chunk - 1) / chunk, threads,
                   [&](std::size_t unit) {
                     const std::uint64_t first = unit * chunk;
                     VerifyResult part;
                     std::optional<FloatQuad> quad;
                     std::pair<std::uint32_t, std::uint32_t> current{};
                     std::uint64_t line = first;
                     for (const DrawnFragment& drawn : read_fragments(reader, first, std::min(chunk, lines - first))) {
                       VectorOutcome outcome{VectorOutcome::Kind::mismatch, "draw: no such draw"};
                       if (drawn.draw < draws.size()) {
                         const MachineDraw& draw = draws[drawn.draw];
                         const auto found = quad_of_id[drawn.draw].find(drawn.fragment.quad);
                         outcome.difference = "quad: no quad of the draw";
                         if (found != quad_of_id[drawn.draw].end()) {
                           if (!quad || current != std::pair{drawn.draw, drawn.fragment.quad})
                             quad.emplace(draw.quads[found->second], config, draw.state);
                           current = {drawn.draw, drawn.fragment.quad};
                           outcome = quad->check(drawn.fragment);
                         }
                       }
                       part.add(outcome, reader, line++);
                     }
                     return part;
                   },
                   [&](std::size_t, const VerifyResult& part) { total.merge(part); });
  check_complete(total, reader, draws, threads);
  return total;
}

}  // namespace

VectorOutcome check_float(std::string_view suite, const Stage& stage, const Record& stimulus, const Record& response) {
  return check_stage(find_stage(suite), stage, Losses(stage.config()), stimulus, response);
}

VerifyResult verify_float(const Suite& suite, const SuiteReader& reader, unsigned threads) {
  if (const auto* tables = dynamic_cast<const TableSuite*>(&suite)) {
    const Config& config = reader.set().config;
    require_layout(reader, "stimulus", tables->stimulus_layout(config));
    require_layout(reader, "response", tables->response_layout(config));
    return check_vectors(
        reader, threads,
        [&, losses = Losses(config), table = tables->table(config)](const Record& stimulus, const Record& response) {
          return check_table(suite.info().name == "rsqrt_table", losses, table, stimulus,
                             tables->entry(response, config));
        });
  }
  const auto* stages = dynamic_cast<const StageSuite*>(&suite);
  if (stages == nullptr) return verify_machine(reader, threads);
  const auto stage = stages->stage(reader.set().config);
  require_layout(reader, "stimulus", stage->stimulus_layout());
  require_layout(reader, "response", stage->response_layout());
  const Losses losses(stage->config());
  return check_vectors(reader, threads,
                       [&, check = find_stage(suite.info().name)](const Record& stimulus, const Record& response) {
                         return check_stage(check, *stage, losses, stimulus, response);
                       });
}

FloatQuad::FloatQuad(const SnappedQuad& quad, const Config& config, const DrawState& state)
    : quad_(quad), config_(config), state_(state), paper_(quad, config, state) {
  const Visibility seen = visibility(quad, config);
  visible_ = seen.visible;
  visible_decided_ = seen.decided;
  hull_ = seen.hull;
  const int s = config.significand_bits;
  for (std::size_t i = 0; i < 4; ++i) {
    const SnappedVertex& v = quad.vertex[i];
    const double w = std::ldexp(static_cast<double>(v.w), -config.frac());
    homogeneous_ = homogeneous_ || w != 1;
    behind_ = behind_ || w <= 0;
    const double x = std::ldexp(static_cast<double>(v.x), -config.frac()),
                 y = std::ldexp(static_cast<double>(v.y), -config.frac());
    lowest_ = {std::min(lowest_[0], x), std::min(lowest_[1], y)};
    highest_ = {std::max(highest_[0], x), std::max(highest_[1], y)};
    place_[i] = (std::fabs(static_cast<double>(v.x)) + std::fabs(static_cast<double>(v.y))) /
                std::fabs(static_cast<double>(v.w));
    k_over_w_[i] = golden::port_value(v.k, s) / w;
    z_over_w_[i] = golden::port_value(v.z, s) / w;
    for (std::size_t j = 0; j < max_attribute_slots; ++j) b_over_w_[j][i] = golden::port_value(v.attribute[j], s) / w;
  }
}

bool FloatQuad::must_draw(int x, int y) const {
  if (hull_ || !visible_decided_) return false;
  if (!homogeneous_ && (x < lowest_[0] || x > highest_[0] || y < lowest_[1] || y > highest_[1])) return false;
  if (state_.depth) {
    // Weights in [0, 1] leave z between those of the vertices, but for the machine's error (check_values).
    if (behind_) return false;
    const double doubt = std::ldexp(4.0, 3 - config_.significand_bits) + std::ldexp(1.0, -config_.depth_bits);
    for (const double z : z_over_w_)
      if (!(z >= state_.znear + doubt && z <= state_.zfar - doubt)) return false;
  }
  const PixelEdges at(quad_, x, y);
  const PixelCover pixel = cover(at.e, at.gx, at.gy, visible_, state_.cull);
  return pixel.decided && pixel.covered;
}

VectorOutcome FloatQuad::check(const Fragment& g) const {
  Judge judge;
  const int x = g.x, y = g.y;
  judge.within("x", -1, x, state_.scissor_x0, state_.scissor_x1 - 1);
  judge.within("y", -1, y, state_.scissor_y0, state_.scissor_y1 - 1);

  // Coverage, facing and the singular class: integers.
  const PixelEdges at(quad_, x, y);
  const auto &sx = at.sx, &sy = at.sy;
  const auto& e = at.e;
  std::array<IntegerSum, 4> d{};
  bool decided = true;
  for (std::size_t n = 0; n < 4; ++n) {
    const auto [i, j] = vertex_pair[n];
    d[n].add(sx[i] * sx[j]);
    d[n].add(sy[i] * sy[j]);
    decided = decided && d[n].decided();
  }
  const PixelCover pixel = cover(e, at.gx, at.gy, visible_, state_.cull);
  if (pixel.decided && visible_decided_) {
    if (!pixel.covered)
      judge.differs("x: the quad does not cover pixel (" + std::to_string(x) + ", " + std::to_string(y) + ")");
    judge.same("front", -1, g.front, pixel.front);
  } else {
    judge.undecided();
  }
  const SingularClass is = singular_class([&](std::size_t i) { return sx[i] == 0 && sy[i] == 0; },
                                          [&](std::size_t i) { return e[i].sign() == 0 && d[i].sign() < 0; });
  bool notch = false;
  for (std::size_t i = 0; i < 4; ++i) notch = notch || e[(i + 3) % 4].sign() * e[i].sign() < 0;
  if (pixel.decided && decided) {
    const bool cured = config_.notch_exact && notch && is.corners == 0 && is.edges < 2;
    unsigned expected = 0, known = 0;
    const auto expect = [&](FragmentFlag flag, bool set) {
      known |= flag;
      if (set) expected |= flag;
    };
    expect(flag_tie, pixel.tie);
    expect(flag_homogeneous, homogeneous_);
    if (config_.qdrop() == 0) {  // else the machine sees D and r² with bits missing
      expect(flag_on_edge, is.on_edge());
      expect(flag_on_vertex, is.on_vertex());
      expect(flag_two_corner, is.two_corner());
      expect(flag_two_edge, is.two_edge());
      expect(flag_cured, cured);
    }
    judge.same("flags", -1, g.flags & known, expected);
  }
  for (std::size_t j = 0; j < static_cast<std::size_t>(config_.attribute_slots); ++j)
    if (j >= static_cast<std::size_t>(state_.attributes))
      judge.same("attr", static_cast<int>(j), static_cast<Real>(g.attribute[j]), 0);
  if (state_.depth)
    judge.within("depth", -1, g.depth, depth_code(state_.znear, config_), depth_code(state_.zfar, config_));
  else
    judge.same("depth", -1, g.depth, 0);

  const VectorOutcome shape = judge.outcome();
  if (shape.kind == VectorOutcome::Kind::mismatch) return shape;
  VectorOutcome values = is.corners + is.edges > 0 ? undefined : check_values(g);
  if (values.kind == VectorOutcome::Kind::match) return shape;
  values.compared = true;  // the shape was
  return values;
}

/// The machine's weights lambda' err by at most 2^-(s-3) (times the condition without the notch cure), so an attribute
/// by that times the sum of |a_i|, and each M by at most twice that, relatively; where weights may cancel (z, and
/// attributes without perspective behind the eye) this multiplies the terms. An output code is lost on top.
///
/// The paper's formulas in double: with e = 2^-52 a corner's s = v - p is off by ds = e (|v| + |p|), r and A, D by ds
/// times lengths, t = (r r' - D)/A by 3 dA (1 + |t|)/|A|, mu by the sum of its dt over r; quotients of sums of mu
/// follow. Where that is above the machine's own tolerance double has no answer.
VectorOutcome FloatQuad::check_values(const Fragment& g) const {
  // Dropped bits of D and r² that ordinary vertices have leave the machine without a bound.
  if (config_.quadratic_frac() < 2 * config_.subpixel_bits) return undefined;
  const golden::PaperFp64Quad::Pixel p = paper_.interpolate(g.x, g.y);
  if (!p.defined) return undefined;

  constexpr double epsilon = 0x1p-52;
  std::array<double, 4> ds{}, dt{}, dmu{};
  for (std::size_t i = 0; i < 4; ++i) ds[i] = epsilon * (place_[i] + g.x + g.y);
  double spread = 0, sum_mu = 0, size_mu = 0, error_mu = 0, sum_k = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    const double ri = std::fabs(p.r[i]), rj = std::fabs(p.r[j]), area = std::fabs(p.area[i]);
    const double da = ds[i] * rj + ds[j] * ri + 2 * epsilon * ri * rj;
    if (ds[i] > ri / 16 || da > area / 16) return undefined;
    dt[i] = 3 * da * (1 + std::fabs(p.t[i])) / area;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t before = (i + 3) % 4;
    const double r = std::fabs(p.r[i]);
    dmu[i] = (dt[before] + dt[i]) / r + std::fabs(p.mu[i]) * 2 * (ds[i] / r + epsilon);
    sum_mu += p.mu[i];
    size_mu += std::fabs(p.mu[i]);
    error_mu += dmu[i];
    sum_k += p.mu[i] * k_over_w_[i];
    spread += (std::fabs(p.t[before]) + std::fabs(p.t[i])) / r * std::fabs(k_over_w_[i]);
  }
  const double bound = std::ldexp(1.0, 3 - config_.significand_bits) *
                       (config_.notch_exact ? 1 : std::max(1.0, spread / std::fabs(sum_k)));

  Judge judge;
  if (hull_) {
    // In front of the eye where sum(M W) > 0, that is sum(lambda / w) > 0.
    if (std::fabs(sum_mu) <= 2 * bound * size_mu + 2 * error_mu) return undefined;
    if (!(p.sum_inverse_w > 0)) judge.differs("x: the pixel is behind the eye");
  }

  struct Quotient {
    double value, rounding, by_weights, by_lambda;
  };
  // sum(mu c) / sum(mu f); the errors of double, and of the machine with relative errors of M or errors of lambda'.
  const auto quotient = [&](const std::array<double, 4>& c, const std::array<double, 4>& f) {
    double num = 0, den = 0, error_num = 0, error_den = 0, size_num = 0, size_den = 0, values = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      num += p.mu[i] * c[i];
      den += p.mu[i] * f[i];
      size_num += std::fabs(p.mu[i] * c[i]);
      size_den += std::fabs(p.mu[i] * f[i]);
      error_num += dmu[i] * std::fabs(c[i]);
      error_den += dmu[i] * std::fabs(f[i]);
      values += std::fabs(c[i] / f[i]);
    }
    const double value = num / den, size = (size_num + std::fabs(value) * size_den) / std::fabs(den);
    double rounding_error = 2 * (error_num + std::fabs(value) * error_den) / std::fabs(den) + 8 * epsilon * size;
    if (error_den > std::fabs(den) / 16) rounding_error = HUGE_VAL;
    return Quotient{value, rounding_error, 2 * bound * size, bound * values};
  };
  // The code must be within tolerance of the value, clamped to its format.
  const auto compare = [&](const char* name, int index, double actual, double value, double tolerance,
                           double rounding_error, double clamp) {
    if (!(rounding_error <= tolerance)) return judge.undecided();
    tolerance += rounding_error;
    judge.within(name, index, actual, std::clamp(value - tolerance, -clamp, clamp),
                 std::clamp(value + tolerance, -clamp, clamp));
  };

  const std::array<double, 4> ones{1, 1, 1, 1};
  if (state_.depth) {
    const Quotient z = quotient(z_over_w_, ones);
    compare("depth", -1, std::ldexp(static_cast<double>(g.depth), -config_.depth_bits), z.value,
            z.by_weights + std::ldexp(1.0, -config_.depth_bits), z.rounding, 1);
  }
  const double limit = std::ldexp(1.0, config_.attribute_int_bits), code = std::ldexp(1.0, -config_.attribute_frac());
  bool may_saturate = false, must_saturate = false;
  for (int j = 0; j < state_.attributes; ++j) {
    const auto slot = static_cast<std::size_t>(j);
    const Quotient a = quotient(b_over_w_[slot], state_.perspective ? k_over_w_ : ones);
    const double tolerance = (!state_.perspective && behind_ ? a.by_weights : a.by_lambda) + code;
    const double size = std::fabs(a.value), doubt = tolerance + a.rounding;
    may_saturate = may_saturate || !(size + doubt < limit);
    must_saturate = must_saturate || size - doubt >= limit;
    compare("attr", j, std::ldexp(static_cast<double>(g.attribute[slot]), -config_.attribute_frac()), a.value,
            tolerance, a.rounding, limit - code);
  }
  if (may_saturate == must_saturate && ((g.flags & flag_saturated) != 0) != must_saturate)
    judge.differs(std::string("flags: ") +
                  (must_saturate ? "not saturated, but an attribute is" : "saturated, but no attribute is"));
  return judge.outcome();
}

}  // namespace quadrille::vectors
