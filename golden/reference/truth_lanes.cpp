#include "golden/reference/truth_lanes.hpp"

#include "golden/reference/double_double.hpp"

#include <cstring>

namespace quadrille::golden {

namespace detail {
namespace {

#define LANE_LAMBDA __attribute__((always_inline))

using V = Doubles;
using Mask = std::int64_t __attribute__((vector_size(sizeof(V))));  ///< 0 or -1 in each lane
static_assert(sizeof(LaneSamples::Reals) == sizeof(V) && sizeof(LaneSamples::Integers) == sizeof(Mask));

/// Copies, for what is kept need not have a vector's alignment.
QUADRILLE_INLINE V load(const LaneSamples::Reals& from) {
  V v;
  std::memcpy(&v, &from, sizeof v);
  return v;
}
template <class Vector, class Array>
QUADRILLE_INLINE void store(Vector v, Array& to) {
  std::memcpy(&to, &v, sizeof v);
}

QUADRILLE_INLINE V splat(double v) { return V{} + v; }
QUADRILLE_INLINE V magnitude(V v) { return (V)((Mask)v & INT64_MAX); }
/// Changes signs where `sign`, of which the other bits are 0, has one.
QUADRILLE_INLINE V flip(V v, Mask sign) { return (V)((Mask)v ^ sign); }
QUADRILLE_INLINE Mask sign_bit(V v) { return (Mask)v & INT64_MIN; }
/// By the sign bit, which every target has shifts for; GCC 12 compares wide vectors one by one.
QUADRILLE_INLINE Mask negative(V v) { return (Mask)v >> 63; }
QUADRILLE_INLINE Mask at_least(V v, V least) { return ~negative(v - least); }
QUADRILLE_INLINE V select(Mask which, V a, V b) { return (V)(((Mask)a & which) | ((Mask)b & ~which)); }
QUADRILLE_INLINE DoubleDouble select(Mask which, DoubleDouble a, DoubleDouble b) {
  return {select(which, a.hi, b.hi), select(which, a.lo, b.lo)};
}
QUADRILLE_INLINE DoubleDouble magnitude(DoubleDouble a) {
  const Mask sign = sign_bit(a.hi);
  return {flip(a.hi, sign), flip(a.lo, sign)};
}
QUADRILLE_INLINE DoubleDouble total(const std::array<DoubleDouble, 4>& a) { return (a[0] + a[1]) + (a[2] + a[3]); }
QUADRILLE_INLINE V total(const std::array<V, 4>& a) { return (a[0] + a[1]) + (a[2] + a[3]); }

/// f(0) … f(3), in line.
template <class F>
QUADRILLE_INLINE auto four(const F& f) {
  return std::array{f(0), f(1), f(2), f(3)};
}

/// The same formulas as weights_at() and weigh() of truth.cpp, one pixel a lane.
template <bool fused>
QUADRILLE_INLINE void sample(const LaneQuad& q, LaneSamples& out) {
  const V px = load(out.px), py = load(out.py);
  const auto times = [](auto a, auto b) LANE_LAMBDA { return product<fused>(a, b); };
  const auto relative_to = [&](const TwoDoubles& x, double w, V pixel) LANE_LAMBDA {
    return accurate_sum({splat(x.hi), splat(x.lo)}, -exact_product<fused>(splat(w), pixel));
  };
  const auto sx = four([&](int i) LANE_LAMBDA { return relative_to(q.x[i], q.w[i], px); });
  const auto sy = four([&](int i) LANE_LAMBDA { return relative_to(q.y[i], q.w[i], py); });

  // Edge functions, and whether all are certain.
  Mask certain = ~Mask{};
  const auto edge = [&](int a, int b) LANE_LAMBDA {
    const DoubleDouble left = times(sx[a], sy[b]), right = times(sy[a], sx[b]);
    const DoubleDouble e = accurate_sum(left, -right);
    const V size = magnitude(e.hi), terms = magnitude(left.hi) + magnitude(right.hi);
    certain &= at_least(size, lane_least_area * terms) & at_least(size, splat(0x1p-120));
    return e;
  };
  const auto e = four([&](int i) LANE_LAMBDA { return edge(i, (i + 1) & 3); });
  const DoubleDouble diagonal = edge(2, 0);

  // Expression (12): no edge function is 0, so what is not negative is positive.
  const Mask n0 = negative(e[0].hi), n1 = negative(e[1].hi), n2 = negative(e[2].hi), n3 = negative(e[3].hi),
             nd = negative(diagonal.hi);
  const Mask first = ~nd & ~n0 & ~n1 & ~(n2 & n3), second = nd & ~n2 & ~n3 & ~(n0 & n1);
  const Mask back_first = nd & n0 & n1 & (n2 | n3), back_second = ~nd & n2 & n3 & (n0 | n1);
  store((n0 ^ n1) | (n1 ^ n2) | (n2 ^ n3) | (n3 ^ n0), out.notch);

  // Lengths.
  const auto dot =
      four([&](int i) LANE_LAMBDA { return times(sx[i], sx[(i + 1) & 3]) + times(sy[i], sy[(i + 1) & 3]); });
  const auto square = four([&](int i) LANE_LAMBDA { return times(sx[i], sx[i]) + times(sy[i], sy[i]); });
  for (const DoubleDouble& s : square) certain &= at_least(s.hi, splat(0x1p-80)) & at_least(splat(0x1p120), s.hi);
  const auto rho = four([&](int i) LANE_LAMBDA { return rsqrt<fused>(square[i]); });
  const auto length = four([&](int i) LANE_LAMBDA { return times(square[i], rho[i]); });

  // t_i = n_i / d_i, over the common denominator.
  const auto whole = four([&](int i) LANE_LAMBDA { return times(length[i], length[(i + 1) & 3]) + magnitude(dot[i]); });
  const auto n = four([&](int i) LANE_LAMBDA { return select(negative(dot[i].hi), whole[i], e[i]); });
  const auto d = four([&](int i) LANE_LAMBDA { return select(negative(dot[i].hi), e[i], whole[i]); });
  const DoubleDouble d01 = times(d[0], d[1]), d23 = times(d[2], d[3]);
  const auto t = four([&](int i) LANE_LAMBDA { return times(times(n[i], d[i ^ 1]), i < 2 ? d23 : d01); });
  const auto m = four([&](int i) LANE_LAMBDA { return times(t[(i + 3) & 3] + t[i], rho[i]); });
  const auto spread =
      four([&](int i) LANE_LAMBDA { return times(magnitude(t[(i + 3) & 3]) + magnitude(t[i]), rho[i]); });

  // Sums.
  const auto of = [&](const std::array<DoubleDouble, 4>& a, const std::array<double, 4>& b)
                      LANE_LAMBDA { return four([&](int i) LANE_LAMBDA { return times(a[i], splat(b[i])); }); };
  const auto mk = of(m, q.k), mw = of(m, q.w_value), spread_k = of(spread, q.k);
  const DoubleDouble sum_k = total(mk), sum_w = total(mw);
  const DoubleDouble size_w = total(four([&](int i) LANE_LAMBDA { return magnitude(mw[i]); }));
  const V most_k = total(four([&](int i) LANE_LAMBDA { return magnitude(spread_k[i].hi); }));
  const V most_w = total(four([&](int i) LANE_LAMBDA { return spread[i].hi * magnitude(splat(q.w_value[i])); }));
  certain &=
      at_least(magnitude(sum_k.hi), lane_least_sum * most_k) & at_least(magnitude(sum_w.hi), lane_least_sum * most_w);

  // Quotients.
  const DoubleDouble per_w = reciprocal<fused>(sum_w), per_k = reciprocal<fused>(sum_k);
  const V margin = times(sum_w, reciprocal<fused>(size_w)).hi;
  store(flip(margin, sign_bit(sum_k.hi)), out.visible_margin);
  store(times(total(of(m, q.z)), per_w).hi, out.z_above);
  store(times(size_w, magnitude(per_w)).hi, out.z_condition);
  store(times(total(spread_k), magnitude(per_k)).hi, out.condition);
  const auto& part = q.perspective ? mk : mw;
  const DoubleDouble per = q.perspective ? per_k : per_w;
  for (int i = 0; i < 4; ++i) store(times(part[i], per).hi, out.lambda[i]);
  for (int a = 0; a < q.attributes; ++a) store(times(total(of(m, q.b[a])), per).hi, out.attribute_above[a]);

  // At most one of them holds.
  store(certain & (1 + (first & 1) + (second & 2) + (back_first & 3) + (back_second & 4)), out.decided);
}

#ifdef QUADRILLE_LANE_TARGETS
[[gnu::target("arch=x86-64-v3")]] void sample_v3(const LaneQuad& quad, LaneSamples& out) { sample<true>(quad, out); }
[[gnu::target("arch=x86-64-v4")]] void sample_v4(const LaneQuad& quad, LaneSamples& out) { sample<true>(quad, out); }
#endif

}  // namespace

void sample_lanes(const LaneQuad& quad, [[maybe_unused]] LaneTarget lanes, LaneSamples& samples) {
#ifdef QUADRILLE_LANE_TARGETS
  if (lanes == LaneTarget::v4) return sample_v4(quad, samples);
  if (lanes == LaneTarget::v3) return sample_v3(quad, samples);
#endif
  sample<false>(quad, samples);
}

}  // namespace detail
}  // namespace quadrille::golden
