// Sums, differences and quotients of doubles, exactly: integers with an exponent, no floating-point arithmetic, so that
// neither the platform nor the caller's rounding mode shows in a result.
//
// Each function is a template over the integer that holds a magnitude: 128 bits where the numbers lie so close together
// that all fits (NumberSpan says so, nearly always), 256 for numbers beside what sines and cosines leave of 0, else
// 2,560.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>

namespace quadrille {

/// A non-negative integer of 64 `words` bits.
template <std::size_t words>
class LongInteger {
 public:
  constexpr LongInteger() = default;
  constexpr explicit LongInteger(std::uint64_t value) { word_[0] = value; }

  int bit_length() const {
    for (std::size_t i = words; i-- > 0;)
      if (word_[i] != 0) return static_cast<int>(64 * i) + static_cast<int>(std::bit_width(word_[i]));
    return 0;
  }
  LongInteger operator<<(int bits) const {
    LongInteger out;
    const auto whole = static_cast<std::size_t>(bits / 64);
    const int part = bits % 64;
    for (std::size_t i = words; i-- > whole;) {
      out.word_[i] = word_[i - whole] << part;
      if (part != 0 && i > whole) out.word_[i] |= word_[i - whole - 1] >> (64 - part);
    }
    return out;
  }
  LongInteger operator-(const LongInteger& less) const {
    LongInteger out;
    std::uint64_t borrow = 0;
    for (std::size_t i = 0; i < words; ++i) {
      const auto difference = static_cast<unsigned __int128>(word_[i]) - less.word_[i] - borrow;
      out.word_[i] = static_cast<std::uint64_t>(difference);
      borrow = static_cast<std::uint64_t>(difference >> 64) & 1;
    }
    return out;
  }
  LongInteger operator+(const LongInteger& more) const {
    LongInteger out;
    unsigned __int128 carry = 0;
    for (std::size_t i = 0; i < words; ++i) {
      carry += static_cast<unsigned __int128>(word_[i]) + more.word_[i];
      out.word_[i] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
    return out;
  }
  LongInteger operator*(std::uint64_t factor) const {
    LongInteger out;
    unsigned __int128 carry = 0;
    for (std::size_t i = 0; i < words; ++i) {
      carry += static_cast<unsigned __int128>(word_[i]) * factor;
      out.word_[i] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
    return out;
  }
  friend std::strong_ordering operator<=>(const LongInteger& a, const LongInteger& b) {
    for (std::size_t i = words; i-- > 0;)
      if (a.word_[i] != b.word_[i]) return a.word_[i] <=> b.word_[i];
    return std::strong_ordering::equal;
  }
  friend bool operator==(const LongInteger&, const LongInteger&) = default;

 private:
  std::array<std::uint64_t, words> word_{};
};

/// What differences and products of doubles from 2^-1074 to 2^80 need.
using WideInteger = LongInteger<40>;
using MiddleInteger = LongInteger<4>;
using NarrowInteger = unsigned __int128;

inline int bit_length(NarrowInteger value) {
  const auto high = static_cast<std::uint64_t>(value >> 64);
  return static_cast<int>(high != 0 ? 64 + std::bit_width(high) : std::bit_width(static_cast<std::uint64_t>(value)));
}
template <std::size_t words>
int bit_length(const LongInteger<words>& value) {
  return value.bit_length();
}

/// (-1)^neg m 2^exp.
template <class Integer>
struct Exact {
  bool neg = false;
  Integer m{};
  int exp = 0;

  bool zero() const { return m == Integer{}; }
  /// floor(log2 |value|) + 1, of a number that is not 0.
  int top() const { return bit_length(m) + exp; }
  Exact scaled(int bits) const { return {neg, m, exp + bits}; }
};

/// A finite double by its bits: also of subnormal ones, whatever the processor's mode does with those.
struct DoubleBits {
  bool neg;
  std::uint64_t m;  ///< below 2^53, odd or 0
  int exp;

  explicit DoubleBits(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const int field = static_cast<int>(bits >> 52 & 0x7ff);
    neg = bits >> 63 != 0;
    m = (bits & 0xfffffffffffff) | (field != 0 ? std::uint64_t{1} << 52 : 0);
    exp = (field != 0 ? field : 1) - 1075;
    if (m == 0) return;
    const int zeros = std::countr_zero(m);
    m >>= zeros;
    exp += zeros;
  }
};

/// value > 0, also of a subnormal number.
inline bool positive(double value) {
  const DoubleBits bits(value);
  return bits.m != 0 && !bits.neg;
}

template <class Integer>
Exact<Integer> exact(double value) {
  const DoubleBits bits(value);
  return {bits.neg, static_cast<Integer>(bits.m), bits.exp};
}

namespace detail {

inline std::uint64_t magnitude(std::int64_t value) {
  return value < 0 ? -static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
}

}  // namespace detail

template <class Integer>
Exact<Integer> exact_integer(std::int64_t value) {
  return {value < 0, static_cast<Integer>(detail::magnitude(value)), 0};
}

/// The binary places that numbers use, to know whether 128 bits hold what is made of them.
class NumberSpan {
 public:
  /// `value` and its products with integers below 2^below, in units of 2^-below.
  void add(double value, int below = 0) {
    const DoubleBits bits(value);
    if (bits.m == 0) return;
    high_ = std::max(high_, bits.exp + static_cast<int>(std::bit_width(bits.m)));
    low_ = std::min(low_, bits.exp - below);
  }
  /// Differences of the numbers, a product of one with an integer below 2^32, and quotient_floor() below 2^35 fit into
  /// so many bits.
  bool fits(int bits) const { return high_ - low_ <= bits - 40; }

 private:
  int high_ = -5000, low_ = 5000;
};

namespace detail {

/// Both with the lower exponent of the two.
template <class Integer>
void align(Exact<Integer>& a, Exact<Integer>& b) {
  if (a.zero()) a.exp = b.exp;
  if (b.zero()) b.exp = a.exp;
  Exact<Integer>& upper = a.exp > b.exp ? a : b;
  const int lower_exp = a.exp > b.exp ? b.exp : a.exp;
  upper.m = upper.m << (upper.exp - lower_exp);
  upper.exp = lower_exp;
}

}  // namespace detail

template <class Integer>
Exact<Integer> operator-(Exact<Integer> a, Exact<Integer> b) {
  detail::align(a, b);
  if (a.neg != b.neg) return {a.neg, a.m + b.m, a.exp};
  return a.m >= b.m ? Exact<Integer>{a.neg, a.m - b.m, a.exp} : Exact<Integer>{!a.neg, b.m - a.m, a.exp};
}

template <class Integer>
Exact<Integer> operator*(const Exact<Integer>& a, std::int64_t factor) {
  return {a.neg != (factor < 0), a.m * detail::magnitude(factor), a.exp};
}

/// |a| < |b|.
template <class Integer>
bool smaller(Exact<Integer> a, Exact<Integer> b) {
  detail::align(a, b);
  return a.m < b.m;
}

/// floor(value) of a number that is not negative, and whether anything was dropped.
struct Floor {
  std::uint64_t whole = 0;
  bool rest = false;
};

namespace detail {

inline Floor divide(NarrowInteger n, NarrowInteger d) {
  const NarrowInteger q = n / d;
  return {static_cast<std::uint64_t>(q), q * d != n};
}
template <std::size_t words>
Floor divide(LongInteger<words> n, const LongInteger<words>& d) {
  Floor out;
  for (int bit = n.bit_length() - d.bit_length(); bit >= 0; --bit) {
    const LongInteger<words> part = d << bit;
    if (n < part) continue;
    n = n - part;
    out.whole |= std::uint64_t{1} << bit;
  }
  out.rest = n != LongInteger<words>{};
  return out;
}

}  // namespace detail

/// floor(|n / d| 2^bits), below 2^35 (the caller knows by top()); d is not 0.
template <class Integer>
Floor quotient_floor(const Exact<Integer>& n, const Exact<Integer>& d, int bits) {
  if (n.zero()) return {};
  if (n.top() + bits < d.top() - 1) return {0, true};
  const int shift = n.exp + bits - d.exp;
  return shift >= 0 ? detail::divide(n.m << shift, d.m) : detail::divide(n.m, d.m << -shift);
}

/// To nearest, ties to even; `twice`: the floor of twice the number.
inline std::int64_t round_half_even(const Floor& twice) {
  const std::uint64_t down = twice.whole >> 1;
  const bool half = (twice.whole & 1) != 0;
  return static_cast<std::int64_t>(down + (half && (twice.rest || (down & 1) != 0)));
}

}  // namespace quadrille
