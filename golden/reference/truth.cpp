#include "golden/reference/truth.hpp"

#include "golden/reference/port_number.hpp"
#include "golden/reference/rsqrt.hpp"
#include "golden/scenes/regular_weights.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace quadrille::golden {

namespace {

constexpr std::array<int, 5> edge_from{0, 1, 2, 3, 2};
constexpr std::array<int, 5> edge_to{1, 2, 3, 0, 0};
constexpr int diagonal = 4;

enum class Singular : std::uint8_t { none, one_edge, two_edge, one_corner, two_corner };

template <class Number>
int sign_of(const Number& value) {
  return (value > 0) - (value < 0);
}

// All are bit operations in line; comparisons of Float113 are library calls.
int sign_of(Float113 value) {
  const auto bits = std::bit_cast<unsigned __int128>(value);
  if (bits << 1 == 0) return 0;
  return bits >> 127 == 0 ? 1 : -1;
}
/// By bits: the sign is the highest one.
Float113 magnitude(Float113 value) {
  return std::bit_cast<Float113>(std::bit_cast<unsigned __int128>(value) << 1 >> 1);
}
bool negative(Float113 value) { return __builtin_signbit(value) != 0; }
#if __LDBL_MANT_DIG__ != 113
long double magnitude(long double value) { return std::abs(value); }
bool negative(long double value) { return std::signbit(value); }
/// 1 / sqrt(a), within two roundings.
long double rsqrt(long double a) { return 1.0L / std::sqrt(a); }
#endif
using golden::rsqrt;

/// a - b, exactly.
detail::TwoDoubles exact_difference(double a, double b) {
  const double difference = a - b, of_b = a - difference;
  return {difference, (a - (difference + of_b)) + (of_b - b)};
}

/// sum(a_i b_i)
template <class Number>
Number inner(const std::array<Number, 4>& a, const std::array<Number, 4>& b) {
  return (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3]);
}

/// sum(a_i)
template <class Number>
Number total(const std::array<Number, 4>& a) {
  return (a[0] + a[1]) + (a[2] + a[3]);
}

/// S_i = V_i - w_i p and the five edge functions at one pixel, with their signs after the tie rule.
template <class Coord, class Product>
struct PixelEdges {
  std::array<Coord, 4> sx, sy;
  std::array<Product, 5> e;
  std::array<int, 5> sign;
  bool tie = false;

  PixelEdges(const detail::TruthGeometry<Coord, Product>& g, int px, int py) {
    for (int i = 0; i < 4; ++i) {
      sx[i] = g.x[i] - g.w[i] * px;
      sy[i] = g.y[i] - g.w[i] * py;
    }
    for (int j = 0; j < 5; ++j) {
      const int a = edge_from[j], b = edge_to[j];
      e[j] = static_cast<Product>(sx[a]) * sy[b] - static_cast<Product>(sy[a]) * sx[b];
      sign[j] = sign_of(e[j]);
      if (sign[j] == 0) {
        sign[j] = g.tie_sign[j];
        tie = tie || sign[j] != 0;  // an all-zero edge decides nothing
      }
    }
  }

  bool at_corner(int i) const { return sign_of(sx[i]) == 0 && sign_of(sy[i]) == 0; }
  Product dot(int i) const {
    const int n = (i + 1) & 3;
    return static_cast<Product>(sx[i]) * sx[n] + static_cast<Product>(sy[i]) * sy[n];
  }
  Product square(int i) const { return static_cast<Product>(sx[i]) * sx[i] + static_cast<Product>(sy[i]) * sy[i]; }
};

/// Expression (12) for one orientation: 1 when its first clause holds, 2 for the second, 0 for neither. An all-zero
/// edge (sign 0) is false here and false negated, in either orientation.
int clause_of_12(const std::array<int, 5>& sign, int orientation) {
  const auto is = [&](int edge, int wanted) { return sign[edge] == wanted * orientation; };
  if (is(diagonal, 1) && is(0, 1) && is(1, 1) && (is(2, 1) || is(3, 1))) return 1;
  if (is(diagonal, -1) && is(2, 1) && is(3, 1) && (is(0, 1) || is(1, 1))) return 2;
  return 0;
}

/// M_i up to a common factor; spread_i = (|t_{i-1}| + |t_i|) / R_i in the same scale.
template <class Number>
struct Weights {
  std::array<Number, 4> m{}, spread{};
  Singular singular = Singular::none;
  bool cancels = false;   ///< some spread_i is not |M_i|
  bool collinear = true;  ///< every A_i is 0: the pixel's ray lies in the plane of all edges
  bool opposed = false;   ///< two corners or edges are met on both sides of the eye, with M that make sum(M k) 0
};

/// Dot products and squares of S at a pixel. In long double from S rounded to it, which is quicker: in units of 2^-64 S
/// is within 1 and a product within 3, so that a square, where nothing cancels, is within 4, and a dot product within 3
/// of the product of both lengths (Cauchy and Schwarz) and 1 of itself.
template <class Number, class Coord, class Product>
struct PixelLengths {
  std::array<Number, 4> dot, square;

  explicit PixelLengths(const PixelEdges<Coord, Product>& p) {
    if constexpr (std::is_same_v<Number, long double>) {
      std::array<Number, 4> x, y;
      for (int i = 0; i < 4; ++i) {
        x[i] = static_cast<Number>(p.sx[i]);
        y[i] = static_cast<Number>(p.sy[i]);
      }
      for (int i = 0; i < 4; ++i) {
        const int n = (i + 1) & 3;
        dot[i] = x[i] * x[n] + y[i] * y[n];
        square[i] = x[i] * x[i] + y[i] * y[i];
      }
    } else {
      for (int i = 0; i < 4; ++i) {
        dot[i] = static_cast<Number>(p.dot(i));
        square[i] = static_cast<Number>(p.square(i));
      }
    }
  }
};

/// Number: Float113, or long double, whose m_i are within 69 spread_i 2^-64. (In units of 2^-64, a square's 4 halved
/// by its root: rho 4 and a length 5; the product of two lengths 11, n and d 15, for nothing in them cancels; with the
/// product of two d, 31, the products t_i are within 63; rho and the last two operations make 69.)
template <class Number, class Coord, class Product>
Weights<Number> weights_at(const PixelEdges<Coord, Product>& p, const std::array<Number, 4>& k) {
  Weights<Number> out;
  for (int i = 0; i < 4; ++i) out.collinear = out.collinear && sign_of(p.e[i]) == 0;

  int corners = 0;
  std::array<int, 2> corner{};
  for (int i = 0; i < 4; ++i) {
    if (!p.at_corner(i)) continue;
    if (corners < 2) corner[corners] = i;
    ++corners;
  }
  if (corners >= 2) {
    // Three or four coincident corners are never covered: too many all-zero edges.
    out.singular = Singular::two_corner;
    // No M has a sign. Without perspective a corner behind the eye and one before it leave sum(M w) = 0.
    out.opposed = sign_of(k[corner[0]]) * sign_of(k[corner[1]]) < 0;
    out.m[corner[0]] = magnitude(k[corner[1]]);
    out.m[corner[1]] = magnitude(k[corner[0]]);
    return out;
  }
  if (corners == 1) {
    out.singular = Singular::one_corner;
    out.m[corner[0]] = 1;
    return out;
  }

  int edges = 0;
  std::array<int, 2> edge{};
  for (int i = 0; i < 4; ++i) {
    if (sign_of(p.e[i]) != 0 || sign_of(p.dot(i)) >= 0) continue;
    if (edges < 2) edge[edges] = i;
    ++edges;
  }

  const PixelLengths<Number, Coord, Product> lengths(p);
  const std::array<Number, 4>& dot = lengths.dot;
  std::array<Number, 4> rho, length;
  for (int i = 0; i < 4; ++i) {
    rho[i] = rsqrt(lengths.square[i]);
    length[i] = lengths.square[i] * rho[i];
  }

  if (edges >= 2) {
    // Three or four edges at once happen only in a quad that is seen edge on; its first two decide. What they cross has
    // no sign, as no M has one here: without perspective one edge may be met behind the eye and the other before it,
    // and then sum(M w) = 0.
    out.singular = Singular::two_edge;
    const auto sum_on = [&](int i) { return rho[i] * k[i] + rho[(i + 1) & 3] * k[(i + 1) & 3]; };
    out.opposed = sign_of(sum_on(edge[0])) * sign_of(sum_on(edge[1])) < 0;
    for (int side = 0; side < 2; ++side) {
      const Number other = magnitude(sum_on(edge[1 - side]));
      for (const int i : {edge[side], (edge[side] + 1) & 3}) out.m[i] += rho[i] * other;
    }
    return out;
  }
  if (edges == 1) out.singular = Singular::one_edge;

  std::array<Number, 4> both, area;
  for (int i = 0; i < 4; ++i) {
    area[i] = static_cast<Number>(p.e[i]);
    both[i] = length[i] * length[(i + 1) & 3];
  }
  const RegularWeights<Number> regular(both, dot, area, rho);
  out.m = regular.m;
  for (int i = 0; i < 4; ++i) {
    const Number left = regular.left[i], right = regular.right[i];
    // Where a term is 0 either branch gives the same.
    const bool cancels = negative(left) != negative(right);
    out.spread[i] = magnitude(cancels ? (left - right) * rho[i] : out.m[i]);
    out.cancels = out.cancels || cancels;
  }
  return out;
}

/// sum(M w) is 0 as an identity, not merely small: sum(M_i V_i) is a multiple of the pixel's ray and lies in the plane
/// of the vertices, so if that plane holds the eye but not the ray the multiple is 0. So it is where `opposed`, which
/// is without perspective, where k = w.
template <class Number, class Coord, class Product>
bool w_sum_vanishes(const detail::TruthGeometry<Coord, Product>& g, const Weights<Number>& weights) {
  return weights.opposed || (g.flat && !weights.collinear);
}

template <class Coord, class Product>
Coverage cover_pixel(const detail::TruthGeometry<Coord, Product>& g, const PixelEdges<Coord, Product>& p,
                     bool homogeneous, int& clause) {
  Coverage out;
  out.eye_in_hull = g.eye_in_hull;
  out.flags = static_cast<std::uint8_t>((p.tie ? flag_tie : 0) | (homogeneous ? flag_homogeneous : 0));
  int orientation = 1;
  clause = clause_of_12(p.sign, 1);
  if (clause == 0) {
    orientation = -1;
    clause = clause_of_12(p.sign, -1);
  }
  if (clause == 0) return out;
  out.covered = true;
  out.front = orientation < 0;
  out.visible = !g.eye_in_hull && orientation * (clause == 1 ? g.det_012 : g.det_023) > 0;
  return out;
}

void check_draw(const DrawState& draw) {
  if (draw.attributes < 0 || draw.attributes > max_attribute_slots) {
    throw std::invalid_argument("attributes must be 0 to " + std::to_string(max_attribute_slots) + ", not " +
                                std::to_string(draw.attributes));
  }
}

void refuse_vertex(std::uint32_t quad, int vertex, const char* why) {
  throw std::invalid_argument("quad " + std::to_string(quad) + ", vertex " + std::to_string(vertex) + ": " + why);
}

/// With the eye in the hull visibility is not that of a triangle.
CoverageRows::Eye eye_of(bool in_hull) { return in_hull ? CoverageRows::Eye::anywhere : CoverageRows::Eye::in_front; }

}  // namespace

namespace detail {

template <class Coord, class Product>
void TruthGeometry<Coord, Product>::finish() {
  const auto times = [](Coord a, Coord b) { return static_cast<Product>(a) * b; };
  for (int j = 0; j < 5; ++j) {
    // E(x, y) = x dx + y dy + constant, the cross product of the two vertices (Olano & Greer 1997).
    const int a = edge_from[j], b = edge_to[j];
    const Product dx = times(y[a], w[b]) - times(w[a], y[b]);
    const Product dy = times(w[a], x[b]) - times(x[a], w[b]);
    tie_sign[j] = static_cast<std::int8_t>(dx != 0 ? sign_of(dx) : sign_of(dy));
  }
  const auto det = [&](int a, int b, int c) {
    return sign_of(x[a] * (times(y[b], w[c]) - times(w[b], y[c])) + y[a] * (times(w[b], x[c]) - times(x[b], w[c])) +
                   w[a] * (times(x[b], y[c]) - times(y[b], x[c])));
  };
  det_012 = det(0, 1, 2);
  det_023 = det(0, 2, 3);
  // Coefficients of the linear relation sum(c_i V_i) = 0: of one sign exactly when the eye is in the hull.
  const std::array<int, 4> relation{det(1, 2, 3), -det_023, det(0, 1, 3), -det_012};
  const bool positive = std::ranges::any_of(relation, [](int s) { return s > 0; });
  const bool negative = std::ranges::any_of(relation, [](int s) { return s < 0; });
  flat = !positive && !negative;
  eye_in_hull = !(positive && negative);
}

template struct TruthGeometry<std::int64_t, __int128>;
template struct TruthGeometry<Float113, Float113>;

}  // namespace detail

TruthQuad::TruthQuad(const SnappedQuad& quad, const Config& config, const DrawState& draw)
    : attributes_(draw.attributes), perspective_(draw.perspective) {
  check_draw(draw);
  const int frac = config.frac();
  const std::int32_t one = std::int32_t{1} << frac;
  Exact g;
  std::array<CoverageRows::Vertex, 4> vertex;
  for (int i = 0; i < 4; ++i) {
    const SnappedVertex& v = quad.vertex[i];
    if (v.x == 0 && v.y == 0 && v.w == 0) refuse_vertex(quad.id, i, "(0, 0, 0) is no point");
    g.x[i] = v.x;
    g.y[i] = v.y;
    g.w[i] = v.w;
    homogeneous_ = homogeneous_ || v.w != one;
    vertex[i] = {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.w)};
    exact_.w[i] = std::ldexp(static_cast<double>(v.w), -frac);
    exact_.k[i] = port_value(v.k, config.significand_bits);
    exact_.z[i] = port_value(v.z, config.significand_bits);
    for (int a = 0; a < attributes_; ++a)
      exact_.b[a][i] = i == 0 ? 0 : port_value(v.attribute[a], config.significand_bits);
  }
  const auto depth = [&](auto code) { return std::ldexp(static_cast<double>(code), -config.depth_bits); };
  base_z_ = depth(quad.base.depth);
  z_low_ = depth(quad.base.depth_low);
  z_high_ = depth(quad.base.depth_high);
  for (int a = 0; a < attributes_; ++a)
    base_attribute_[a] = std::ldexp(static_cast<double>(quad.base.attribute[a]), -config.attribute_frac());
  g.finish();
  geometry_ = g;
  quick_ = detail::VertexValues<long double>(exact_);
  std::array<detail::TwoDoubles, 4> x, y;
  std::array<double, 4> w;
  for (int i = 0; i < 4; ++i) {
    x[i] = {static_cast<double>(g.x[i])};
    y[i] = {static_cast<double>(g.y[i])};
    w[i] = static_cast<double>(g.w[i]);
  }
  set_lanes(x, y, w, g.eye_in_hull);
  unit_w_ = !homogeneous_;
  rows_ = {vertex, 0, scissor_of(draw), eye_of(g.eye_in_hull)};
}

TruthQuad::TruthQuad(const WindowQuad& quad, const DrawState& draw)
    : attributes_(draw.attributes), perspective_(draw.perspective), unit_w_(true) {
  check_draw(draw);
  Rounded g;
  std::array<CoverageRows::Vertex, 4> vertex;
  for (int i = 0; i < 4; ++i) {
    const WindowVertex& v = quad.vertex[i];
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z) || !std::isfinite(v.w)) {
      refuse_vertex(quad.id, i, "not finite");
    }
    if (v.x == 0 && v.y == 0 && v.w == 0) refuse_vertex(quad.id, i, "(0, 0, *, 0) is no point");
    const Float113 w = v.w;
    g.x[i] = v.x - w / 2;
    g.y[i] = v.y - w / 2;
    g.w[i] = w;
    homogeneous_ = homogeneous_ || !(v.w > 0);
    unit_w_ = unit_w_ && v.w == 1;
    exact_.w[i] = w;
    exact_.k[i] = 1;
    exact_.z[i] = v.z;
    for (int a = 0; a < attributes_; ++a) {
      const double value = a < static_cast<int>(quad.attribute[i].size()) ? quad.attribute[i][a] : 0.0;
      exact_.b[a][i] = perspective_ ? static_cast<Float113>(value) : w * value;
    }
    vertex[i] = {v.x, v.y, v.w};
  }
  g.finish();
  geometry_ = g;
  quick_ = detail::VertexValues<long double>(exact_);
  std::array<detail::TwoDoubles, 4> x, y;
  std::array<double, 4> w;
  for (int i = 0; i < 4; ++i) {
    const WindowVertex& v = quad.vertex[i];
    x[i] = exact_difference(v.x, v.w / 2);
    y[i] = exact_difference(v.y, v.w / 2);
    w[i] = v.w;
  }
  set_lanes(x, y, w, g.eye_in_hull);
  rows_ = {vertex, 0.5, scissor_of(draw), eye_of(g.eye_in_hull)};
}

void TruthQuad::set_lanes(const std::array<detail::TwoDoubles, 4>& x, const std::array<detail::TwoDoubles, 4>& y,
                          const std::array<double, 4>& w, bool eye_in_hull) {
  if (eye_in_hull) return;
  // Nothing is drawn of a quad without any w or k; the filter's sums need one that is not 0.
  const auto all_zero = [](const auto& values) { return std::ranges::all_of(values, [](auto v) { return v == 0; }); };
  if (all_zero(exact_.k) || all_zero(exact_.w)) return;
  bool fits = true;
  const auto take = [&](Float113 value) {
    const auto number = static_cast<double>(value);
    const double size = std::fabs(number);
    fits = fits && number == value &&
           (number == 0 || (size >= detail::lane_least_value && size <= detail::lane_largest_value));
    return number;
  };
  detail::LaneQuad& q = lanes_.emplace();
  q.perspective = perspective_;
  q.attributes = attributes_;
  for (int i = 0; i < 4; ++i) {
    q.x[i] = {take(x[i].hi), x[i].lo};
    q.y[i] = {take(y[i].hi), y[i].lo};
    q.w[i] = take(w[i]);
    q.k[i] = take(exact_.k[i]);
    q.z[i] = take(exact_.z[i]);
    q.w_value[i] = take(exact_.w[i]);
    for (int a = 0; a < attributes_; ++a) q.b[a][i] = take(exact_.b[a][i]);
  }
  if (!fits) lanes_.reset();
}

Coverage TruthQuad::cover(int px, int py) const {
  return std::visit(
      [&](const auto& g) {
        const PixelEdges p(g, px, py);
        int clause = 0;
        Coverage out = cover_pixel(g, p, homogeneous_, clause);
        if (out.covered && out.eye_in_hull) out.visible = sample(px, py).visible;
        return out;
      },
      geometry_);
}

std::array<Float113, 4> TruthQuad::homogeneous_weights(int px, int py) const {
  return std::visit([&](const auto& g) { return weights_at(PixelEdges(g, px, py), crossing()).m; }, geometry_);
}

namespace {

/// Everything of a covered pixel that needs weights. Of long double it says only what is certain: false where some sum
/// is small beside its terms, or the pixel is singular at a point; `out` is then of no use.
///
/// Certain: the terms of a sum are within 72 spread_i 2^-64. With |sum(M k)| >= sum(spread |k|) / 56 that is 2^-52 of
/// the sum, so the weights are as good as doubles. sum(M w) may cancel more, by 900, where it is within 2^-48 of
/// itself: a machine's own error there grows by the same factor. No sign is in doubt.
///
/// What it gains: without it the truth of all scenes and stress families takes 4.2 times as long. The lanes leave
/// pixels of quads with the eye in their hull (6.6 times), with any w (5.7) and of collapsed edges (4.6); most scenes
/// have none.
template <class Number, class Coord, class Product>
bool weigh(const detail::TruthGeometry<Coord, Product>& g, const PixelEdges<Coord, Product>& p,
           const detail::VertexValues<Number>& v, bool perspective, bool unit_w, int attributes, ReferenceSample& out) {
  constexpr bool certain = std::is_same_v<Number, Float113>;
  constexpr int most_cancelled_k = 56, most_cancelled_w = 900;
  const Weights<Number> weights = weights_at(p, perspective ? v.k : v.w);
  switch (weights.singular) {
    case Singular::none:
      break;
    case Singular::one_edge:
      out.flags |= flag_on_edge;
      break;
    case Singular::two_edge:
      out.flags |= flag_two_edge;
      break;
    case Singular::one_corner:
      out.flags |= flag_on_vertex;
      break;
    case Singular::two_corner:
      out.flags |= flag_two_corner;
      break;
  }
  const bool regular = weights.singular == Singular::none || weights.singular == Singular::one_edge;
  if (!certain && !regular) return false;
  if (regular)
    for (int i = 0; i < 4; ++i) out.notch = out.notch || sign_of(p.e[(i + 3) & 3]) * sign_of(p.e[i]) < 0;

  const std::array<Number, 4>& m = weights.m;
  std::array<Number, 4> mk, mw = m, size;
  for (int i = 0; i < 4; ++i) {
    mk[i] = m[i] * v.k[i];
    if (!unit_w) mw[i] = m[i] * v.w[i];
    size[i] = magnitude(mw[i]);
  }
  const Number sum_k = total(mk), sum_z = inner(m, v.z), size_w = total(size);
  Number sum_w = total(mw);
  const bool vanishes = w_sum_vanishes(g, weights);
  if (vanishes) sum_w = 0;
  if constexpr (!certain) {
    Number spread_k = 0, spread_w = 0;
    for (int i = 0; i < 4; ++i) {
      spread_k += weights.spread[i] * magnitude(v.k[i]);
      spread_w += weights.spread[i] * magnitude(v.w[i]);
    }
    // A sum that is no number, or infinite, is not certain either.
    if (!(magnitude(sum_k) * most_cancelled_k >= spread_k) || !(spread_k < std::numeric_limits<Number>::max()))
      return false;
    if (!vanishes && !(magnitude(sum_w) * most_cancelled_w >= spread_w)) return false;
  }

  // Sums that may cancel are finished above in 113 bits; 64 bits suffice for the quotients that become doubles.
  const auto narrow = [](Number value) { return static_cast<long double>(value); };
  const int facing = sign_of(sum_k);
  if (out.eye_in_hull) out.visible = facing * sign_of(sum_w) > 0;
  if (size_w > 0) {
    out.visible_margin = static_cast<double>(facing * (narrow(sum_w) / narrow(size_w)));
  }
  if (sum_w != 0) {
    const long double per_w = 1.0L / narrow(sum_w);
    out.z_above = static_cast<double>(narrow(sum_z) * per_w);
    out.z_condition = static_cast<double>(std::abs(narrow(size_w) * per_w));
  } else {
    out.z_condition = std::numeric_limits<double>::infinity();
  }
  // Inside, the M_i have one sign: where nothing cancels the quotient is 1.
  if (weights.singular == Singular::none && weights.cancels) {
    long double spread = 0;
    for (int i = 0; i < 4; ++i) spread += narrow(weights.spread[i]) * narrow(v.k[i]);
    out.condition = static_cast<double>(spread / std::abs(narrow(sum_k)));
  }
  const auto& part = perspective ? mk : mw;
  const Number whole = perspective ? sum_k : sum_w;
  if (whole == 0) return true;  // without perspective and nothing in front of the eye: no weights
  const long double per_whole = 1.0L / narrow(whole);
  for (int i = 0; i < 4; ++i) out.lambda[i] = static_cast<double>(narrow(part[i]) * per_whole);
  for (int a = 0; a < attributes; ++a) {
    out.attribute_above[a] = static_cast<double>(narrow(inner(m, v.b[a])) * per_whole);
  }
  return true;
}

}  // namespace

ReferenceSample TruthQuad::sample(int px, int py, Effort effort) const {
  return std::visit(
      [&](const auto& g) {
        ReferenceSample covered;
        const PixelEdges p(g, px, py);
        int clause = 0;
        const Coverage coverage = cover_pixel(g, p, homogeneous_, clause);
        covered.covered = coverage.covered;
        covered.front = coverage.front;
        covered.visible = coverage.visible;
        covered.eye_in_hull = coverage.eye_in_hull;
        covered.flags = coverage.flags;
        if (!covered.covered) return covered;

        ReferenceSample out = covered;
        if (effort != Effort::filter || !weigh(g, p, quick_, perspective_, unit_w_, attributes_, out)) {
          out = covered;
          weigh(g, p, exact_, perspective_, unit_w_, attributes_, out);
        }
        add_bases(out);
        return out;
      },
      geometry_);
}

void TruthQuad::add_bases(ReferenceSample& sample) const {
  // Clamped as a difference, so that nothing is lost beside the base.
  sample.z_above = std::clamp(sample.z_above, z_low_ - base_z_, z_high_ - base_z_);
  sample.z = base_z_ + sample.z_above;
  for (int a = 0; a < attributes_; ++a) sample.attribute[a] = base_attribute_[a] + sample.attribute_above[a];
}

bool TruthQuad::take_lane(const detail::LaneSamples& from, std::size_t lane, int det_012, int det_023,
                          ReferenceSample& out) const {
  const std::int64_t decided = from.decided[lane];
  if (decided == 0) return false;
  out = {};
  out.flags = homogeneous_ ? flag_homogeneous : 0;
  out.covered = decided >= 2;
  if (!out.covered) return true;
  out.front = decided >= 4;
  out.visible = (out.front ? -1 : 1) * (decided % 2 == 0 ? det_012 : det_023) > 0;
  out.notch = from.notch[lane] != 0;
  out.visible_margin = from.visible_margin[lane];
  out.condition = from.condition[lane];
  out.z_above = from.z_above[lane];
  out.z_condition = from.z_condition[lane];
  for (int i = 0; i < 4; ++i) out.lambda[i] = from.lambda[i][lane];
  for (int a = 0; a < attributes_; ++a) out.attribute_above[a] = from.attribute_above[a][lane];
  add_bases(out);
  return true;
}

void TruthQuad::samples(std::span<const PixelPlace> pixels, std::span<ReferenceSample> out, LaneTarget lanes,
                        std::vector<bool>* decided) const {
  const auto [det_012, det_023] = std::visit([](const auto& g) { return std::pair(g.det_012, g.det_023); }, geometry_);
  detail::LaneSamples samples;
  for (std::size_t from = 0; from < pixels.size(); from += detail::truth_lanes) {
    const std::size_t count = std::min(detail::truth_lanes, pixels.size() - from);
    if (lanes_) {
      for (std::size_t lane = 0; lane < detail::truth_lanes; ++lane) {
        const PixelPlace& pixel = pixels[from + std::min(lane, count - 1)];
        samples.px[lane] = pixel.x;
        samples.py[lane] = pixel.y;
      }
      detail::sample_lanes(*lanes_, lanes, samples);
    }
    for (std::size_t lane = 0; lane < count; ++lane) {
      const PixelPlace& pixel = pixels[from + lane];
      const bool taken = lanes_ && take_lane(samples, lane, det_012, det_023, out[from + lane]);
      if (!taken) out[from + lane] = sample(pixel.x, pixel.y);
      if (decided != nullptr) decided->push_back(taken);
    }
  }
}

bool TruthQuad::needs_113_bits(int px, int py) const {
  return std::visit(
      [&](const auto& g) {
        const PixelEdges p(g, px, py);
        int clause = 0;
        ReferenceSample out;
        return cover_pixel(g, p, homogeneous_, clause).covered &&
               !weigh(g, p, quick_, perspective_, unit_w_, attributes_, out);
      },
      geometry_);
}

}  // namespace quadrille::golden
