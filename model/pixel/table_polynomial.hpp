// Twin of rtl/quadrille_table_polynomial.sv: one segment's polynomial in integers.
#pragma once

#include "model/port/tables.hpp"

#include <algorithm>
#include <cstdint>

namespace quadrille {

/// y = c0 ∓ (c1 - c2·dx)·dx (+ for `rising`) with truncations as in rtl/SPEC.md, Numbers; dx has table.rest_bits
/// bits. Result: S bits with the top bit set, value y / 2^S in [1/2, 1).
inline std::uint32_t table_polynomial(const TableEntry& e, std::uint32_t dx, int rest_bits, int s,
                                      bool rising = false) {
  const std::uint64_t t2 = (static_cast<std::uint64_t>(e.c2) * dx) >> rest_bits;
  const std::uint64_t t1 = e.c1 - t2;
  const std::uint64_t t0 = (t1 * dx) >> rest_bits;
  const std::uint64_t y = (rising ? e.c0 + t0 : e.c0 - t0) >> Config::table_guard;
  return static_cast<std::uint32_t>(
      std::clamp<std::uint64_t>(y, std::uint64_t{1} << (s - 1), (std::uint64_t{1} << s) - 1));
}

}  // namespace quadrille
