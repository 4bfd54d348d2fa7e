// 2^e as a double.
#pragma once

#include <bit>
#include <cstdint>

namespace quadrille {

/// Of the exponents of normal doubles, without the library call.
constexpr double power_of_two(int e) { return std::bit_cast<double>(static_cast<std::uint64_t>(e + 1023) << 52); }

}  // namespace quadrille
