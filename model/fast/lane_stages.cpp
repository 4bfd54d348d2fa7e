#include "model/fast/lane_stages.hpp"

#include "model/support/lane_target.hpp"

#include <bit>
#include <cmath>

// The vector type is wider than some targets' registers; everything that passes it is inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

// GCC's attributes choose targets beyond the baseline.
#if defined(QUADRILLE_LANE_TARGETS) && !defined(__clang__)
#define QUADRILLE_STAGE_TARGETS
#endif

namespace quadrille {
namespace {

using V = LaneReals;
using I = LaneIntegers;

#define LANE_INLINE [[gnu::always_inline]] inline
#define LANE_LAMBDA __attribute__((always_inline))

LANE_INLINE I bits(V v) { return (I)v; }
LANE_INLINE V from_bits(I v) { return (V)v; }
LANE_INLINE V splat(double v) { return V{} + v; }
LANE_INLINE I splat(std::int64_t v) { return I{} + v; }
LANE_INLINE V select(I m, V a, V b) { return from_bits((bits(a) & m) | (bits(b) & ~m)); }
LANE_INLINE I select(I m, I a, I b) { return (a & m) | (b & ~m); }
LANE_INLINE V magnitude(V v) { return from_bits(bits(v) & INT64_MAX); }
LANE_INLINE I exponent(V v) { return ((bits(v) >> 52) & 0x7ff) - 1023; }
using quadrille::power_of_two;
LANE_INLINE V power_of_two(I e) { return from_bits((e + 1023) << 52); }

LANE_INLINE unsigned to_mask(I m) {
  unsigned r = 0;
  for (int l = 0; l < lane_count; ++l) r |= static_cast<unsigned>(m[l] & 1) << l;
  return r;
}

/// Clears what lies below 2^q.
LANE_INLINE V truncate_at(V v, I q) {
  const I cut = 52 - (exponent(v) - q);  // mantissa bits below 2^q
  const I shift = cut & ~(cut >> 63);    // max(cut, 0)
  const I mask = splat(std::int64_t{-1}) << (shift & 63);
  return from_bits(bits(v) & mask & (cut <= 52));
}

/// Integer part of 0 <= v < 2^51.
LANE_INLINE V integer_part(V v) {
  const V r = (v + 0x1p52) - 0x1p52;
  return r - select(r > v, splat(1.0), V{});
}

/// |v| for |v| < 2^63 with at least 26 leading bits right, the rest cut toward zero: exact below 2^37, else the low 10
/// bits go, so that the conversion to 53 bits cannot round up.
LANE_INLINE V leading_magnitude(I v) {
  const I sign = v >> 63;
  I m = (v ^ sign) - sign;
  m &= ~(I(m >= (std::int64_t{1} << 37)) & 1023);
  const V low = from_bits((m & 0xffffffff) | 0x4330000000000000) - 0x1p52;
  const V high = from_bits((m >> 32) | 0x4530000000000000) - 0x1p84;
  return high + low;
}

#ifdef QUADRILLE_STAGE_TARGETS
template <class Body>
[[gnu::target("arch=x86-64-v4")]] void run_v4(const Body& body) {
  body();
}
template <class Body>
[[gnu::target("arch=x86-64-v3")]] void run_v3(const Body& body) {
  body();
}
#endif

/// Runs `body`, an always-inlined lambda, as compiled for the target in use.
template <class Body>
LANE_INLINE void on_lane_target(const Body& body) {
#ifdef QUADRILLE_STAGE_TARGETS
  if (lane_target() == LaneTarget::v4) return run_v4(body);
  if (lane_target() == LaneTarget::v3) return run_v3(body);
#endif
  body();
}

struct LaneArithmetic {
  I significand_mask;
  std::int64_t prec;

  LANE_INLINE LaneArithmetic(int s, int g)
      : significand_mask(splat(static_cast<std::int64_t>(~((std::uint64_t{1} << (53 - s)) - 1)))), prec(s - 1 + g) {}

  /// fp_multiply, and the truncation of every normalised result.
  LANE_INLINE V cut(V v) const { return from_bits(bits(v) & significand_mask); }
  LANE_INLINE V multiply(V a, V b) const { return cut(a * b); }

  /// fp_sum of two raw products, neither negative.
  LANE_INLINE V sum2(V a0, V b0, V a1, V b1) const {
    const V p0 = a0 * b0, p1 = a1 * b1;
    const I e0 = select(p0 != 0, exponent(a0) + exponent(b0), splat(std::int64_t{-4096}));
    const I e1 = select(p1 != 0, exponent(a1) + exponent(b1), splat(std::int64_t{-4096}));
    const I q = select(e0 > e1, e0, e1) - prec;
    return cut(truncate_at(p0, q) + truncate_at(p1, q));
  }

  /// fp_sum of the raw products m_i·v_i from vertex `first` on; `exponent_m` = exponent(m).
  template <int first = 0>
  LANE_INLINE V sum(const V* m, const I* exponent_m, const double* v) const {
    V p[4];
    I largest = splat(std::int64_t{-4096});
    for (int i = first; i < 4; ++i) {
      p[i] = m[i] * v[i];
      const std::int64_t ev = static_cast<std::int64_t>((std::bit_cast<std::uint64_t>(v[i]) >> 52) & 0x7ff) - 1023;
      const I e = select(p[i] != 0, exponent_m[i] + ev, splat(std::int64_t{-4096}));
      largest = select(e > largest, e, largest);
    }
    V sum{};
    for (int i = first; i < 4; ++i) sum += truncate_at(p[i], largest - prec);
    return cut(sum);
  }
};

/// The polynomial of table_polynomial.hpp; `fraction` has S−1 bits. Result: integer significand.
LANE_INLINE V polynomial(const LaneTable& table, I segment, I fraction, int s, bool rising) {
  V c0, c1, c2;
  for (int l = 0; l < lane_count; ++l) {
    const LaneTable::Entry& e = table.entries[static_cast<std::size_t>(segment[l])];
    c0[l] = e.c0;
    c1[l] = e.c1;
    c2[l] = e.c2;
  }
  const double scale = power_of_two(-table.rest_bits);
  const V dx = from_bits((fraction & ((std::int64_t{1} << table.rest_bits) - 1)) | 0x4330000000000000) - 0x1p52;
  const V t1 = c1 - integer_part(c2 * dx * scale);
  const V t0 = integer_part(t1 * dx * scale);
  V y = integer_part((rising ? c0 + t0 : c0 - t0) * (1.0 / (1 << Config::table_guard)));
  const V low = splat(power_of_two(s - 1)), high = splat(power_of_two(s) - 1);
  y = select(y < low, low, y);
  return select(y > high, high, y);
}

LANE_INLINE I fraction_bits(V v, int s) { return (bits(v) >> (53 - s)) & ((std::int64_t{1} << (s - 1)) - 1); }

LANE_INLINE V sqrt_lanes(V a, const LaneTable& table, int s) {
  const I e = exponent(a);
  const I odd = e & 1;
  const I half = e >> 1;
  const I fraction = fraction_bits(a, s);
  const V y = polynomial(table, (fraction >> table.rest_bits) + (odd << table.segments_log2), fraction, s, true);
  return y * power_of_two(half - (s - 1));
}

LANE_INLINE V recip_lanes(V a, const LaneTable& table, int s) {
  const I e = exponent(a);
  const I fraction = fraction_bits(a, s);
  const V y = polynomial(table, fraction >> table.rest_bits, fraction, s, false);
  const V regular = select(fraction == 0, power_of_two(-e), y * power_of_two(-e - s));
  return select(a == 0, V{}, from_bits(bits(regular) | (bits(a) & INT64_MIN)));
}

// ---- the stages ----

struct SingularMasks {
  I singular, on_edge;
};

LANE_INLINE SingularMasks singular_masks(const DifferenceLanes& p) {
  I corner{}, edges{};
  for (std::size_t i = 0; i < 4; ++i) {
    corner |= p.r2[i] <= 0;
    edges += (p.a[i] == 0) & (p.d[i] < 0);  // −1 per edge
  }
  return {corner | (edges <= -2), edges == -1};
}

LANE_INLINE void normalise_stage(const DifferenceLanes& p, const LaneArithmetic& arithmetic, double a_scale,
                                 NormalisedLanes& out) {
  for (std::size_t k = 0; k < 6; ++k) {
    out.a[k] = arithmetic.cut(leading_magnitude(p.a[k])) * a_scale;
    out.d[k] = arithmetic.cut(leading_magnitude(p.d[k]));
  }
  for (std::size_t i = 0; i < 4; ++i) out.r2[i] = arithmetic.cut(leading_magnitude(p.r2[i]));
}

LANE_INLINE void sqrt_stage(const NormalisedLanes& p, const LaneTable& table, int s, SqrtLanes& out) {
  for (int i = 0; i < 4; ++i) out.root[i] = sqrt_lanes(p.r2[i], table, s);
}

LANE_INLINE void ratio_stage(const NormalisedLanes& p, const SqrtLanes& r, const LaneArithmetic& arithmetic,
                             RatioLanes& out) {
  const V one = splat(1.0);
  for (std::size_t k = 0; k < 6; ++k) {
    out.u[k] = arithmetic.sum2(r.root[vertex_pair[k][0]], r.root[vertex_pair[k][1]], p.d[k], one);
    out.v[k] = p.a[k];
  }
}

/// sqrt(q_far / q_near) as num / den (root_ratio.hpp).
struct RootRatioLanes {
  V num, den;
};

LANE_INLINE RootRatioLanes root_ratio(const DifferenceLanes& signs, const RatioLanes& p, std::size_t near,
                                      std::size_t far, const LaneArithmetic& arithmetic, const LaneTable& table,
                                      int s) {
  const auto cancels = [&](std::size_t k) LANE_LAMBDA { return k < 4 ? I(signs.d[k] < 0) : I(signs.d[k] >= 0); };
  const I near_cancels = cancels(near), far_cancels = cancels(far);
  const V root = sqrt_lanes(arithmetic.multiply(p.u[near], p.u[far]), table, s);
  const V crossed = arithmetic.multiply(p.v[far], p.u[near]), scaled = arithmetic.multiply(p.v[near], root);
  const V num = select(near_cancels, select(far_cancels, crossed, root), select(far_cancels, p.v[far], p.u[far]));
  const V den = select(near_cancels, select(far_cancels, scaled, p.v[near]), root);
  // Exponents in balance: opposite but for one, beside a zero 0.
  const I num_used = num != 0, den_used = den != 0;
  const I sum = (exponent(num) & num_used) + (exponent(den) & den_used);
  const V move = power_of_two(-select(num_used & den_used, (sum + 1) >> 1, sum));
  return {num * move, den * move};
}

LANE_INLINE void weight_stage(const DifferenceLanes& signs, const RatioLanes& p, const LaneArithmetic& arithmetic,
                              const LaneTable& table, int s, WeightLanes& out) {
  const RootRatioLanes a = root_ratio(signs, p, 0, 2, arithmetic, table, s);
  const RootRatioLanes b = root_ratio(signs, p, 3, 1, arithmetic, table, s);
  const RootRatioLanes d = root_ratio(signs, p, 4, 5, arithmetic, table, s);
  out.m[0] = arithmetic.multiply(arithmetic.multiply(a.num, b.num), d.num);
  out.m[1] = arithmetic.multiply(arithmetic.multiply(a.num, b.den), d.den);
  out.m[2] = arithmetic.multiply(arithmetic.multiply(a.den, b.den), d.num);
  out.m[3] = arithmetic.multiply(arithmetic.multiply(a.den, b.num), d.den);
}

/// Areas in the place of mean value weights (weight_factors.cpp).
LANE_INLINE void area_stage(const DifferenceLanes& signs, const NormalisedLanes& p, WeightLanes& out) {
  const I* a = signs.a;
  const I negative = (a[0] < 0) | (a[1] < 0) | (a[2] < 0) | (a[3] < 0);
  const I behind_diagonal = I(a[4] < 0) ^ negative;
  out.m[0] = select(behind_diagonal, p.a[2], p.a[1]);
  out.m[1] = select(behind_diagonal, V{}, p.a[4]);
  out.m[2] = select(behind_diagonal, p.a[3], p.a[0]);
  out.m[3] = select(behind_diagonal, p.a[4], V{});
}

/// base + num·rec as a code, the quotient rounded to nearest, halves away from zero. A quotient of 2^int_bits or more
/// becomes one of 2^(int_bits + 2): beyond every code, of its sign.
///
/// A product has 2 S <= 52 bits: its sum with 1/2 fits a double from 1/2 on; below that the sum is at most 1 - 2^-53,
/// which no rounding mode leaves. Codes have 46 bits, 48 with what is beyond.
LANE_INLINE V sum_of_codes(V num, V rec, double base, int int_bits, int frac) {
  const V value = num * rec, size = magnitude(value) * power_of_two(frac);
  const I wide = size >= power_of_two(int_bits + frac);
  const V q = integer_part(select(wide, splat(power_of_two(int_bits + 2 + frac)), size) + 0.5);
  return base + from_bits(bits(q) | (bits(value) & INT64_MIN));
}

/// Codes, as doubles.
struct FixedLanes {
  V code;
  I over;
};

LANE_INLINE FixedLanes attribute_stage(V num, V rec, std::int64_t base, int int_bits, int frac) {
  const V sum = sum_of_codes(num, rec, static_cast<double>(base), int_bits + 1, frac);
  const V limit = splat(power_of_two(int_bits + frac) - 1);
  const I above = sum > limit, below = sum < -limit;
  return {select(above, limit, select(below, -limit, sum)), above | below};
}

struct DepthLanes {
  V code;
  I discard;
};

LANE_INLINE DepthLanes depth_stage(V num_z, V den_w, V rec_w, const QuadBase& base, int depth_bits, std::uint32_t znear,
                                   std::uint32_t zfar) {
  const V low = splat(static_cast<double>(base.depth_low)), high = splat(static_cast<double>(base.depth_high));
  const V sum = sum_of_codes(num_z, rec_w, base.depth, 1, depth_bits);
  const V at_least = select(I(sum < low), low, sum);
  const V z = select(I(at_least > high) | I(den_w == 0), high, at_least);
  return {select(I(z < 0), V{}, z), I(z < static_cast<double>(znear)) | I(z > static_cast<double>(zfar))};
}

}  // namespace

LaneTable::LaneTable(const Table& table) : segments_log2(table.segments_log2), rest_bits(table.rest_bits) {
  for (const TableEntry& e : table.entries)
    entries.push_back({static_cast<double>(e.c0), static_cast<double>(e.c1), static_cast<double>(e.c2)});
}

unsigned singular_lanes(const DifferenceLanes& d) { return to_mask(singular_masks(d).singular); }

void singular_weights(const DifferenceLanes& d, std::size_t lane, const QuadData& quad, const PipelineContext& c,
                      WeightLanes& out) {
  PixelTrace p;
  for (std::size_t k = 0; k < 6; ++k) {
    p.a[k] = d.a[k][lane];
    p.d[k] = d.d[k][lane];
  }
  for (std::size_t i = 0; i < 4; ++i) p.r2[i] = d.r2[i][lane];
  normalise(p, c);
  quadrille::sqrt_stage(p, c);
  mean_value_ratios(p, c);
  mean_value_weights(p, quad, c);
  for (std::size_t i = 0; i < 4; ++i) out.m[i][lane] = to_double(p.m[i], c.format.s);
}

void normalise_blocks(std::span<const DifferenceLanes> in, int s, int quadratic_bias, NormalisedLanes* out) {
  on_lane_target([&]() LANE_LAMBDA {
    const LaneArithmetic arithmetic(s, 0);
    const double a_scale = power_of_two(quadratic_bias);
    for (std::size_t n = 0; n < in.size(); ++n) normalise_stage(in[n], arithmetic, a_scale, out[n]);
  });
}

void sqrt_blocks(std::span<const NormalisedLanes> in, int s, const LaneTable& table, SqrtLanes* out) {
  on_lane_target([&]() LANE_LAMBDA {
    for (std::size_t n = 0; n < in.size(); ++n) sqrt_stage(in[n], table, s, out[n]);
  });
}

void ratio_blocks(std::span<const NormalisedLanes> in, const SqrtLanes* root, int s, int g, RatioLanes* out) {
  on_lane_target([&]() LANE_LAMBDA {
    const LaneArithmetic arithmetic(s, g);
    for (std::size_t n = 0; n < in.size(); ++n) ratio_stage(in[n], root[n], arithmetic, out[n]);
  });
}

void weight_blocks(std::span<const DifferenceLanes> signs, const RatioLanes* in, int s, int g, const LaneTable& table,
                   WeightLanes* out) {
  on_lane_target([&]() LANE_LAMBDA {
    const LaneArithmetic arithmetic(s, g);
    for (std::size_t n = 0; n < signs.size(); ++n) weight_stage(signs[n], in[n], arithmetic, table, s, out[n]);
  });
}

void area_blocks(std::span<const DifferenceLanes> signs, const NormalisedLanes* in, WeightLanes* out) {
  on_lane_target([&]() LANE_LAMBDA {
    for (std::size_t n = 0; n < signs.size(); ++n) area_stage(signs[n], in[n], out[n]);
  });
}

void interpolate_blocks(std::span<const WeightLanes> in, const std::uint32_t* quad, const QuadColumns* values,
                        std::size_t columns, bool depth, int s, int g, LaneColumn* sums) {
  on_lane_target([&]() LANE_LAMBDA {
    const LaneArithmetic arithmetic(s, g);
    for (std::size_t n = 0; n < in.size(); ++n, sums += sums_per_block(columns)) {
      const QuadColumns& q = values[quad[n]];
      V m[4];
      I exponent_m[4];
      for (int i = 0; i < 4; ++i) {
        m[i] = in[n].m[i];
        exponent_m[i] = exponent(m[i]);
      }
      sums[0].v = arithmetic.sum(m, exponent_m, q.k.data());
      sums[1].v = arithmetic.sum(m, exponent_m, q.w.data());
      sums[2].v = depth ? arithmetic.sum(m, exponent_m, q.z.data()) : V{};
      for (std::size_t j = 0; j < columns; ++j) sums[3 + j].v = arithmetic.sum<1>(m, exponent_m, q.b[j].data());
    }
  });
}

void reciprocal_blocks(std::size_t blocks, const LaneColumn* sums, std::size_t columns, int s, const LaneTable& table,
                       ReciprocalLanes* out) {
  on_lane_target([&]() LANE_LAMBDA {
    for (std::size_t n = 0; n < blocks; ++n, sums += sums_per_block(columns)) {
      out[n].k = recip_lanes(sums[0].v, table, s);
      out[n].w = recip_lanes(sums[1].v, table, s);
    }
  });
}

void output_blocks(std::size_t blocks, const LaneColumn* sums, const ReciprocalLanes* reciprocals,
                   const std::uint32_t* quad, const QuadColumns* quads, std::size_t columns,
                   const LaneOutputFormat& format, LaneColumn* values, LaneMasks* masks) {
  on_lane_target([&]() LANE_LAMBDA {
    const double attribute_unit = power_of_two(-format.attribute_frac);
    const double depth_unit = power_of_two(-format.depth_bits);
    for (std::size_t n = 0; n < blocks; ++n, sums += sums_per_block(columns), values += 1 + columns) {
      const QuadColumns& q = quads[quad[n]];
      I discard{}, saturated{};
      if (q.hull) discard = ~(sums[1].v > 0);
      values[0].v = V{};
      if (format.depth) {
        const DepthLanes z =
            depth_stage(sums[2].v, sums[1].v, reciprocals[n].w, q.base, format.depth_bits, format.znear, format.zfar);
        discard |= z.discard;
        values[0].v = z.code * depth_unit;
      }
      for (std::size_t j = 0; j < columns; ++j) {
        const FixedLanes f = attribute_stage(sums[3 + j].v, reciprocals[n].k, q.attribute_base[j],
                                             format.attribute_int_bits, format.attribute_frac);
        saturated |= f.over;
        values[1 + j].v = f.code * attribute_unit;
      }
      masks[n] = {static_cast<std::uint8_t>(to_mask(~discard)), static_cast<std::uint8_t>(to_mask(saturated))};
    }
  });
}

}  // namespace quadrille
