// What text and page share: how a number reads. Not for use outside this folder.
#pragma once

#include "golden/explain/explain.hpp"

#include <string>

namespace quadrille::explain {

/// "-123 / 2^30", "183250 · 2^-9", "5".
std::string stored_text(const Number& number, const std::vector<Field>& fields);
/// With up to ten significant digits.
std::string real_text(double v);
/// Of the columns exact, ulp and bound; empty where there is none.
std::string exact_text(const Number& number);
std::string ulp_text(const Number& number);
std::string bound_text(const Number& number);
/// "quad 3: drawn, and seen: nothing is nearer".
std::string headline(const Explanation& explanation);
/// A coefficient of a function, which only some readers want.
bool is_coefficient(const Stage& stage, const Number& number);
/// What "exact", "ulp" and "bound" say.
extern const char* const legend;

}  // namespace quadrille::explain
