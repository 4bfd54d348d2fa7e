// Twin of rtl/quadrille_sqrt.sv.
#pragma once

#include "model/pixel/significand.hpp"
#include "model/pixel/table_polynomial.hpp"

namespace quadrille {

/// a^(1/2) for a > 0; zero gives zero, an even power of two is exact. Error at most 0.81 ulp with automatic tables of
/// degree 2, below 1 of degree 1 (bounds: rtl/quadrille_sqrt.sv). Domain [1, 4): the exponent's low bit selects the
/// octave.
inline PipelineFloat fp_sqrt(const PipelineFloat& a, const Table& table, const SignificandFormat& f) {
  if (a.sig == 0) return {};
  const int odd = a.exp & 1;
  const std::uint32_t fraction = a.sig - (std::uint32_t{1} << (f.s - 1));
  const std::uint32_t segment =
      (fraction >> table.rest_bits) + (static_cast<std::uint32_t>(odd) << table.segments_log2);
  const std::uint32_t dx = fraction & ((std::uint32_t{1} << table.rest_bits) - 1);
  return {false, a.exp >> 1, table_polynomial(table.entries[segment], dx, table.rest_bits, f.s, true)};
}

}  // namespace quadrille
