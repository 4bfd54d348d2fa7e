// Twin of rtl/inside_expression.sv: expression (12) of Hormann & Tarini 2004 and its negation, for many places at once.
#pragma once

#include "model/records.hpp"

#include <cstdint>

namespace quadrille {

/// Bit p of each word: the sign that an edge function can take at place p, a pixel or a square of them, in which it may
/// have both.
struct EdgeSigns {
  std::uint32_t positive = 0, negative = 0;
};

/// Places that are inside, not culled: `back` by the positive form (clockwise on a y-down screen), `front` by the
/// negated one.
struct InsidePlaces {
  std::uint32_t back = 0, front = 0;
};

/// e: edges 01 12 23 30 and the diagonal 20. `visible` masks the clauses (SetupResult::visible).
inline InsidePlaces inside_expression(const EdgeSigns (&e)[5], unsigned visible, Cull cull) {
  const auto clause = [&](int bit, std::uint32_t places) { return (visible >> bit & 1) != 0 ? places : 0; };
  const std::uint32_t back1 = e[4].positive & e[0].positive & e[1].positive & (e[2].positive | e[3].positive);
  const std::uint32_t back2 = e[4].negative & e[2].positive & e[3].positive & (e[0].positive | e[1].positive);
  const std::uint32_t front1 = e[4].negative & e[0].negative & e[1].negative & (e[2].negative | e[3].negative);
  const std::uint32_t front2 = e[4].positive & e[2].negative & e[3].negative & (e[0].negative | e[1].negative);
  InsidePlaces inside;
  if (cull != Cull::back) inside.back = clause(0, back1) | clause(1, back2);
  if (cull != Cull::front) inside.front = clause(2, front1) | clause(3, front2);
  return inside;
}

}  // namespace quadrille
