// A small deterministic generator: the same numbers on every machine and library, unlike the distributions of <random>.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace quadrille::golden {

/// Numbers made of the 64-bit words of a source: each draw takes one word of Source::next() (an empty range none), and
/// uses only integer arithmetic and the exactly rounded + − × ÷, so sequences are bit-identical everywhere.
template <class Source>
class RandomNumbers {
 public:
  /// Integer in [0, n), n ≥ 1. Bias below n/2^64.
  std::uint64_t below(std::uint64_t n) {
    return static_cast<std::uint64_t>((static_cast<unsigned __int128>(word()) * n) >> 64);
  }
  /// Integer in [lo, hi], both included; lo when the range is empty.
  std::int64_t integer(std::int64_t lo, std::int64_t hi) {
    return hi <= lo ? lo : lo + static_cast<std::int64_t>(below(static_cast<std::uint64_t>(hi - lo) + 1));
  }
  /// In [0, 1), 53 bits.
  double uniform() { return static_cast<double>(word() >> 11) * 0x1p-53; }
  double uniform(double lo, double hi) { return lo + (hi - lo) * uniform(); }
  bool chance(double probability) { return uniform() < probability; }
  double sign() { return (word() >> 63) != 0 ? -1.0 : 1.0; }

  /// 2^e(lo..hi) with a uniform exponent, linear inside an octave: spreads over orders of magnitude without a
  /// logarithm.
  double log2_spread(double lo_exponent, double hi_exponent) {
    const double e = uniform(lo_exponent, hi_exponent);
    const double whole = std::floor(e);
    return std::ldexp(1.0 + (e - whole), static_cast<int>(whole));
  }

  template <typename Container>
  void shuffle(Container& c) {
    for (std::size_t i = c.size(); i > 1; --i) std::swap(c[i - 1], c[below(i)]);
  }

 private:
  std::uint64_t word() { return static_cast<Source&>(*this).next(); }
};

/// xoshiro256** (Blackman, Vigna 2018), its state filled by splitmix64.
class Prng : public RandomNumbers<Prng> {
 public:
  /// `stream` gives independent sequences for one seed.
  explicit Prng(std::uint64_t seed, std::uint64_t stream = 0) {
    seed ^= stream * 0xd1342543de82ef95u;
    for (std::uint64_t& word : state_) {
      seed += 0x9e3779b97f4a7c15u;
      std::uint64_t z = seed;
      z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
      z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
      word = z ^ (z >> 31);
    }
  }

  std::uint64_t next() {
    const std::uint64_t result = rotl(state_[1] * 5, 7) * 9;
    const std::uint64_t t = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = rotl(state_[3], 45);
    return result;
  }

 private:
  static std::uint64_t rotl(std::uint64_t x, int k) { return (x << k) | (x >> (64 - k)); }
  std::array<std::uint64_t, 4> state_{};
};

}  // namespace quadrille::golden
