// How work over quads and over blocks is cut into units for threads.
#pragma once

#include <cstddef>

namespace quadrille::sweep {

/// Units of `per_unit` that hold `n`; the last may be smaller.
constexpr std::size_t units_of(std::size_t n, std::size_t per_unit) { return (n + per_unit - 1) / per_unit; }

}  // namespace quadrille::sweep
