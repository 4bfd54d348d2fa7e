// Two-fold linear interpolation against hand-made formulas, exact crossing counts, and what rotation does to it.
#include "golden/methods/twofold_test_support.hpp"
#include "model/support/prng.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::golden::methods {
namespace {

std::vector<Pixel> pixels(const std::vector<MethodSample>& samples) {
  std::vector<Pixel> out;
  for (const MethodSample& s : samples) out.emplace_back(s.x, s.y);
  return out;
}

TEST(Twofold, CornersAndEdges) {
  // Counter-clockwise on the screen, corners on pixel centres: left and upper edges belong, right and lower do not. A
  // rectangle is where the method is bilinear.
  const Points rectangle{Vec2{2.5, 3.5}, {2.5, 11.5}, {18.5, 11.5}, {18.5, 3.5}};
  const auto samples = draw_map(make_quad(rectangle, {1, 1, 1, 1}, {0, 0.25, 0.75, 0.5}));
  EXPECT_EQ(samples.size(), 16u * 8u);
  for (const auto& [pixel, s] : samples) {
    const double u = (s.x - 2) / 16.0, v = (s.y - 3) / 8.0;
    ASSERT_TRUE(u >= 0 && u < 1 && v >= 0 && v < 1);
    EXPECT_TRUE(s.front);
    EXPECT_FALSE(s.undefined);
    EXPECT_EQ(s.lambda, (Weights{(1 - u) * (1 - v), (1 - u) * v, u * v, u * (1 - v)}));
    EXPECT_EQ(s.z, u / 2 + v / 4);
  }
  EXPECT_EQ(samples.at({2, 3}).lambda, (Weights{1, 0, 0, 0}));
  EXPECT_EQ(samples.at({2, 7}).lambda, (Weights{0.5, 0.5, 0, 0}));
  EXPECT_EQ(samples.at({10, 3}).lambda, (Weights{0.5, 0, 0, 0.5}));

  for (const MethodSample& s : draw(make_quad({rectangle[0], rectangle[3], rectangle[2], rectangle[1]}))) {
    EXPECT_FALSE(s.front);
  }
}

TEST(Twofold, FractionalOffset) {
  // Row 0 at y = 0.5: left edge from (1.25, 0) to (3.25, 4) at x = 1.5, right edge from (9.75, 0) to (7.75, 4) at 9.5.
  // Columns 1 to 8; the first centre is the left crossing itself, the second a pixel of the span's 8 further on.
  const auto samples = draw_map(make_quad({Vec2{1.25, 0}, {9.75, 0}, {7.75, 4}, {3.25, 4}}));
  for (int x = 1; x <= 8; ++x) {
    const double s = (x - 1) / 8.0;
    EXPECT_EQ(samples.at({x, 0}).lambda, (Weights{(1 - s) * 0.875, s * 0.875, s * 0.125, (1 - s) * 0.125})) << x;
  }
  EXPECT_FALSE(samples.contains({0, 0}));
  EXPECT_FALSE(samples.contains({9, 0}));
  // Row 1 at y = 1.5: 2 to 9, first centre 2.5, half a pixel inside of 7.
  EXPECT_DOUBLE_EQ(samples.at({2, 1}).lambda[1], 0.5 / 7 * 0.625);
}

TEST(Twofold, ConcaveQuadHasTwoSpans) {
  // An arrow head that points up, its notch at (8, 4).
  const auto samples = draw(make_quad({Vec2{8, 0}, {-4, 12}, {8, 4}, {20, 12}}), {32, 32, false});
  std::vector<int> row;
  for (const MethodSample& s : samples) {
    EXPECT_TRUE(s.front);
    if (s.y == 6) row.push_back(s.x);
  }
  // At y = 6.5 the left leg reaches from 8 - 6.5 = 1.5, a tie that belongs, to 8 - 1.5 * 2.5 = 4.25, the right one from
  // 11.75 to 14.5, a tie that does not.
  EXPECT_EQ(row, (std::vector<int>{1, 2, 3, 12, 13}));
  // At 2.5 the way from 1.5 to 4.25 is 1/2.75 done; edge 01 is 6.5/12 down, edge 12 2.5/8 up from its notch.
  const double s = 1 / 2.75;
  for (const MethodSample& sample : samples) {
    if (sample.x != 2 || sample.y != 6) continue;
    EXPECT_NEAR(sample.lambda[0], (1 - s) * 5.5 / 12, 1e-15);
    EXPECT_NEAR(sample.lambda[1], (1 - s) * 6.5 / 12 + s * 2.5 / 8, 1e-15);
    EXPECT_NEAR(sample.lambda[2], s * 5.5 / 8, 1e-15);
    EXPECT_EQ(sample.lambda[3], 0);
  }
}

TEST(Twofold, CrossedQuadShowsBothSides) {
  // A bow tie, crossing at (8, 8): the upper part runs down on the right and is a back side, the lower one a front
  // side.
  const auto samples = draw(make_quad({Vec2{0, 0}, {16, 0}, {0, 16}, {16, 16}}), {32, 32, false});
  std::size_t above = 0, below = 0;
  for (const MethodSample& s : samples) {
    EXPECT_EQ(s.front, s.y >= 8) << s.x << ", " << s.y;
    ++(s.y < 8 ? above : below);
  }
  // Row y above holds the centres from y + 0.5, the left tie, to 15.5 - y, the right one: 15 - 2 y; below likewise.
  EXPECT_EQ(above, 64u);
  EXPECT_EQ(below, 64u);
  // A sideways bow tie has its parts beside each other in one row: two spans of a row with two signs.
  for (const MethodSample& s : draw(make_quad({Vec2{0, 0}, {0, 16}, {16, 0}, {16, 16}}), {32, 32, false})) {
    EXPECT_EQ(s.front, s.x < 8) << s.x << ", " << s.y;
  }
}

/// The method's function of the plane on a quad whose corners 0 and 2 are the highest and the lowest and 1 and 3 on the
/// left and on the right: edges and span written as lines.
Weights by_formula(const Points& p, double x, double y) {
  const auto along = [&](std::size_t i, std::size_t j) { return (y - p[i][1]) / (p[j][1] - p[i][1]); };
  Weights left{}, right{};
  if (y < p[1][1]) {
    left[0] = 1 - along(0, 1), left[1] = along(0, 1);
  } else {
    left[1] = 1 - along(1, 2), left[2] = along(1, 2);
  }
  if (y < p[3][1]) {
    right[0] = 1 - along(0, 3), right[3] = along(0, 3);
  } else {
    right[3] = 1 - along(3, 2), right[2] = along(3, 2);
  }
  double xl = 0, xr = 0;
  for (std::size_t i = 0; i < 4; ++i) xl += left[i] * p[i][0], xr += right[i] * p[i][0];
  Weights out{};
  for (std::size_t i = 0; i < 4; ++i) out[i] = (left[i] * (xr - x) + right[i] * (x - xl)) / (xr - xl);
  return out;
}

Points scaled(const Points& p, double scale) {
  Points out = p;
  for (Vec2& q : out) q[0] *= scale, q[1] *= scale;
  return out;
}

TEST(Twofold, SpansAreLinearAndFollowTheFormula) {
  constexpr int scale = 8;
  const auto samples = draw_map(make_quad(scaled(kite, scale)));
  ASSERT_GT(samples.size(), 20000u);
  for (const auto& [pixel, s] : samples) {
    const Weights expected = by_formula(kite, (s.x + 0.5) / scale, (s.y + 0.5) / scale);
    for (std::size_t i = 0; i < 4; ++i) ASSERT_NEAR(s.lambda[i], expected[i], 1e-13);
    const auto before = samples.find({s.x - 1, s.y}), after = samples.find({s.x + 1, s.y});
    if (before == samples.end() || after == samples.end()) continue;
    for (std::size_t i = 0; i < 4; ++i) {
      ASSERT_NEAR(before->second.lambda[i] + after->second.lambda[i], 2 * s.lambda[i], 1e-13);
    }
  }
}

TEST(Twofold, DerivativeJumpsAcrossTheLinesThroughMiddleCorners) {
  // The weight of corner 1 on the line x = 8, by hand. Above y = 8: on the left edge y/8 at x = 8 - y, on the right one
  // 0 at 8 + 3/2 y; so 3/5 of y/8 at x = 8, derivative 0.075. From 8 to 16: on the left edge 1 - (y - 8)/24 at
  // (y - 8)/3, at x = 8 times 1.5 y / (8 + 1.5 y - (y - 8)/3); its derivative at 8 is -1/24 * 12/20 +
  // (1.5 * 20 - 12 * (1.5 - 1/3)) / 20^2 = 0.015. A jump of -0.06. At 16 the left edge goes on, 2/3 at 8/3; the right
  // one turns from 3/2 to -3/2 at 32, so that the quotient (xr - 8) / (xr - xl), xr - 8 = 24, xr - xl = 88/3, loses
  // 3 * (88/3 - 24) / (88/3)^2 times 2/3: a jump of -3 * (16/3) / (88/3)^2 * 2/3 = -0.0123967.
  constexpr int scale = 16;
  constexpr double h = 1.0 / scale;
  const auto samples = draw_map(make_quad(scaled(kite, scale)));
  const auto value = [&](int y) {  // at x = 8, between two columns of a linear span; y counts rows
    return (samples.at({8 * scale - 1, y}).lambda[1] + samples.at({8 * scale, y}).lambda[1]) / 2;
  };
  // One-sided derivatives of second order at a line between rows y - 1 and y, from its three nearest rows.
  const auto jump = [&](int y) {
    const double below = (-2 * value(y) + 3 * value(y + 1) - value(y + 2)) / h;
    const double above = (2 * value(y - 1) - 3 * value(y - 2) + value(y - 3)) / h;
    return below - above;
  };
  EXPECT_NEAR(jump(8 * scale), -0.06, 2e-4);
  EXPECT_NEAR(jump(16 * scale), -3 * (16.0 / 3) / (88.0 / 3 * 88 / 3) * 2 / 3, 2e-4);
  for (int y = 2 * scale; y < 30 * scale; ++y) {
    if (std::abs(y - 8 * scale) <= 3 || std::abs(y - 16 * scale) <= 3) continue;
    EXPECT_LT(std::abs(jump(y)), 2e-4) << y;
  }
}

/// Mean value coordinates from half-angles (Hormann & Tarini, equations 5 and 6).
Weights mean_value(const Points& p, double x, double y) {
  Weights half_tan{}, out{};
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 &a = p[i], &b = p[(i + 1) & 3];
    const double ax = a[0] - x, ay = a[1] - y, bx = b[0] - x, by = b[1] - y;
    half_tan[i] = std::tan(std::atan2(ax * by - ay * bx, ax * bx + ay * by) / 2);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    out[i] = (half_tan[(i + 3) & 3] + half_tan[i]) / std::hypot(p[i][0] - x, p[i][1] - y);
    sum += out[i];
  }
  for (double& w : out) w /= sum;
  return out;
}

TEST(Twofold, AQuarterTurnMovesTheCreases) {
  // (x, y) -> (size - y, x) takes pixel centres to pixel centres.
  constexpr int scale = 8, size = 33 * scale;
  const View view{size, size, false};
  const Points upright = scaled(kite, scale);
  Points turned;
  for (std::size_t i = 0; i < 4; ++i) turned[i] = {size - upright[i][1], upright[i][0]};
  const auto samples = draw_map(make_quad(upright), view), others = draw_map(make_quad(turned), view);
  double most = 0;
  std::size_t common = 0;
  for (const auto& [pixel, s] : samples) {
    const auto other = others.find({size - 1 - s.y, s.x});
    if (other == others.end()) continue;  // ties on the outline
    ++common;
    EXPECT_EQ(other->second.front, s.front);
    const Weights here = mean_value(upright, s.x + 0.5, s.y + 0.5);
    const Weights there = mean_value(turned, other->second.x + 0.5, other->second.y + 0.5);
    for (std::size_t i = 0; i < 4; ++i) {
      most = std::max(most, std::abs(other->second.lambda[i] - s.lambda[i]));
      ASSERT_NEAR(here[i], there[i], 1e-11);
    }
  }
  EXPECT_GT(common + 2 * size, samples.size());
  // At the kite's point (8, 16) the weight of corner 1 is 2/3 * 24 / (88/3). Turned, the scan line there runs through
  // corners 0 and 2, and the weight is none.
  EXPECT_GT(most, 2.0 / 3 * 24 / (88.0 / 3) - 0.05);

  // Creases of the turned picture, seen in the upright one, are the column through corners 0 and 2, and no rows.
  const auto bend = [](const std::map<Pixel, MethodSample>& map, int x, int y, int dx, int dy) {
    const Weights &a = map.at({x - dx, y - dy}).lambda, &b = map.at({x, y}).lambda,
                  &c = map.at({x + dx, y + dy}).lambda;
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += std::abs(a[i] - 2 * b[i] + c[i]);
    return sum;
  };
  // The upright picture bends at row 8 and not at column 8, the turned one the other way round.
  const int row = 12 * scale, crease = 8 * scale, column = 12 * scale;
  EXPECT_GT(bend(samples, column, crease, 0, 1), 10 * bend(samples, column, crease + scale, 0, 1));
  EXPECT_LT(bend(samples, crease, row, 1, 0), 1e-12);
  EXPECT_GT(bend(others, size - 1 - row, crease, 0, 1), 10 * bend(others, size - 1 - row, crease + scale, 0, 1));
  EXPECT_LT(bend(others, size - 1 - crease, column, 1, 0), 1e-12);
}

TEST(Twofold, PerspectiveByHand) {
  // Left corners at w = 1, right ones at w = 3. In the middle of the screen weights over w are 1/4 and 1/12 each, their
  // sum 2/3: 3/8 and 1/8. z is linear on the screen in any case.
  const Points p{Vec2{0, 0}, {16, 0}, {16, 15}, {0, 15}};
  const Quad quad = make_quad(p, {1, 3, 3, 1}, {0, 1, 1, 0});
  const auto with = draw_map(quad, {32, 32, true}), without = draw_map(quad, {32, 32, false});
  const auto check = [](const Weights& lambda, double left, double right, double v) {
    const Weights expected{left * (1 - v), right * (1 - v), right * v, left * v};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(lambda[i], expected[i], 1e-15);
  };
  for (int x = 0; x < 16; ++x) {
    const double u = (x + 0.5) / 16;
    check(with.at({x, 7}).lambda, (1 - u) / (1 - u + u / 3), u / 3 / (1 - u + u / 3), 0.5);
    check(without.at({x, 7}).lambda, 1 - u, u, 0.5);
    EXPECT_NEAR(with.at({x, 7}).z, u, 1e-15);
    EXPECT_NEAR(without.at({x, 7}).z, u, 1e-15);
  }
}

TEST(Twofold, WeightsReproduceThePixel) {
  // Linear interpolation reproduces linear functions, the position for one: sum(lambda V) lies on the ray of the pixel,
  // whatever the order of edges. A span of 4000 pixels as well as short ones.
  Prng prng(3);
  for (int n = 0; n < 200; ++n) {
    const bool wide = n % 10 == 0;
    const double size = wide ? 4096 : 128;
    Points p;
    Weights w{};
    for (std::size_t i = 0; i < 4; ++i) {
      p[i] = {prng.uniform(-0.2 * size, 1.2 * size), prng.uniform(0, wide ? 8 : size)};
      w[i] = prng.log2_spread(-4, 4);
    }
    const Quad quad = make_quad(p, w);
    for (const bool perspective : {false, true}) {
      for (const MethodSample& s : draw(quad, {static_cast<int>(size), static_cast<int>(size), perspective})) {
        double sum = 0, x = 0, y = 0, sum_w = 0;
        for (std::size_t i = 0; i < 4; ++i) {
          ASSERT_TRUE(s.lambda[i] >= 0 && s.lambda[i] <= 1);
          sum += s.lambda[i];
          x += s.lambda[i] * (perspective ? quad.vertex[i].x : p[i][0]);
          y += s.lambda[i] * (perspective ? quad.vertex[i].y : p[i][1]);
          sum_w += s.lambda[i] * (perspective ? w[i] : 1);
        }
        ASSERT_NEAR(sum, 1, 1e-14);
        ASSERT_NEAR(x / sum_w, s.x + 0.5, 1e-10 * size / 128);
        ASSERT_NEAR(y / sum_w, s.y + 0.5, 1e-10 * size / 128);
      }
    }
  }
}

TEST(Twofold, TrianglesCensusAndRefusals) {
  const Points p{Vec2{1, 1}, {9, 1}, {9, 9}, {1, 9}};
  std::vector<Quad> quads{make_quad(p), make_quad({p[0], p[1], p[2], p[2]}), make_quad(p), make_quad(p)};
  quads[2].vertex[1].w = 0;
  quads[3].vertex[3].w = -1;
  const auto method = make_twofold();
  const Census expected{.quads = 4, .refused = 2, .emitted_quads = 2};
  EXPECT_EQ(method->census(quads, {}), expected);
  EXPECT_EQ(method->name(), "twofold");
  ASSERT_EQ(method->wireframe(quads[0], {}).size(), 1u);
  EXPECT_EQ(method->wireframe(quads[0], {})[0].size(), 4u);
  EXPECT_TRUE(method->wireframe(quads[2], {}).empty());
  EXPECT_EQ(draw(quads[0]).size(), 64u);
  // Row y holds the centres from the diagonal, a tie that belongs, to 8.5: 9 - y of them for y = 1 ... 8.
  EXPECT_EQ(draw(quads[1]).size(), 36u);
  EXPECT_TRUE(draw(quads[2]).empty());
  EXPECT_TRUE(draw(quads[3]).empty());
  // Clipped to the view; nothing of a quad outside of it or without area.
  EXPECT_EQ(pixels(draw(quads[0], {2, 3, true})), (std::vector<Pixel>{{1, 1}, {1, 2}}));
  EXPECT_TRUE(draw(make_quad({Vec2{-9, -9}, {-1, -9}, {-1, -1}, {-9, -1}})).empty());
  EXPECT_TRUE(draw(make_quad({Vec2{1, 1}, {9, 9}, {5, 5}, {3, 3}})).empty());
}

}  // namespace
}  // namespace quadrille::golden::methods
