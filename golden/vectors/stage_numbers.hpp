// Numbers that occur in records of stages (rtl/SPEC.md, Numbers).
#pragma once

#include "model/port/config.hpp"

namespace quadrille::vectors {

/// The most negative value does not.
inline bool fits(__int128 v, int bits) {
  const __int128 limit = static_cast<__int128>(1) << (bits - 1);
  return v > -limit && v < limit;
}

/// Exponents that occur.
struct Exponents {
  int a_lo, a_hi;      ///< A: its bit 0 is 2^-QDROP beside D's
  int d_hi;            ///< D and r², from 0
  int root_hi;         ///< of r, from 0
  int u_hi;            ///< r r' + |D|, from 0
  int m_lo, m_hi;      ///< weights: within 2^±120, or of two edges a number of the port and two of r
  int sum_lo, sum_hi;  ///< sums: a weight times a number of the port, with cancellation

  explicit Exponents(const Config& c) {
    const int port = 1 << (Config::port_exp_bits - 1), cancelled = c.prec_bits() + 1;
    a_lo = -c.qdrop();
    a_hi = c.val_bits() - 2 - c.qdrop();
    d_hi = c.qval_bits() - 2;
    root_hi = c.qval_bits() / 2;
    u_hi = 2 * root_hi + 2;
    m_lo = -port - cancelled;
    m_hi = port + 2 * root_hi + 4;
    sum_lo = m_lo - port - cancelled;
    sum_hi = m_hi + port + 2;
  }
};

/// Zero has no sign and no exponent.
template <class Number>
void clear_zero(Number& v) {
  if (v.sig == 0) v = {};
}

}  // namespace quadrille::vectors
