// What the tests of creases share.
#pragma once

#include "tb/studies/compare/test_support.hpp"

#include <limits>

namespace quadrille::compare {
namespace {

using golden::Vec2;
using golden::methods::Quad;
using test::paint;
using Values = std::vector<double>;
using Pair = std::array<std::uint32_t, 2>;

constexpr std::uint32_t none = AttributeImage::no_quad;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Corners at window positions, w = 1, z = 0; the attribute of a corner is its position.
inline Quad flat_quad(const std::array<Vec2, 4>& corner) {
  Quad quad;
  for (std::size_t i = 0; i < 4; ++i) {
    quad.vertex[i] = {corner[i][0], corner[i][1], 0, 1};
    quad.attribute[i] = {corner[i][0], corner[i][1]};
  }
  return quad;
}

constexpr std::array<Vec2, 4> convex{{{0.11, 0.23}, {0.82, 0.07}, {0.91, 0.77}, {0.19, 0.93}}};
/// Corner 2 is reflex: the diagonal 0-2 is inside, 1-3 outside.
constexpr std::array<Vec2, 4> concave{{{0.1, 0.1}, {0.9, 0.2}, {0.5, 0.5}, {0.2, 0.9}}};

}  // namespace
}  // namespace quadrille::compare
