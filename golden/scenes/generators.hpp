// Tables of generators: what is known of each, the function that makes its quads, and a check of what is asked of it.
// Not for use outside this folder.
#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace quadrille::golden {

/// The `info` of each generator of a table, in order.
template <class Generator, std::size_t N>
constexpr auto infos_of(const std::array<Generator, N>& generators) {
  std::array<decltype(Generator::info), N> infos{};
  for (std::size_t i = 0; i < N; ++i) infos[i] = generators[i].info;
  return infos;
}

/// Throws std::invalid_argument for numbers of attributes other than 0 to `most`.
inline void check_attributes(const std::string& of, int attributes, int most) {
  if (attributes < 0 || attributes > most)
    throw std::invalid_argument(of + ": " + std::to_string(attributes) + " attributes (0 to " + std::to_string(most) +
                                ")");
}

}  // namespace quadrille::golden
