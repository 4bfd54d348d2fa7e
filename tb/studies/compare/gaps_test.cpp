#include "tb/studies/compare/creases.hpp"
#include "tb/studies/compare/creases_test_support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <utility>

namespace quadrille::compare {
namespace {

std::vector<std::pair<Pair, std::array<Vec2, 2>>> listed(const std::vector<Quad>& quads) {
  std::vector<std::pair<Pair, std::array<Vec2, 2>>> list;
  for (const SharedEdge& e : shared_edges(quads)) list.emplace_back(e.quad, e.window);
  return list;
}

/// Two by two squares of 10; 0 1 above 2 3.
std::vector<Quad> grid() {
  std::vector<Quad> quads;
  for (const double y : {0.0, 10.0})
    for (const double x : {0.0, 10.0})
      quads.push_back(flat_quad({{{x, y}, {x + 10, y}, {x + 10, y + 10}, {x, y + 10}}}));
  return quads;
}

TEST(SharedEdges, OfAGrid) {
  using Expected = decltype(listed({}));
  const Expected expected{{{0, 1}, {{{10, 0}, {10, 10}}}},
                          {{0, 2}, {{{0, 10}, {10, 10}}}},
                          {{1, 3}, {{{10, 10}, {20, 10}}}},
                          {{2, 3}, {{{10, 10}, {10, 20}}}}};
  EXPECT_EQ(listed(grid()), expected);
  // Corners in another order, the other way round, other homogeneous coordinates.
  std::vector<Quad> quads = grid();
  std::reverse(quads[3].vertex.begin(), quads[3].vertex.end());
  std::reverse(quads[3].attribute.begin(), quads[3].attribute.end());
  std::rotate(quads[1].vertex.begin(), quads[1].vertex.begin() + 2, quads[1].vertex.end());
  std::rotate(quads[1].attribute.begin(), quads[1].attribute.begin() + 2, quads[1].attribute.end());
  for (WindowVertex& v : quads[2].vertex) v = {4 * v.x, 4 * v.y, 4 * v.z, 4};
  EXPECT_EQ(listed(quads), expected);
  EXPECT_TRUE(listed({}).empty());
}

TEST(SharedEdges, WhatIsNone) {
  const auto count_after = [](auto&& change) {
    std::vector<Quad> quads = grid();
    change(quads);
    return shared_edges(quads).size();
  };
  EXPECT_EQ(count_after([](auto&) {}), 4u);
  EXPECT_EQ(count_after([](auto& q) { q[0].attribute[1][1] += 1; }), 3u) << "another attribute at (10, 0)";
  EXPECT_EQ(count_after([](auto& q) { q[0].attribute[2][0] += 1; }), 2u) << "and at (10, 10)";
  EXPECT_EQ(count_after([](auto& q) { q[0].attribute[1][1] = nan; }), 3u);
  EXPECT_EQ(count_after([](auto& q) { q[0].vertex[1].x += 1e-12; }), 3u) << "another position";
  EXPECT_EQ(count_after([](auto& q) { q[0].vertex[1].z = 0.5; }), 3u) << "another depth";
  EXPECT_EQ(count_after([](auto& q) { q[0].vertex[1].x = nan; }), 3u);
  EXPECT_EQ(count_after([](auto& q) { q[0].vertex[1].w = 0; }), 3u);
  EXPECT_EQ(count_after([](auto& q) {
              for (const std::size_t i : {0, 1}) {
                WindowVertex& v = q[i].vertex[1 - i];  // (10, 0) of both
                v = {-v.x, -v.y, -v.z, -1};
              }
            }),
            3u)
      << "behind the eye";
  // The inner edges of a doubled quad are of three quads; its outer ones it shares with its double.
  std::vector<Quad> doubled = grid();
  doubled.push_back(doubled[0]);
  const std::vector<SharedEdge> left = shared_edges(doubled);
  ASSERT_EQ(left.size(), 4u);
  EXPECT_EQ(left[0].quad, (Pair{0, 4}));
  EXPECT_EQ(left[1].quad, (Pair{0, 4}));
  EXPECT_EQ(left[2].quad, (Pair{1, 3}));
  EXPECT_EQ(left[3].quad, (Pair{2, 3}));
  // A triangle as a quad: the edge of no length is none, the others are.
  EXPECT_EQ(count_after([](auto& q) {
              q[3].vertex[3] = q[3].vertex[2];
              q[3].attribute[3] = q[3].attribute[2];
            }),
            3u);
  // One quad that runs along an edge twice does not share it with itself.
  EXPECT_TRUE(shared_edges(std::array{flat_quad({{{0, 0}, {9, 0}, {0, 0}, {5, 5}}})}).empty());
  // Two triangles that touch in their repeated corner.
  EXPECT_TRUE(shared_edges(std::array{flat_quad({{{0, 0}, {9, 0}, {5, 5}, {5, 5}}}),
                                      flat_quad({{{0, 9}, {9, 9}, {5, 5}, {5, 5}}})})
                  .empty());
}

/// Two squares of 64 side by side in a picture of 128 by 64, and the frame with `value(x, y)`.
std::vector<Quad> neighbours() {
  return {flat_quad({{{0, 0}, {64, 0}, {64, 64}, {0, 64}}}), flat_quad({{{64, 0}, {128, 0}, {128, 64}, {64, 64}}})};
}
template <class ValueAt>
AttributeImage neighbour_frame(ValueAt&& value) {
  return paint(
      128, 64, 1, [](double x, double) { return x < 64 ? 0u : 1u; }, value);
}

TEST(Gaps, AMismatchAlongTheEdge) {
  // On the left 0, on the right what two maps would differ by: 0 at the corners and v (1 - v) between.
  const auto image = neighbour_frame([](double x, double y) {
    const double v = y / 64;
    return Values{x < 64 ? 0.0 : v * (1 - v)};
  });
  const Gaps gaps = measure_gaps(image, neighbours());
  double squares = 0;
  for (int y = 16; y < 48; ++y) squares += std::pow((y + 0.5) / 64 * (63.5 - y) / 64, 2);
  EXPECT_EQ(gaps.edges, 1u);
  EXPECT_EQ(gaps.measured, 1u);
  EXPECT_EQ(gaps.jump.profiles(), 32u);
  EXPECT_NEAR(gaps.jump.gap.max(), 31.5 * 32.5 / 64 / 64, 1e-13);
  EXPECT_NEAR(gaps.jump.gap.rms(), std::sqrt(squares / 32), 1e-13);
  EXPECT_NEAR(gaps.jump.parabola_value.max(), 31.5 * 32.5 / 64 / 64, 1e-13);
  EXPECT_EQ(gaps.worst, (Pair{0, 1}));
  EXPECT_EQ(gaps.empty, 0u);
  EXPECT_EQ(gaps.foreign, 0u);
  EXPECT_THROW(measure_gaps(image, std::array{neighbours()[0]}), std::invalid_argument);
}

TEST(Gaps, NoneWhereAttributesAgree) {
  // Both sides curve differently and meet on the edge: no gap though slopes jump by 3 per picture width.
  const auto image = neighbour_frame([](double x, double y) {
    const double d = (x - 64) / 128;
    return Values{y + (d < 0 ? d + 2 * d * d : 4 * d - d * d)};
  });
  const Gaps gaps = measure_gaps(image, neighbours());
  EXPECT_LT(gaps.jump.gap.max(), 1e-12);
  EXPECT_LT(gaps.jump.parabola_value.max(), 1e-12);
  EXPECT_NEAR(gaps.jump.parabola_slope.max(), 3, 1e-9);
  // Straight lines leave 5/4 - m² = -11/4 of the difference of second powers, per 128².
  EXPECT_NEAR(gaps.jump.line_value.max(), 3 * 2.75 / 128 / 128, 1e-12);
}

TEST(Gaps, NoneBetweenQuadsWithOtherAttributes) {
  auto quads = neighbours();
  quads[1].attribute[0][0] += 1;
  const auto image = neighbour_frame([](double x, double) { return Values{x < 64 ? 0.0 : 1.0}; });
  const Gaps gaps = measure_gaps(image, quads);
  EXPECT_EQ(gaps.edges, 0u);
  EXPECT_EQ(gaps.jump.profiles(), 0u);
  EXPECT_EQ(gaps.worst, (Pair{none, none}));
}

TEST(Gaps, TheWorstOfSeveral) {
  // The grid, larger: steps of 1 and 3 across the upper and lower vertical edge, 0.5 and 1.5 across the horizontal
  // ones.
  auto quads = grid();
  for (Quad& q : quads)
    for (WindowVertex& v : q.vertex) v.x *= 4, v.y *= 4;
  const auto image = paint(
      80, 80, 1, [](double x, double y) { return (x < 40 ? 0u : 1u) + (y < 40 ? 0u : 2u); },
      [](double x, double y) { return Values{x < 40 ? (y < 40 ? 0.0 : -0.5) : (y < 40 ? 1.0 : 2.5)}; });
  const Gaps gaps = measure_gaps(image, quads);
  EXPECT_EQ(gaps.edges, 4u);
  EXPECT_EQ(gaps.measured, 4u);
  EXPECT_EQ(gaps.worst, (Pair{2, 3}));
  EXPECT_DOUBLE_EQ(gaps.jump.gap.max(), 3);
  EXPECT_EQ(gaps.jump.profiles(), 80u);
  EXPECT_DOUBLE_EQ(gaps.jump.gap.rms(), std::sqrt((1 + 9 + 0.25 + 2.25) / 4));
}

TEST(Gaps, ACreaseBesideAnEdgeIsNone) {
  // Three squares of 64: a step of 1/8 at 64; at 128 no step, and slopes that change by 4 per pixel 2.25 further on.
  auto quads = neighbours();
  quads.push_back(flat_quad({{{128, 0}, {192, 0}, {192, 64}, {128, 64}}}));
  const auto image = paint(
      192, 64, 1, [](double x, double) { return x < 64    ? 0u
                                                : x < 128 ? 1u
                                                          : 2u; },
      [](double x, double y) { return Values{y / 64 + (x < 64 ? 0.0 : 0.125) + 4 * std::max(0.0, x - 130.25)}; });
  const Gaps gaps = measure_gaps(image, quads);
  EXPECT_EQ(gaps.measured, 2u);
  EXPECT_EQ(gaps.worst, (Pair{0, 1}));
  EXPECT_NEAR(gaps.jump.gap.max(), 0.125, 1e-12);
  EXPECT_NEAR(gaps.jump.gap.rms(), 0.125 / std::sqrt(2), 1e-12);
  EXPECT_GT(gaps.jump.parabola_value.max(), 0.5);
}

TEST(Gaps, ProfilesThatADiagonalCrossesDoNotCount) {
  // The left quad is narrow: its diagonals leave the edge at 64 by `width` / 64 per row from either end. A profile
  // reaches to the centre at 60.5: 3.5 rows · 64 / width from an end are lost, of which the first 16 never count.
  const auto left_quad = [](double edge, double width) {
    return flat_quad({{{edge - width, 0}, {edge, 0}, {edge, 64}, {edge - width, 64}}});
  };
  const auto flat = neighbour_frame([](double, double) { return Values{0}; });
  for (const auto& [width, profiles] : {std::pair{64, 32u}, std::pair{12, 26u}, std::pair{5, 0u}}) {
    const Gaps gaps = measure_gaps(flat, std::array{left_quad(64, width), neighbours()[1]});
    EXPECT_EQ(gaps.edges, 1u);
    EXPECT_EQ(gaps.jump.profiles(), profiles) << width;
    EXPECT_EQ(gaps.measured, profiles > 0 ? 1u : 0u);
  }
  // Split along a diagonal, which passes between the first two pixels and the edge in places: continuous.
  const auto image = neighbour_frame(
      [](double x, double y) { return Values{x < 64 ? 8 * std::max(0.0, 64 - 12 * y / 64 - x) : 0.0}; });
  EXPECT_LT(measure_gaps(image, std::array{left_quad(64, 12), neighbours()[1]}).jump.gap.max(), 1e-12);
  // Holes count where nothing is measured.
  AttributeImage broken = flat;
  test::erase(broken, 63, 30);
  EXPECT_EQ(measure_gaps(broken, std::array{left_quad(64, 5), neighbours()[1]}).empty, 1u);

  // The edge at 64.5, through centres that show the left quad: the profile ends at 68.5, 4 beyond; 4 · 64 / 12 = 21.3
  // rows. Of the right quad: at 67.5, and 3 · 64 / 12 = 16 rows.
  const std::array centred{left_quad(64.5, 64), left_quad(76.5, 12)};
  for (const bool to_left : {true, false}) {
    const auto frame = paint(
        128, 64, 1, [&](double x, double) { return x < (to_left ? 65 : 64) ? 0u : 1u; },
        [](double, double) { return Values{0}; });
    EXPECT_EQ(measure_gaps(frame, centred).jump.profiles(), to_left ? 22u : 32u);
  }
}

TEST(Gaps, OfATriangleItsDiagonalsAreEdges) {
  const std::array<Vec2, 3> corner{{{64, 0}, {128, 32}, {64, 64}}};
  const auto image = neighbour_frame([](double x, double) { return Values{x < 64 ? 0.0 : 0.5}; });
  for (std::size_t first = 0; first < 3; ++first) {
    const Vec2 &a = corner[first], &b = corner[(first + 1) % 3], &c = corner[(first + 2) % 3];
    const Gaps gaps = measure_gaps(image, std::array{neighbours()[0], flat_quad({{a, b, c, c}})});
    EXPECT_EQ(gaps.edges, 1u) << first;
    EXPECT_EQ(gaps.jump.profiles(), 32u) << first;
    EXPECT_EQ(gaps.jump.gap.max(), 0.5) << first;
  }
}

TEST(Gaps, OfQuadsThatAreNotConvexApart) {
  const auto image = neighbour_frame([](double x, double) { return Values{x < 64 ? 0.0 : 0.5}; });
  const auto expect_apart = [&](const Quad& right) {
    const Gaps gaps = measure_gaps(image, std::array{neighbours()[0], right});
    EXPECT_EQ(gaps.edges, 1u);
    EXPECT_EQ(gaps.measured, 0u);
    EXPECT_EQ(gaps.jump.profiles(), 0u);
    EXPECT_EQ(gaps.concave.profiles(), 32u);
    EXPECT_EQ(gaps.concave.gap.max(), 0.5);
    EXPECT_EQ(gaps.worst, (Pair{none, none}));
  };
  expect_apart(flat_quad({{{64, 0}, {128, 10}, {90, 32}, {64, 64}}}));
  expect_apart(flat_quad({{{64, 0}, {128, 64}, {128, 0}, {64, 64}}}));  // crossed
  Quad behind = neighbours()[1];
  behind.vertex[2] = {-200, -50, 0, -1};
  expect_apart(behind);
  const Gaps squares = measure_gaps(image, neighbours());
  EXPECT_EQ(squares.concave.profiles(), 0u);
  EXPECT_EQ(squares.jump.profiles(), 32u);
}

TEST(Gaps, Holes) {
  const auto plane = neighbour_frame([](double x, double y) { return Values{x + y}; });
  const auto count = [&](const AttributeImage& image, auto&& quads) {
    const Gaps gaps = measure_gaps(image, quads);
    return std::array<std::uint64_t, 3>{gaps.empty, gaps.foreign, gaps.jump.profiles()};
  };
  using Counts = std::array<std::uint64_t, 3>;
  // Centres 63.5 and 64.5 are within 1 of the edge at 64; rows 16 to 47 are its middle half.
  for (int x = 58; x < 70; ++x) {
    AttributeImage image = plane;
    test::erase(image, x, 30);
    EXPECT_EQ(count(image, neighbours())[0], x == 63 || x == 64 ? 1u : 0u) << x;
  }
  AttributeImage image = plane;
  test::erase(image, 63, 15), test::erase(image, 63, 48);
  EXPECT_EQ(count(image, neighbours()), (Counts{0, 0, 32})) << "near the ends";
  test::erase(image, 63, 16), test::erase(image, 64, 47), test::erase(image, 63, 47);
  EXPECT_EQ(count(image, neighbours()), (Counts{3, 0, 30}));
  image.quad[image.pixel(64, 20)] = 2;
  auto three = neighbours();
  three.push_back(flat_quad({{{300, 0}, {310, 0}, {310, 10}, {300, 10}}}));
  EXPECT_EQ(count(image, three), (Counts{3, 1, 29})) << "a third quad shows";
  test::erase(image, 67, 16);
  test::erase(image, 60, 47);
  EXPECT_EQ(count(image, three), (Counts{0, 1, 29})) << "a neighbour is missing too: no crack";
  image.set_undefined(63, 25, 0);
  EXPECT_EQ(measure_gaps(image, three).jump.undefined, 1u);
  EXPECT_EQ(count(image, three), (Counts{0, 1, 28})) << "covered";
  EXPECT_EQ(count(AttributeImage(128, 64, 1), neighbours()), (Counts{0, 0, 0}));
}

TEST(Gaps, HolesOfAnEdgeThroughPixelCentres) {
  // The edge at 64.5: centres 63.5 to 65.5 are within 1.
  std::vector<Quad> quads{flat_quad({{{0, 0}, {64.5, 0}, {64.5, 64}, {0, 64}}}),
                          flat_quad({{{64.5, 0}, {128, 0}, {128, 64}, {64.5, 64}}})};
  for (int x = 61; x < 68; ++x) {
    auto image = neighbour_frame([](double, double) { return Values{0}; });
    test::erase(image, x, 30);
    EXPECT_EQ(measure_gaps(image, quads).empty, x >= 63 && x <= 65 ? 1u : 0u) << x;
  }
}

TEST(Gaps, AHoleOfSeveralEdgesCountsOnce) {
  // Two crossed quads share all four edges; two of them cross in the middle, where the hole is.
  const std::array<Vec2, 4> corner{{{62, 32}, {66, 96}, {66, 32}, {62, 96}}};
  const std::vector<Quad> quads{flat_quad(corner), flat_quad({{corner[1], corner[0], corner[3], corner[2]}})};
  auto image = paint(
      128, 128, 1, [](double x, double) { return x < 64 ? 0u : 1u; }, [](double, double) { return Values{0}; });
  test::erase(image, 64, 64);
  const Gaps gaps = measure_gaps(image, quads);
  EXPECT_EQ(gaps.edges, 4u);
  EXPECT_EQ(gaps.empty, 1u);
}

}  // namespace
}  // namespace quadrille::compare
