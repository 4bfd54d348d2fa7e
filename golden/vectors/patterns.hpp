// Values on which arithmetic goes wrong: the ends of a range, powers of two and their neighbours, and weighted random
// numbers (runs of equal bits, few ones, any order of magnitude), after TestFloat.
#pragma once

#include "model/support/prng.hpp"

#include <cstdint>
#include <vector>

namespace quadrille::vectors {

/// Whole numbers from lo to hi, both included; with `or_zero` also 0.
struct FieldRange {
  std::int64_t lo = 0, hi = 0;
  bool or_zero = false;

  bool contains(std::int64_t v) const { return (v >= lo && v <= hi) || (or_zero && v == 0); }
};

/// The ends and their neighbours, 0, ±2^k and ±2^k ± 1; for a range above 0 also lo + 2^k and its neighbours, hi − 2^k.
/// Rising, each once.
std::vector<std::int64_t> corner_values(const FieldRange& range);

/// A number of the range, weighted.
std::int64_t weighted(golden::Prng& prng, const FieldRange& range);

}  // namespace quadrille::vectors
