// What text and page share: how a number reads. Not for use outside this folder.
#pragma once

#include "golden/explain/explain.hpp"

#include <string>

namespace quadrille::explain {

/// "-123 / 2^30", "183250 · 2^-9", "5", "0b11110000" of masks.
std::string stored_text(const Number& number, const std::vector<Field>& fields);
/// A value with its unit; empty of an integer, which stands for itself.
std::string value_text(const Number& number);
/// With up to ten significant digits.
std::string real_text(double v);
/// Of the columns exact, ulp and bound; empty where there is none.
std::string exact_text(const Number& number);
std::string ulp_text(const Number& number);
std::string bound_text(const Number& number);
/// "quad 3: drawn".
std::string headline(const Explanation& explanation);
/// The rule as a sentence.
std::string sentence(const std::string& why);
/// A coefficient of a function, which only some readers want.
bool is_coefficient(const Stage& stage, const Number& number);
/// What the columns say.
extern const char* const legend;

}  // namespace quadrille::explain
