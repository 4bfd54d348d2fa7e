// What the tests of line jump share.
#pragma once

#include "tb/studies/compare/line_jump.hpp"
#include "tb/studies/compare/test_support.hpp"

#include <limits>

namespace quadrille::compare {
namespace {

using golden::Vec2;
using test::paint;
using Values = std::vector<double>;
using Pair = std::array<std::uint32_t, 2>;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr Pair inside{0, 0}, edge{0, 1};

}  // namespace
}  // namespace quadrille::compare
