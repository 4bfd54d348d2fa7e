// Twin of rtl/quadrille_reciprocal.sv.
#pragma once

#include "model/pixel/significand.hpp"
#include "model/pixel/table_polynomial.hpp"

namespace quadrille {

/// 1/a with a's sign; zero gives zero, a power of two is exact. Error at most 0.81 ulp with automatic tables of degree
/// 2, below 1 of degree 1 (bounds: rtl/quadrille_reciprocal.sv).
inline PipelineFloat reciprocal(const PipelineFloat& a, const Table& table, const SignificandFormat& f) {
  if (a.sig == 0) return {};
  const std::uint32_t fraction = a.sig - (std::uint32_t{1} << (f.s - 1));
  if (fraction == 0) return {a.neg, -a.exp, a.sig};
  const std::uint32_t dx = fraction & ((std::uint32_t{1} << table.rest_bits) - 1);
  return {a.neg, -a.exp - 1, table_polynomial(table.entries[fraction >> table.rest_bits], dx, table.rest_bits, f.s)};
}

}  // namespace quadrille
