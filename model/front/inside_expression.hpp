// Twin of rtl/quadrille_inside_expression.sv: expression (12) of Hormann & Tarini 2004 and its negation, for many
// places at once.
#pragma once

#include "model/port/records.hpp"

#include <cstdint>

namespace quadrille {

/// Bit p of each word: the sign that an edge function can take at place p, a pixel or a square of them, in which it may
/// have both.
template <class Word>
struct SignWords {
  Word positive = 0, negative = 0;
};
using EdgeSigns = SignWords<std::uint32_t>;

/// Places that are inside, not culled: `back` by the positive form (clockwise on a y-down screen), `front` by the
/// negated one.
template <class Word>
struct PlaceWords {
  Word back = 0, front = 0;
};
using InsidePlaces = PlaceWords<std::uint32_t>;

/// e: edges 01 12 23 30 and the diagonal 20. `visible` masks the clauses (SetupResult::visible).
///
/// Always inlined: code for several instruction sets calls it, and of a copy of its own the linker would keep one for
/// all of them.
template <class Word>
[[gnu::always_inline]] inline PlaceWords<Word> inside_expression(const SignWords<Word> (&e)[5], unsigned visible,
                                                                 Cull cull) {
  const auto clause = [&](int bit, Word places) { return (visible >> bit & 1) != 0 ? places : 0; };
  const Word back1 = e[4].positive & e[0].positive & e[1].positive & (e[2].positive | e[3].positive);
  const Word back2 = e[4].negative & e[2].positive & e[3].positive & (e[0].positive | e[1].positive);
  const Word front1 = e[4].negative & e[0].negative & e[1].negative & (e[2].negative | e[3].negative);
  const Word front2 = e[4].positive & e[2].negative & e[3].negative & (e[0].negative | e[1].negative);
  PlaceWords<Word> inside;
  if (cull != Cull::back) inside.back = clause(0, back1) | clause(1, back2);
  if (cull != Cull::front) inside.front = clause(2, front1) | clause(3, front2);
  return inside;
}

}  // namespace quadrille
