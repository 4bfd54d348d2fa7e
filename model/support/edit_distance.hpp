// How far a misspelt name is from a right one, for "did you mean".
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille {

/// Levenshtein distance: insertions, deletions and substitutions of single characters.
inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row.back();
}

/// Capitals of a name as small letters: who writes SIGNIFICAND_BITS, as the RTL does, means significand_bits.
inline std::string without_capitals(std::string_view name) {
  std::string small(name);
  for (char& c : small)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return small;
}

/// The one of `names` that `given` was probably meant to be: one to three edits away, by its length, or holding it;
/// capitals count for nothing.
/// Empty when none is: a hint that is far off only misleads.
template <class Names, class Projection = std::identity>
std::string nearest_name(std::string_view given, const Names& names, Projection name_of = {}) {
  std::size_t distance = given.size() <= 3 ? 2 : given.size() <= 8 ? 3 : 4;
  std::string nearest;
  const std::string small = without_capitals(given);
  for (const auto& element : names) {
    const std::string name(std::invoke(name_of, element));
    const std::string small_name = without_capitals(name);
    const bool part = small.size() >= 3 && small_name.find(small) != std::string::npos;
    const std::size_t d = small == small_name ? 0 : part ? 1 : edit_distance(small, small_name);
    if (d < distance) distance = d, nearest = name;
  }
  return nearest;
}

/// `; did you mean "NAME"?` for the nearest name, or nothing.
template <class Names, class Projection = std::identity>
std::string did_you_mean(std::string_view given, const Names& names, Projection name_of = {}) {
  const std::string nearest = nearest_name(given, names, name_of);
  return nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?";
}

}  // namespace quadrille
