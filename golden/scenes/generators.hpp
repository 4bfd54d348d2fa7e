// Tables of generators: what is known of each, and the function that makes its quads. Not for use outside this folder.
#pragma once

#include <array>
#include <cstddef>

namespace quadrille::golden {

/// The `info` of each generator of a table, in order.
template <class Generator, std::size_t N>
constexpr auto infos_of(const std::array<Generator, N>& generators) {
  std::array<decltype(Generator::info), N> infos{};
  for (std::size_t i = 0; i < N; ++i) infos[i] = generators[i].info;
  return infos;
}

}  // namespace quadrille::golden
