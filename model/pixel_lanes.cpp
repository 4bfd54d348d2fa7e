#include "model/pixel_lanes.hpp"

#include <bit>
#include <cmath>

// The vector type is wider than some targets' registers; everything that passes it is inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace quadrille {
namespace {

using V = double __attribute__((vector_size(8 * lanes)));
using I = std::int64_t __attribute__((vector_size(8 * lanes)));

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
LANE_INLINE V power_of_two(I e) { return from_bits((e + 1023) << 52); }

LANE_INLINE unsigned to_mask(I m) {
  unsigned r = 0;
  for (int l = 0; l < lanes; ++l) r |= static_cast<unsigned>(m[l] & 1) << l;
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

/// An integer 0 <= v < 2^51 held as a double.
LANE_INLINE I to_integer(V v) { return bits(v + 0x1p52) & ((std::int64_t{1} << 52) - 1); }

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

struct Kernel {
  I significand_mask;
  std::int64_t prec;

  /// fp_multiply, and the truncation of every normalised result.
  LANE_INLINE V cut(V v) const { return from_bits(bits(v) & significand_mask); }
  LANE_INLINE V multiply(V a, V b) const { return cut(a * b); }

  LANE_INLINE V sum2(V a0, V b0, V a1, V b1, I negate1) const {
    const V p0 = a0 * b0, p1 = a1 * b1;
    const I e0 = select(p0 != 0, exponent(a0) + exponent(b0), splat(std::int64_t{-4096}));
    const I e1 = select(p1 != 0, exponent(a1) + exponent(b1), splat(std::int64_t{-4096}));
    const I q = select(e0 > e1, e0, e1) - prec;
    const V t1 = from_bits(bits(truncate_at(p1, q)) ^ (negate1 & INT64_MIN));
    return cut(truncate_at(p0, q) + t1);
  }

  /// fp_sum of four raw products m_i·v_i; `exponent_m` = exponent(m).
  LANE_INLINE V sum4(const V* m, const I* exponent_m, const double* v) const {
    V p[4];
    I largest = splat(std::int64_t{-4096});
    for (int i = 0; i < 4; ++i) {
      p[i] = m[i] * v[i];
      const std::int64_t ev = static_cast<std::int64_t>((std::bit_cast<std::uint64_t>(v[i]) >> 52) & 0x7ff) - 1023;
      const I e = select(p[i] != 0, exponent_m[i] + ev, splat(std::int64_t{-4096}));
      largest = select(e > largest, e, largest);
    }
    V sum{};
    for (int i = 0; i < 4; ++i) sum += truncate_at(p[i], largest - prec);
    return cut(sum);
  }
};

/// The polynomial of table_polynomial.hpp; `fraction` has S−1 bits. Result: integer significand.
LANE_INLINE V polynomial(const std::vector<LaneTables::Entry>& table, I segment, I fraction, int rest_bits, int s) {
  V c0, c1, c2;
  for (int l = 0; l < lanes; ++l) {
    const LaneTables::Entry& e = table[static_cast<std::size_t>(segment[l])];
    c0[l] = e.c0;
    c1[l] = e.c1;
    c2[l] = e.c2;
  }
  const double scale = std::ldexp(1.0, -rest_bits);
  const V dx = from_bits((fraction & ((std::int64_t{1} << rest_bits) - 1)) | 0x4330000000000000) - 0x1p52;
  const V t1 = c1 - integer_part(c2 * dx * scale);
  const V t0 = integer_part(t1 * dx * scale);
  V y = integer_part((c0 - t0) * (1.0 / (1 << Config::table_guard)));
  const V low = splat(std::ldexp(1.0, s - 1)), high = splat(std::ldexp(1.0, s) - 1);
  y = select(y < low, low, y);
  return select(y > high, high, y);
}

LANE_INLINE I fraction_bits(V v, int s) { return (bits(v) >> (53 - s)) & ((std::int64_t{1} << (s - 1)) - 1); }

LANE_INLINE V rsqrt_lanes(V a, const Table& shape, const std::vector<LaneTables::Entry>& table, int s) {
  const I e = exponent(a);
  const I odd = e & 1;
  const I half = e >> 1;
  const I fraction = fraction_bits(a, s);
  const V y =
      polynomial(table, (fraction >> shape.rest_bits) + (odd << shape.segments_log2), fraction, shape.rest_bits, s);
  const V regular = y * power_of_two(-half - s);
  return select((fraction == 0) & (odd == 0), power_of_two(-half), regular);
}

LANE_INLINE V recip_lanes(V a, const Table& shape, const std::vector<LaneTables::Entry>& table, int s) {
  const I e = exponent(a);
  const I fraction = fraction_bits(a, s);
  const V y = polynomial(table, fraction >> shape.rest_bits, fraction, shape.rest_bits, s);
  const V regular = select(fraction == 0, power_of_two(-e), y * power_of_two(-e - s));
  return select(a == 0, V{}, from_bits(bits(regular) | (bits(a) & INT64_MIN)));
}

double to_double(const Fp& v, int s) {
  return std::ldexp(v.neg ? -static_cast<double>(v.sig) : static_cast<double>(v.sig), v.exp - (s - 1));
}

}  // namespace

QuadLanes::QuadLanes(const QuadData& quad, const PipelineContext& c) {
  const int s = c.format.s;
  for (std::size_t i = 0; i < 4; ++i) {
    k[i] = to_double(quad.k[i], s);
    w[i] = to_double(quad.w[i], s);
    z[i] = to_double(quad.z[i], s);
    for (std::size_t j = 0; j < static_cast<std::size_t>(c.state.attributes); ++j) b[j][i] = to_double(quad.b[i][j], s);
  }
}

LaneTables::LaneTables(const PipelineContext& c) {
  const auto copy = [](const Table& from, std::vector<Entry>& to) {
    for (const TableEntry& e : from.entries)
      to.push_back({static_cast<double>(e.c0), static_cast<double>(e.c1), static_cast<double>(e.c2)});
  };
  copy(c.rsqrt_table, rsqrt);
  copy(c.recip_table, recip);
}

// One clone per instruction set, chosen when the program starts; all give the same bits.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
[[gnu::target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")]]
#endif
void pixel_lanes(const TileEntry& tile, const QuadConstants& constants, const QuadData& quad, const QuadLanes& values,
                 const PipelineContext& c, const LaneTables& tables, const int* dx, const int* row, LaneResult& out) {
  const int s = c.format.s;
  const Kernel kernel{splat(static_cast<std::int64_t>(~((std::uint64_t{1} << (53 - s)) - 1))), s - 1 + c.format.g};

  // Stage 1: exact differences. Lanes of unsigned integers, since partial sums wrap.
  I x, y;
  for (int l = 0; l < lanes; ++l) {
    x[l] = dx[l];
    y[l] = row[l];
  }
  const I square = x * x + y * y;
  using U = std::uint64_t __attribute__((vector_size(8 * lanes)));
  const auto linear = [&](std::size_t k) LANE_LAMBDA {
    return I(U(U{} + static_cast<std::uint64_t>(tile.linear[k])) + U(x) * static_cast<std::uint64_t>(constants.gx[k]) +
             U(y) * static_cast<std::uint64_t>(constants.gy[k]));
  };
  const auto quadratic = [&](std::size_t k) LANE_LAMBDA {
    const QuadraticForm& f = tile.quadratic[k];
    return I(U(U{} + static_cast<std::uint64_t>(f.value)) + U(x) * static_cast<std::uint64_t>(f.gx) +
             U(y) * static_cast<std::uint64_t>(f.gy) + U(square) * static_cast<std::uint64_t>(constants.q[k]));
  };
  I a[6];
  V a_fp[6], d_fp[6], r2[4];
  I obtuse[6];
  I corner{}, edges{};
  const V a_scale = splat(std::ldexp(1.0, c.quadratic_bias));
  for (std::size_t k = 0; k < 6; ++k) {
    a[k] = linear(k);
    a_fp[k] = kernel.cut(leading_magnitude(a[k])) * a_scale;
    const I d = quadratic(k);
    obtuse[k] = d < 0;
    d_fp[k] = kernel.cut(leading_magnitude(d));
    if (k < 4) edges += (a[k] == 0) & obtuse[k];  // −1 per edge
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const I v = quadratic(6 + i);
    corner |= v <= 0;
    r2[i] = kernel.cut(leading_magnitude(v));
  }
  out.singular = to_mask(corner | (edges <= -2));
  out.on_edge = to_mask(edges == -1);

  V rho[4];
  for (int i = 0; i < 4; ++i) rho[i] = rsqrt_lanes(r2[i], c.rsqrt_table, tables.rsqrt, s);

  // Ratios.
  V n[6], d[6];
  const V one = splat(1.0);
  for (std::size_t k = 0; k < 6; ++k) {
    const V scale = kernel.multiply(rho[vertex_pair[k][0]], rho[vertex_pair[k][1]]);
    const V u = kernel.sum2(one, one, d_fp[k], scale, I{});
    const V v = kernel.multiply(a_fp[k], scale);
    n[k] = select(obtuse[k], u, v);
    d[k] = select(obtuse[k], v, u);
  }

  // Weights.
  I differ[4], any{};
  for (int i = 0; i < 4; ++i) {
    const int h = (i + 3) % 4;
    differ[i] = ((a[h] < 0) & (a[i] > 0)) | ((a[h] > 0) & (a[i] < 0));
    any |= differ[i];
  }
  const I cured = c.config.notch_exact ? any : I{};
  out.cured = to_mask(cured) & ~out.singular;
  const V factor_of[2] = {kernel.multiply(n[5], d[4]), kernel.multiply(n[4], d[5])};
  const V plain = select(cured, kernel.multiply(d[5], d[4]), one);
  V m[4];
  I exponent_m[4];
  for (int i = 0; i < 4; ++i) {
    const int h = (i + 3) % 4;
    const I cure = cured & differ[i];
    const V lead =
        magnitude(kernel.sum2(n[h], select(cure, n[i], d[i]), select(cure, d[i], n[i]), d[h], differ[i] & ~cured));
    const V denominators = kernel.multiply(d[(i + 1) % 4], d[(i + 2) % 4]);
    const V factor = select(cure, factor_of[i % 2], plain);
    m[i] = kernel.multiply(kernel.multiply(lead, denominators), kernel.multiply(rho[i], factor));
    exponent_m[i] = exponent(m[i]);
  }

  // Sums, reciprocals, fixed point.
  const V den_k = kernel.sum4(m, exponent_m, values.k.data());
  const V den_w = kernel.sum4(m, exponent_m, values.w.data());
  const V rec_k = recip_lanes(den_k, c.recip_table, tables.recip, s);
  const double scale_a = std::ldexp(1.0, c.attribute_frac);
  const double limit_a = std::ldexp(1.0, c.config.attribute_int_bits);
  const V largest_a = splat(std::ldexp(1.0, c.config.attribute_int_bits + c.attribute_frac) - 1);
  I saturated{};
  for (std::size_t j = 0; j < static_cast<std::size_t>(c.state.attributes); ++j) {
    const V value = kernel.sum4(m, exponent_m, values.b[j].data()) * rec_k;
    const V size = magnitude(value);
    const I over = size >= limit_a;
    saturated |= over;
    const I q = to_integer(select(over, largest_a, integer_part(select(over, V{}, size) * scale_a)));
    const I sign = bits(value) >> 63;
    const I fixed = (q ^ sign) - sign;
    for (int l = 0; l < lanes; ++l) out.attribute[j][static_cast<std::size_t>(l)] = fixed[l];
  }
  out.saturated = to_mask(saturated);
  I discard{};
  if (quad.hull) discard = ~(den_w > 0);
  if (c.state.depth) {
    const V rec_w = recip_lanes(den_w, c.recip_table, tables.recip, s);
    const V value = kernel.sum4(m, exponent_m, values.z.data()) * rec_w;
    const V size = magnitude(value);
    const I over = (size >= 2.0) | (den_w == 0);
    const I q = select(over, splat((std::int64_t{2} << c.config.depth_bits) - 1),
                       to_integer(integer_part(select(over, V{}, size) * std::ldexp(1.0, c.config.depth_bits))));
    const I negative = (bits(value) >> 63) & (q != 0) & ~I(den_w == 0);
    discard |= negative | (q < std::int64_t{c.znear}) | (q > std::int64_t{c.zfar});
    for (int l = 0; l < lanes; ++l) out.depth[static_cast<std::size_t>(l)] = static_cast<std::uint32_t>(q[l]);
  } else {
    out.depth = {};
  }
  out.drawn = to_mask(~discard);
}

}  // namespace quadrille
