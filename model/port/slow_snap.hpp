// For tests: what snap_quad must give, from rtl/SPEC.md, Snapping, step by step in sums, products and comparisons of
// numbers m 2^e of any length. A quotient is found bit by bit. Nothing of the model's arithmetic is used.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace quadrille::slow {

/// (-1)^neg sum of digit[i] 2^(32 i + exp).
struct Number {
  bool neg = false;
  std::vector<std::uint32_t> digit;
  int exp = 0;

  Number() = default;
  /// By the library, so in a processor's default mode alone.
  explicit Number(double v) : neg(std::signbit(v)) {
    int e = 0;
    const auto m = static_cast<std::uint64_t>(std::ldexp(std::frexp(std::fabs(v), &e), 53));
    digit = {static_cast<std::uint32_t>(m), static_cast<std::uint32_t>(m >> 32)};
    exp = e - 53;
    trim();
  }
  void trim() {
    while (!digit.empty() && digit.back() == 0) digit.pop_back();
    if (digit.empty()) *this = Number(false);
  }
  bool zero() const { return digit.empty(); }
  Number size() const { return with_sign(false); }
  Number with_sign(bool sign) const {
    Number n = *this;
    n.neg = sign;
    return n;
  }
  Number times_power(int e) const {
    Number n = *this;
    n.exp += e;
    return n;
  }
  /// Digits from 2^to on, to <= exp.
  std::vector<std::uint32_t> digits_from(int to) const {
    const int shift = exp - to;
    std::vector<std::uint32_t> out(static_cast<std::size_t>(shift / 32), 0);
    std::uint64_t carry = 0;
    for (const std::uint32_t d : digit) {
      carry |= std::uint64_t{d} << shift % 32;
      out.push_back(static_cast<std::uint32_t>(carry));
      carry >>= 32;
    }
    out.push_back(static_cast<std::uint32_t>(carry));
    return out;
  }

 private:
  explicit Number(bool) {}
};

/// -1, 0, 1 for |a| <, =, > |b|.
inline int compare_sizes(const Number& a, const Number& b) {
  if (a.zero() || b.zero()) return static_cast<int>(b.zero()) - static_cast<int>(a.zero());
  const int low = std::min(a.exp, b.exp);
  auto x = a.digits_from(low), y = b.digits_from(low);
  const std::size_t n = std::max(x.size(), y.size());
  x.resize(n), y.resize(n);
  for (std::size_t i = n; i-- > 0;)
    if (x[i] != y[i]) return x[i] < y[i] ? -1 : 1;
  return 0;
}

inline Number operator+(const Number& a, const Number& b) {
  if (a.zero()) return b;
  if (b.zero()) return a;
  if (a.neg != b.neg && compare_sizes(a, b) < 0) return b + a;
  const int low = std::min(a.exp, b.exp);
  auto x = a.digits_from(low), y = b.digits_from(low);
  const std::size_t n = std::max(x.size(), y.size()) + 1;
  x.resize(n), y.resize(n);
  std::int64_t carry = 0;
  for (std::size_t i = 0; i < n; ++i) {
    carry += std::int64_t{x[i]} + (a.neg == b.neg ? std::int64_t{y[i]} : -std::int64_t{y[i]});
    x[i] = static_cast<std::uint32_t>(carry);
    carry >>= 32;
  }
  Number sum;
  sum.neg = a.neg;
  sum.exp = low;
  sum.digit = x;
  sum.trim();
  return sum;
}
inline Number operator-(const Number& a, const Number& b) { return a + b.with_sign(!b.neg); }
inline Number operator*(const Number& a, const Number& b) {
  Number out;
  out.neg = a.neg != b.neg;
  out.exp = a.exp + b.exp;
  out.digit.assign(a.digit.size() + b.digit.size() + 1, 0);
  for (std::size_t i = 0; i < a.digit.size(); ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; i + j < out.digit.size(); ++j) {
      carry += out.digit[i + j] + (j < b.digit.size() ? std::uint64_t{a.digit[i]} * b.digit[j] : 0);
      out.digit[i + j] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
  }
  out.trim();
  return out;
}
inline Number integer(std::int64_t v) { return Number(static_cast<double>(v)); }  // below 2^53

/// n/d as an integer, ties to even or up; of large ones the sign and 2^50.
enum class Ties { even, up };
inline std::int64_t nearest(const Number& n, const Number& d, Ties ties) {
  std::int64_t q = 0;
  for (int bit = 50; bit >= 0; --bit) {
    const std::int64_t more = q | std::int64_t{1} << bit;
    if (compare_sizes(integer(more) * d, n) <= 0) q = more;
  }
  const Number rest = (n.size() - (integer(q) * d).size()).times_power(1);
  const int half = compare_sizes(rest, d);
  const bool neg = n.neg != d.neg;
  if (half > 0 || (half == 0 && (ties == Ties::even ? q % 2 != 0 : !neg))) ++q;
  return neg ? -q : q;
}

/// n/d with S significant bits, ties to even; 0 below the port's range.
inline PortNumber port_number(const Number& n, const Number& d, const Config& c) {
  if (n.zero()) return {};
  int e = -300;
  while (e < 300 && compare_sizes(n, d.times_power(e + 1)) >= 0) ++e;
  if (e == -300) return {};
  std::int64_t sig = nearest(n.size().times_power(c.significand_bits - 1 - e), d.size(), Ties::even);
  if (sig == std::int64_t{1} << c.significand_bits) sig /= 2, ++e;
  if (e < -256) return {};
  return {n.neg != d.neg, e, static_cast<std::uint32_t>(sig)};
}

/// Of a quad that snap_quad does not refuse.
inline SnappedQuad snap_quad(const WindowQuad& quad, const Config& c, const DrawState& state) {
  SnappedQuad out;
  out.id = quad.id;
  const Number one(1.0);
  std::size_t attributes = 0;
  for (const auto& a : quad.attribute)
    attributes = std::max(attributes, std::min(a.size(), static_cast<std::size_t>(c.attribute_slots)));
  const auto given = [&](std::size_t i, std::size_t j) {
    return Number(j < quad.attribute[i].size() ? quad.attribute[i][j] : 0.0);
  };
  const std::int64_t limit = (std::int64_t{1} << (c.attribute_int_bits + c.attribute_frac())) - 1;
  for (std::size_t j = 0; j < attributes; ++j)
    out.base.attribute[j] =
        std::clamp(nearest(given(0, j).times_power(c.attribute_frac()), one, Ties::even), -limit, limit);

  const std::int32_t depth_one = 1 << c.depth_bits;
  bool all_in_front = true, anchored = false;
  for (const WindowVertex& v : quad.vertex) {
    const Number w(v.w), z(v.z);
    const bool in_front = !w.zero() && !w.neg;
    all_in_front = all_in_front && in_front;
    if (!in_front || anchored) continue;
    anchored = true;
    const std::int64_t code = nearest(z.times_power(c.depth_bits), w, Ties::even);
    out.base.depth = static_cast<std::uint32_t>(std::clamp<std::int64_t>(code, 0, depth_one));
  }
  out.base.depth_low = all_in_front ? depth_one + 1 : -1;
  out.base.depth_high = all_in_front ? -1 : depth_one + 1;

  for (std::size_t i = 0; i < 4; ++i) {
    const WindowVertex& v = quad.vertex[i];
    SnappedVertex& s = out.vertex[i];
    const Number w(v.w), z(v.z), half = w.times_power(-1), x = Number(v.x) - half, y = Number(v.y) - half;
    Number extent = w.size();
    bool ordinary = false;
    if (!w.zero() && !w.neg) {
      const std::int64_t gx = nearest(x.times_power(c.subpixel_bits), w, Ties::even);
      const std::int64_t gy = nearest(y.times_power(c.subpixel_bits), w, Ties::even);
      ordinary = std::max(std::abs(gx), std::abs(gy)) < std::int64_t{1} << (c.pos_int() + c.subpixel_bits);
      if (ordinary) {
        s.x = static_cast<std::int32_t>(gx << c.homogeneous_frac_bits);
        s.y = static_cast<std::int32_t>(gy << c.homogeneous_frac_bits);
        s.w = 1 << c.frac();
      }
    }
    if (!ordinary) {
      for (const Number& at : {x.times_power(-c.pos_int()), y.times_power(-c.pos_int())})
        if (compare_sizes(at, extent) > 0) extent = at.size();
      s.x = static_cast<std::int32_t>(nearest(x.times_power(c.frac()), extent, Ties::even));
      s.y = static_cast<std::int32_t>(nearest(y.times_power(c.frac()), extent, Ties::even));
      s.w = static_cast<std::int32_t>(nearest(w.times_power(c.frac()), extent, Ties::even));
    }
    s.k = port_number(one, extent, c);
    s.z = port_number(z - w * integer(out.base.depth).times_power(-c.depth_bits), extent, c);
    if (all_in_front) {
      const std::int64_t code = nearest(z.times_power(c.depth_bits), w, Ties::up);
      const auto in_range = static_cast<std::int32_t>(std::clamp<std::int64_t>(code, -1, depth_one + 1));
      out.base.depth_low = std::min(out.base.depth_low, in_range);
      out.base.depth_high = std::max(out.base.depth_high, in_range);
    }
    if (i == 0) continue;
    for (std::size_t j = 0; j < attributes; ++j) {
      if ((given(i, j) - given(0, j)).zero()) continue;
      const Number above = given(i, j) - integer(out.base.attribute[j]).times_power(-c.attribute_frac());
      s.attribute[j] = state.perspective ? port_number(above, extent, c)
                                         : port_number((above * integer(s.w)).times_power(-c.frac()), one, c);
    }
  }
  return out;
}

}  // namespace quadrille::slow
