// What the tests of twofold share.
#pragma once

#include "golden/methods/builders.hpp"
#include "golden/methods/quad_test_support.hpp"

namespace quadrille::golden::methods {
namespace {

using test::Pixel;
using Points = std::array<Vec2, 4>;
using Weights = std::array<double, 4>;

inline Quad make_quad(const Points& p, const Weights& w = {1, 1, 1, 1}, const Weights& z = {}) {
  Quad quad;
  for (std::size_t i = 0; i < 4; ++i) quad.vertex[i] = {p[i][0] * w[i], p[i][1] * w[i], z[i] * w[i], w[i]};
  return quad;
}

inline std::vector<MethodSample> draw(const Quad& quad, const View& view = {}) {
  return test::draw(*make_twofold(), quad, view);
}

inline std::map<Pixel, MethodSample> draw_map(const Quad& quad, const View& view = {}) {
  return test::by_pixel(*make_twofold(), quad, view);
}

// Middle corners at y = 8 on the left and y = 16 on the right.
constexpr Points kite{Vec2{8, 0}, {0, 8}, {8, 32}, {32, 16}};

}  // namespace
}  // namespace quadrille::golden::methods
