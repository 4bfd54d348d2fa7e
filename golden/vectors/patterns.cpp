#include "golden/vectors/patterns.hpp"

#include <algorithm>
#include <bit>

namespace quadrille::vectors {
namespace {

/// Sums modulo 2^64; what falls outside a range is dropped there.
std::int64_t wrap(std::uint64_t v) { return static_cast<std::int64_t>(v); }

/// Bits in runs: long stretches of ones and zeros make and break carries.
std::uint64_t runs(golden::Prng& prng) {
  std::uint64_t bits = 0;
  bool one = prng.chance(0.5);
  for (int at = 0; at < 64;) {
    const int length = 1 + static_cast<int>(prng.below(16));
    if (one && at < 64) bits |= (length >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << length) - 1) << at;
    at += length;
    one = !one;
  }
  return bits;
}

std::uint64_t few_ones(golden::Prng& prng) {
  std::uint64_t bits = 0;
  for (std::uint64_t n = 1 + prng.below(4); n > 0; --n) bits |= std::uint64_t{1} << prng.below(64);
  return bits;
}

}  // namespace

std::vector<std::int64_t> corner_values(const FieldRange& range) {
  std::vector<std::int64_t> values{range.lo, range.hi, 0};
  const auto lo = static_cast<std::uint64_t>(range.lo), hi = static_cast<std::uint64_t>(range.hi);
  for (int k = 0; k < 64; ++k) {
    const std::uint64_t power = std::uint64_t{1} << k;
    for (const std::uint64_t v : {power, power - 1, power + 1}) {
      values.push_back(wrap(v));
      values.push_back(wrap(-v));
      if (range.lo > 0 && power <= hi - lo) values.push_back(wrap(lo + v));
    }
    if (range.lo > 0 && power <= hi - lo) values.push_back(wrap(hi - power));
  }
  if (lo != hi) values.push_back(wrap(lo + 1)), values.push_back(wrap(hi - 1));
  std::erase_if(values, [&](std::int64_t v) { return !range.contains(v); });
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

std::int64_t weighted(golden::Prng& prng, const FieldRange& range) {
  if (range.or_zero && prng.below(16) == 0) return 0;
  const auto lo = static_cast<std::uint64_t>(range.lo), hi = static_cast<std::uint64_t>(range.hi);
  const std::uint64_t span = hi - lo;
  const std::uint64_t size = span + 1;  // 0: all 64-bit numbers
  const auto uniform = [&] { return wrap(lo + (size == 0 ? prng.next() : prng.below(size))); };
  // One bit more than the span has, so that the remainder below reaches both halves of the range.
  const std::uint64_t mask = span >> 62 != 0 ? ~std::uint64_t{0} : std::bit_ceil(span | 1) * 2 - 1;
  const auto offset = [&](std::uint64_t bits) { return wrap(lo + (size == 0 ? bits : (bits & mask) % size)); };
  switch (prng.below(8)) {
    case 0:
      return prng.chance(0.5) ? wrap(lo + prng.below(std::min<std::uint64_t>(span, 7) + 1))
                              : wrap(hi - prng.below(std::min<std::uint64_t>(span, 7) + 1));
    case 1:
      return offset(runs(prng));
    case 2:
      return offset(prng.chance(0.5) ? few_ones(prng) : ~few_ones(prng));
    case 3:
    case 4: {  // any order of magnitude, either sign
      const std::uint64_t magnitude = prng.next() >> prng.below(64);
      const std::int64_t v = wrap(prng.chance(0.5) ? magnitude : -magnitude);
      return range.contains(v) ? v : uniform();
    }
    case 5: {  // a power of two or a neighbour
      const std::uint64_t power = (std::uint64_t{1} << prng.below(64)) + prng.below(3) - 1;
      const std::int64_t v = wrap(prng.chance(0.5) ? power : -power);
      return range.contains(v) ? v : uniform();
    }
    default:
      return uniform();
  }
}

}  // namespace quadrille::vectors
