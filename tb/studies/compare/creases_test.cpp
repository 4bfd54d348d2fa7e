// Creases, inner jumps and gaps of frames made of formulas, with jumps, edges and holes known by hand.
#include "tb/studies/compare/creases.hpp"
#include "tb/studies/compare/creases_test_support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace quadrille::compare {
namespace {

double cross(const Vec2& a, const Vec2& b, double x, double y) {
  return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

/// By the parity of the edges that a ray to the right crosses: any simple polygon.
bool in_polygon(const std::array<Vec2, 4>& corner, double x, double y) {
  bool inside = false;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 &a = corner[i], &b = corner[(i + 1) % 4];
    if ((a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])) inside = !inside;
  }
  return inside;
}

std::array<Vec2, 4> scaled(std::array<Vec2, 4> corner, double size) {
  for (Vec2& c : corner) c[0] *= size, c[1] *= size;
  return corner;
}

/// 0 on one side of a diagonal and growing to 1 at a corner on the other, as the diagonal split interpolates it.
AttributeImage split(const std::array<Vec2, 4>& corner, std::size_t diagonal, int size, std::uint32_t id = 0) {
  const Vec2 &a = corner[diagonal], &b = corner[diagonal + 2], &top = corner[(diagonal + 3) % 4];
  const double full = cross(a, b, top[0], top[1]);
  return paint(
      size, size, 1, [&](double x, double y) { return in_polygon(corner, x, y) ? id : none; },
      [&](double x, double y) { return std::array{std::max(0.0, cross(a, b, x, y) / full)}; });
}

/// The gradient is |b - a| / full across the diagonal; along the axis that is steeper to it the larger of |b - a|'s
/// components remains.
double split_jump(const std::array<Vec2, 4>& corner, std::size_t diagonal) {
  const Vec2 &a = corner[diagonal], &b = corner[diagonal + 2], &top = corner[(diagonal + 3) % 4];
  return std::max(std::fabs(b[0] - a[0]), std::fabs(b[1] - a[1])) / std::fabs(cross(a, b, top[0], top[1]));
}

TEST(Diagonals, ASplitCreasesItsOwnAlone) {
  for (const int size : {256, 512, 1024}) {
    const auto corner = scaled(convex, size);
    const std::array quads{flat_quad(corner)};
    const Diagonals by02 = measure_diagonals(split(corner, 0, size), quads);
    EXPECT_NEAR(by02.d02.jump.line_slope.max(), split_jump(convex, 0), 1e-9) << size;
    EXPECT_NEAR(by02.d02.jump.line_slope.rms(), split_jump(convex, 0), 1e-9) << size;
    EXPECT_NEAR(by02.d02.jump.parabola_slope.max(), split_jump(convex, 0), 1e-9) << size;
    EXPECT_LT(by02.d02.jump.parabola_value.max(), 1e-12);
    EXPECT_LT(by02.d13.jump.line_slope.max(), 1e-9) << "where the diagonals cross does not count";
    const Diagonals by13 = measure_diagonals(split(corner, 1, size), quads);
    EXPECT_NEAR(by13.d13.jump.line_slope.max(), split_jump(convex, 1), 1e-9) << size;
    EXPECT_LT(by13.d02.jump.line_slope.max(), 1e-9);
    for (const Diagonals& d : {by02, by13}) {
      EXPECT_EQ(d.d02.quads, 1u);
      EXPECT_EQ(d.d13.quads, 1u);
      EXPECT_EQ(d.d02.worst, 0u);
      EXPECT_EQ(d.d13.worst, 0u);
      // Half of 0.8 columns (0-2 is wider than high) and of 0.86 rows, a profile either way, less the 3 or 4 that the
      // other diagonal crosses: it leaves at 2.04 per column and 2.21 per row, and a profile reaches between 3 and 4.
      EXPECT_NEAR(static_cast<double>(d.d02.jump.profiles()), 0.40 * size - 3.5, 1.5);
      EXPECT_NEAR(static_cast<double>(d.d13.jump.profiles()), 0.43 * size - 3.5, 1.5);
    }
  }
}

TEST(Diagonals, ASmoothAttributeHalves) {
  // x² per column and 2 y² per row jump by 8 and 16 per size (line_jump_test.cpp): 0-2 is crossed in columns.
  for (const int size : {256, 512, 1024}) {
    const auto corner = scaled(convex, size);
    const auto image = paint(
        size, size, 1, [&](double x, double y) { return in_polygon(corner, x, y) ? 0u : none; },
        [&](double x, double y) {
          const double u = x / size, v = y / size;
          return std::array{u * u + 2 * v * v};
        });
    const Diagonals d = measure_diagonals(image, std::array{flat_quad(corner)});
    EXPECT_NEAR(d.d02.jump.line_slope.max() * size, 16, 1e-6);
    EXPECT_NEAR(d.d13.jump.line_slope.max() * size, 8, 1e-6);
    EXPECT_LT(d.d02.jump.parabola_slope.max(), 1e-9);
    EXPECT_LT(d.d13.jump.parabola_slope.max(), 1e-9);
  }
}

TEST(Diagonals, OutsideOfAConcaveQuadThereIsNone) {
  const auto corner = scaled(concave, 256);
  const std::array quads{flat_quad(corner)};
  const Diagonals d = measure_diagonals(split(corner, 0, 256), quads);
  EXPECT_NEAR(d.d02.jump.line_slope.max(), split_jump(concave, 0), 1e-9);
  EXPECT_EQ(d.d02.quads, 1u);
  EXPECT_EQ(d.d13.quads, 0u);
  EXPECT_EQ(d.d13.jump.profiles(), 0u);
  EXPECT_EQ(d.d13.worst, none);
}

TEST(Diagonals, NoneOfQuadsThatReachBehindTheEyeOrDoNotShow) {
  const auto corner = scaled(convex, 256);
  const auto image = split(corner, 0, 256, 1);
  Quad behind = flat_quad(corner), at_eye = flat_quad(corner), turned = flat_quad(corner);
  behind.vertex[3].w = -1;
  at_eye.vertex[3].w = 0;
  // The same window positions from other homogeneous coordinates.
  for (std::size_t i = 0; i < 4; ++i) {
    const double w = 0.5 + static_cast<double>(i);
    turned.vertex[i] = {turned.vertex[i].x * w, turned.vertex[i].y * w, 0, w};
  }
  EXPECT_EQ(measure_diagonals(image, std::array{behind, behind}).d02.quads, 0u);
  EXPECT_EQ(measure_diagonals(image, std::array{at_eye, at_eye}).d13.quads, 0u);
  const Diagonals d = measure_diagonals(image, std::array{flat_quad(corner), turned});
  EXPECT_EQ(d.d02.quads, 1u) << "the first does not show";
  const Diagonals flat = measure_diagonals(image, std::array{flat_quad(corner), flat_quad(corner)});
  EXPECT_EQ(d.d02.jump.profiles(), flat.d02.jump.profiles());
  EXPECT_EQ(d.d13.jump.profiles(), flat.d13.jump.profiles());
  EXPECT_EQ(d.d02.worst, 1u);
  EXPECT_NEAR(d.d02.jump.line_slope.max(), split_jump(convex, 0), 1e-9);
  EXPECT_THROW(measure_diagonals(image, std::array{behind}), std::invalid_argument);
}

TEST(Diagonals, OfSeveralQuadsTheWorst) {
  // Three squares of 60 in a row, corner 3 is worth 1, 3 and 2: slopes jump by that over 60, times 200.
  std::vector<Quad> quads;
  for (int i = 0; i < 3; ++i) {
    const double x = 5 + 65 * i;
    quads.push_back(flat_quad({{{x, 20}, {x + 60, 20}, {x + 60, 80}, {x, 80}}}));
  }
  AttributeImage image(200, 100, 1);
  constexpr std::array<double, 3> height{1, 3, 2};
  for (int y = 20; y < 80; ++y) {
    for (int x = 0; x < 195; ++x) {
      const int column = x / 65, inside = x % 65 - 5;
      if (inside < 0) continue;
      const double value = std::max(0, y - 20 - inside) / 60.0 * height[static_cast<std::size_t>(column)];
      image.set(x, y, static_cast<std::uint32_t>(column), Values{value});
    }
  }
  const DiagonalCreases d = measure_diagonals(image, quads).d02;
  EXPECT_EQ(d.quads, 3u);
  EXPECT_EQ(d.worst, 1u);
  EXPECT_NEAR(d.jump.line_slope.max(), 10, 1e-9);
  EXPECT_NEAR(d.jump.line_slope.rms(), std::sqrt(14.0 / 3) * 200 / 60, 1e-9) << "as many profiles of each";
  EXPECT_EQ(d.jump.profiles() % 3, 0u);

  image.set_undefined(70 + 29, 49, 1);  // on the diagonal, but 1-3 crosses that profile
  EXPECT_EQ(measure_diagonals(image, quads).d02.jump.undefined, 0u);
  image.set_undefined(70 + 16, 36, 1);  // away from the crossing
  EXPECT_EQ(measure_diagonals(image, quads).d02.jump.undefined, 1u);
}

TEST(Diagonals, OfEachQuad) {
  // Two squares of 60, worth 1 and 3 at corner 3; a third that does not show.
  std::vector<Quad> quads;
  for (const double x : {5.0, 70.0, 135.0})
    quads.push_back(flat_quad({{{x, 20}, {x + 60, 20}, {x + 60, 80}, {x, 80}}}));
  const auto image = paint(
      200, 100, 1,
      [](double x, double y) {
        if (y < 20 || y > 80) return none;
        return x > 5 && x < 65 ? 0u : x > 70 && x < 130 ? 1u : none;
      },
      [](double x, double y) {
        return Values{x < 65 ? std::max(0.0, y - 20 - (x - 5)) / 60 : std::max(0.0, y - 20 - (x - 70)) / 20};
      });
  const std::vector<QuadCreases> creases = measure_quad_diagonals(image, quads);
  ASSERT_EQ(creases.size(), 3u);
  EXPECT_NEAR(creases[0].d02.line_slope.max(), 200.0 / 60, 1e-9);
  EXPECT_NEAR(creases[1].d02.line_slope.max(), 200.0 / 20, 1e-9);
  for (const std::size_t q : {0, 1}) EXPECT_LT(creases[q].d13.line_slope.max(), 1e-9);
  EXPECT_EQ(creases[2].d02.profiles() + creases[2].d13.profiles(), 0u);
  const std::uint64_t profiles = creases[0].d02.profiles();
  EXPECT_GT(profiles, 20u);
  EXPECT_EQ(creases[1].d02.profiles(), profiles);
  EXPECT_EQ(measured_diagonals(creases), (DiagonalSet{{{true, true, false}, {true, true, false}}}));

  const Diagonals all = measure_diagonals(image, quads);
  EXPECT_EQ(all.d02.quads, 2u);
  EXPECT_EQ(all.d02.jump.profiles(), 2 * profiles);
  EXPECT_EQ(all.d02.worst, 1u);
  const Diagonals some = combine_diagonals(creases, {{{true, false, true}, {false, true, false}}});
  EXPECT_EQ(some.d02.quads, 1u);
  EXPECT_EQ(some.d02.jump.profiles(), profiles);
  EXPECT_EQ(some.d02.worst, 0u);
  EXPECT_NEAR(some.d02.jump.line_slope.max(), 200.0 / 60, 1e-9);
  EXPECT_EQ(some.d13.quads, 1u);
  EXPECT_EQ(some.d13.worst, 1u);
  EXPECT_THROW(measure_quad_diagonals(image, std::span(quads).first(1)), std::invalid_argument);
  EXPECT_THROW(combine_diagonals(creases, {{{true, true, true}, {true, true}}}), std::invalid_argument);
  EXPECT_THROW(combine_diagonals(creases, {{{true, true}, {true, true, true}}}), std::invalid_argument);
}

TEST(Diagonals, OfTheSameQuadsAtEverySize) {
  // Squares of 0.8 and 0.1, corner 3 worth 1: slopes jump by 1.25 and 10. At 64 the small one has 6 pixels.
  const std::array<std::array<Vec2, 4>, 2> corner{
      {{{{0.0, 0.0}, {0.8, 0.0}, {0.8, 0.8}, {0.0, 0.8}}}, {{{0.85, 0.0}, {0.95, 0.0}, {0.95, 0.1}, {0.85, 0.1}}}}};
  const auto measure = [&](int size) {
    AttributeImage image(size, size, 1);
    std::vector<Quad> quads;
    for (std::uint32_t q = 0; q < 2; ++q) {
      const auto window = scaled(corner[q], size);
      quads.push_back(flat_quad(window));
      const AttributeImage one = split(window, 0, size, q);
      for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
          if (one.covered(one.pixel(x, y))) image.set(x, y, q, one.values(one.pixel(x, y)));
    }
    return measure_quad_diagonals(image, quads);
  };
  const auto small = measure(64), large = measure(256);
  const std::vector<bool> all(2, true);
  EXPECT_NEAR(combine_diagonals(small, {all, all}).d02.jump.line_slope.max(), 1.25, 1e-9);
  EXPECT_NEAR(combine_diagonals(large, {all, all}).d02.jump.line_slope.max(), 10, 1e-9);
  const DiagonalSet both = in_both(measured_diagonals(small), measured_diagonals(large));
  EXPECT_EQ(both, (DiagonalSet{{{true, false}, {true, false}}}));
  EXPECT_EQ(in_both(measured_diagonals(large), measured_diagonals(small)), both);
  for (const auto& creases : {small, large}) {
    const Diagonals d = combine_diagonals(creases, both);
    EXPECT_EQ(d.d02.quads, 1u);
    EXPECT_NEAR(d.d02.jump.line_slope.max(), 1.25, 1e-9);
  }
  EXPECT_THROW(in_both(both, {}), std::invalid_argument);
  EXPECT_THROW(in_both({}, both), std::invalid_argument);
  EXPECT_THROW(in_both(both, {{{true, true}, {true}}}), std::invalid_argument);
}

TEST(Inside, AKinkIsTheSameAtEveryResolution) {
  for (const int size : {256, 512, 1024}) {
    const auto corner = scaled(convex, size);
    const InnerJumps inside = measure_inside(split(corner, 0, size));
    // The diagonal is crossed in columns; where it passes between two centres of a column, within 1/2 of the boundary,
    // both sides are straight.
    EXPECT_NEAR(inside.line_slope.max(), split_jump(convex, 0), 1e-9) << size;
    EXPECT_NEAR(inside.parabola_slope.max(), split_jump(convex, 0), 1e-9) << size;
    EXPECT_EQ(inside.worst.axis, Axis::y);
    EXPECT_EQ(inside.worst_quad, 0u);
    const double on_line = cross(corner[0], corner[2], inside.worst.x + 0.5, inside.worst.y) /
                           (corner[2][0] - corner[0][0]);  // distance along y
    EXPECT_LE(std::fabs(on_line), 0.5) << "the boundary is the line's";
  }
}

TEST(Inside, ASmoothFunctionsJumpHalves) {
  for (const int size : {64, 128, 256}) {
    const auto image = paint(size, size, 1, [&](double x, double y) {
      const double u = x / size, v = y / size;
      return std::array{u * u + 2 * v * v + u * v};
    });
    const InnerJumps inside = measure_inside(image);
    const auto n = static_cast<std::uint64_t>(size);
    EXPECT_EQ(inside.line_slope.count(), 2 * n * (n - 7));
    EXPECT_EQ(inside.parabola_slope.count(), 2 * n * (n - 7));
    EXPECT_NEAR(inside.line_slope.max() * size, 16, 1e-8);
    EXPECT_NEAR(inside.line_slope.rms() * size, std::sqrt((64 + 256) / 2.0), 1e-8) << "8 in x, 16 in y";
    EXPECT_LT(inside.parabola_slope.max(), 1e-9);
  }
}

TEST(Inside, ASpikeByHand) {
  // A pixel of 1 among zeros. It changes the slope of a fit by 3/10 as an outer pixel and by 1/10 as an inner one. With
  // the parabola's p'(-2) = s - 4 c: f0 gives -3/10 - 1 = -13/10.
  auto image = paint(256, 128, 1, [](double, double) { return std::array{0.0}; });
  image.values(image.pixel(100, 50))[0] = 1;
  const InnerJumps inside = measure_inside(image);
  EXPECT_EQ(inside.line_slope.count(), 128u * 249u + 256u * 121u);
  EXPECT_NEAR(inside.line_slope.max(), 0.3 * 256, 1e-9);
  EXPECT_NEAR(inside.parabola_slope.max(), 1.3 * 256, 1e-9);
  EXPECT_EQ(inside.line_slope.p999(), 0) << "16 of 62848 boundaries see it";
  // Four of the eight boundaries of either axis have it as an outer pixel; the first in rows as the last below.
  EXPECT_EQ(inside.worst.axis, Axis::y);
  EXPECT_EQ(inside.worst.x, 100);
  EXPECT_EQ(inside.worst.y, 47);
  EXPECT_EQ(inside.worst_quad, 0u);
  EXPECT_NEAR(inside.line_slope.rms(), 256 * std::sqrt(8 * (0.09 + 0.01) / 62848), 1e-9);
}

TEST(Inside, TheNearestRankOfTheQuantile) {
  // Kinks of 1 per pixel at x = 32 in some of 32 rows, times 64; 32·57 + 64·25 = 3424 boundaries, of which the three
  // largest may be above the quantile.
  const auto p999 = [](int rows) {
    const auto image =
        paint(64, 32, 1, [&](double x, double y) { return Values{y < rows ? std::max(0.0, x - 32) : 0.0}; });
    const InnerJumps inside = measure_inside(image);
    EXPECT_EQ(inside.line_slope.count(), 3424u);
    return inside.line_slope.p999();
  };
  EXPECT_EQ(p999(32), 64);
  EXPECT_EQ(p999(0), 0);
}

TEST(Inside, OnlyWithinOneQuad) {
  // Columns 0-15 are quad 0, 16-31 quad 3, a step between; nothing from row 20.
  const auto image = paint(
      32, 32, 1, [](double x, double y) { return y > 20   ? none
                                                 : x < 16 ? 0u
                                                          : 3u; },
      [](double x, double) { return Values{x < 16 ? 0.0 : 7.0}; });
  const InnerJumps inside = measure_inside(image);
  EXPECT_EQ(inside.line_slope.count(), 20u * 2 * 9 + 32u * 13);
  EXPECT_EQ(inside.line_slope.max(), 0);
  EXPECT_EQ(inside.undefined, 0u);
  const InnerJumps nothing = measure_inside(AttributeImage(32, 32, 1));
  EXPECT_EQ(nothing.line_slope.count(), 0u);
  EXPECT_EQ(nothing.worst.x, -1);
  EXPECT_EQ(nothing.worst_quad, none);
}

TEST(Inside, UndefinedPixels) {
  auto image = paint(64, 64, 1, [](double x, double) { return Values{x}; });
  const std::uint64_t all = measure_inside(image).line_slope.count();
  image.set_undefined(30, 30, 0);
  image.values(image.pixel(10, 20))[0] = nan;
  const InnerJumps inside = measure_inside(image);
  EXPECT_EQ(inside.undefined, 32u);  // eight boundaries of either axis see a pixel
  EXPECT_EQ(inside.line_slope.count(), all - 32);
  EXPECT_LT(inside.line_slope.max(), 1e-9);
}

}  // namespace
}  // namespace quadrille::compare
