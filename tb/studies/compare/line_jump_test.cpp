// Jumps across a line: kinks, steps, parabolas and cubics whose jumps are known by hand.
#include "model/support/prng.hpp"
#include "tb/studies/compare/line_jump_test_support.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>

namespace quadrille::compare {
namespace {

/// A line through (0.47, 0.53) of a square picture, as a segment of length 0.6.
struct Line {
  double cosine, sine;
  int size;
  explicit Line(double degrees, int n)
      : cosine(std::cos(degrees * std::numbers::pi / 180)), sine(std::sin(degrees * std::numbers::pi / 180)), size(n) {
    // Those of the axes are meant exactly.
    if (std::fabs(cosine) < 1e-9) cosine = 0;
    if (std::fabs(sine) < 1e-9) sine = 0;
  }
  Vec2 at(double along) const { return {(0.47 + along * cosine) * size, (0.53 + along * sine) * size}; }
  Vec2 p() const { return at(-0.3); }
  Vec2 q() const { return at(0.3); }
  /// Signed distance of a window position in picture sides.
  double distance(double x, double y) const { return (y / size - 0.53) * cosine - (x / size - 0.47) * sine; }
  double steeper() const { return std::max(std::fabs(cosine), std::fabs(sine)); }
};

constexpr std::array<double, 12> angles{0, 7, 30, 44.9, 45, 45.1, 63, 90, 117, 135, 171, 262};

TEST(MeasureLine, AKinkIsTheSameAtEveryResolution) {
  // Along the profile the distance from the line grows by the steeper of the line's cosine and sine.
  for (const double degrees : angles) {
    for (const int size : {256, 512, 1024}) {
      const Line line(degrees, size);
      const auto image = paint(size, size, 3, [&](double x, double y) {
        const double kink = std::max(0.0, line.distance(x, y));
        const double plane = 0.3 + 0.7 * x / size - 0.4 * y / size;
        return std::array{plane + 2 * kink, plane - 3 * kink, plane};
      });
      const LineJump jump = measure_line(image, line.p(), line.q(), inside);
      const double expected = 3 * line.steeper();
      EXPECT_NEAR(static_cast<double>(jump.profiles()), 0.3 * size * line.steeper(), 1) << degrees << " " << size;
      for (const JumpStats& slope : {jump.line_slope, jump.parabola_slope}) {
        EXPECT_NEAR(slope.max(), expected, 1e-9) << degrees << " " << size;
        EXPECT_NEAR(slope.rms(), expected, 1e-9) << degrees << " " << size;
      }
      // The two changes of slope beside a kink share it: half of it goes into one of them at least.
      EXPECT_GE(jump.step_slope.max(), expected / 2 - 1e-9) << degrees << " " << size;
      EXPECT_LE(jump.step_slope.max(), expected + 1e-9) << degrees << " " << size;
      EXPECT_LT(jump.line_value.max(), 1e-12) << degrees << " " << size;
      EXPECT_LT(jump.parabola_value.max(), 1e-12) << degrees << " " << size;
      EXPECT_EQ(jump.undefined, 0u);
    }
  }
}

TEST(MeasureLine, ASmoothFunctionsJumpHalves) {
  // A parabola a s² with pixels at m − 3/2 … m + 3/2 from the line, s in pixels: the fitted slope is 2 a m. The two
  // sides' m add up to 1 + 3, whatever the distance, so the slopes jump by 8 a; a = A / size², and times size.
  for (const double degrees : angles) {
    for (const int size : {256, 512, 1024}) {
      const Line line(degrees, size);
      const auto image = paint(size, size, 1, [&](double x, double y) {
        const double u = x / size, v = y / size;
        return std::array{0.2 - 0.5 * u + 1.5 * u * u - 0.75 * u * v + 0.5 * v * v};
      });
      const LineJump jump = measure_line(image, line.p(), line.q(), inside);
      const bool rows = std::fabs(line.q()[1] - line.p()[1]) >= std::fabs(line.q()[0] - line.p()[0]);
      const double expected = 8 * (rows ? 1.5 : 0.5) / size;
      ASSERT_GT(jump.profiles(), 0u);
      EXPECT_NEAR(jump.line_slope.max(), expected, 1e-10) << degrees << " " << size;
      EXPECT_NEAR(jump.line_slope.rms(), expected, 1e-10) << degrees << " " << size;
      EXPECT_NEAR(jump.step_slope.max(), expected / 4, 1e-10) << "a (s + 1)² − 2 a s² + a (s − 1)² = 2 a";
      EXPECT_NEAR(jump.step_slope.rms(), expected / 4, 1e-10);
      EXPECT_LT(jump.parabola_slope.max(), 1e-10) << degrees << " " << size;
      EXPECT_LT(jump.parabola_value.max(), 1e-12) << degrees << " " << size;
    }
  }
}

TEST(MeasureLine, SecondAndThirdPowersOffCentre) {
  // The line is 1/4 before the far side's first centre: m = 7/4 there and 9/4 on the near side. s²: the value of the
  // straight line at s = 0 is 5/4 − m². s³: the parabola's slope there is 41/20 − 3 m², its value m³ − 41/20 m.
  for (const int size : {64, 128, 256}) {
    const double n = size, middle = n / 2 + 0.25;
    for (const bool vertical : {true, false}) {
      const auto image = [&](int power) {
        return paint(size, size, 1,
                     [&](double x, double y) { return Values{std::pow(((vertical ? x : y) - middle) / n, power)}; });
      };
      const Vec2 p = vertical ? Vec2{middle, 8} : Vec2{8, middle}, q = vertical ? Vec2{middle, 40} : Vec2{40, middle};
      const LineJump square = measure_line(image(2), p, q, inside), cube = measure_line(image(3), p, q, inside);
      ASSERT_EQ(square.profiles(), 16u);
      ASSERT_EQ(cube.profiles(), 16u);
      EXPECT_NEAR(square.line_slope.max() * n, 8, 1e-9);
      EXPECT_NEAR(square.line_value.max() * n * n, (81 - 49) / 16.0, 1e-9);
      EXPECT_NEAR(square.parabola_slope.max(), 0, 1e-11);
      EXPECT_NEAR(cube.parabola_slope.max() * n * n, 3 * (81 - 49) / 16.0, 1e-7);
      EXPECT_NEAR(cube.parabola_value.max() * n * n * n, (343 + 729) / 64.0 - 4 * 2.05, 1e-7);
    }
  }
}

TEST(MeasureLine, AStepAcrossASharedEdge) {
  for (const double degrees : angles) {
    constexpr int size = 256;
    const Line line(degrees, size);
    const auto beyond = [&](double x, double y) { return line.distance(x, y) > 0; };
    const auto image = paint(
        size, size, 2, [&](double x, double y) { return beyond(x, y) ? 1u : 0u; },
        [&](double x, double y) {
          const double u = x / size, v = y / size, d = line.distance(x, y), bowl = 3 * u * u + v * v;
          // Across the line: a step of 1/8 and of 1/32; slopes that differ by 4 in the second channel.
          return beyond(x, y) ? std::array{bowl + 0.125, 5 * d + 0.03125} : std::array{bowl, d};
        });
    for (const Pair& pair : {Pair{0, 1}, Pair{1, 0}}) {
      const LineJump jump = measure_line(image, line.p(), line.q(), pair);
      EXPECT_NEAR(static_cast<double>(jump.profiles()), 0.3 * size * line.steeper(), 1) << degrees;
      EXPECT_NEAR(jump.parabola_value.max(), 0.125, 1e-12) << degrees;
      EXPECT_NEAR(jump.parabola_value.rms(), 0.125, 1e-12) << degrees;
      EXPECT_NEAR(jump.parabola_slope.max(), 4 * line.steeper(), 1e-9) << degrees;
      EXPECT_NEAR(jump.line_slope.max(), 4 * line.steeper(), 1e-9) << degrees;
    }
    EXPECT_EQ(measure_line(image, line.p(), line.q(), inside).profiles(), 0u) << degrees;
    EXPECT_EQ(measure_line(image, line.p(), line.q(), {0, 2}).profiles(), 0u) << degrees;
  }
}

TEST(MeasureLine, GapsOffCentre) {
  // The line is 1/4 before the far side's first centre, between straight lines and s² / 20. Straight lines continue the
  // difference of the sides' s² to 2, by pairs to 1: 1/10 and 1/20 more than the step.
  const auto measure = [](double step) {
    const auto image = paint(
        64, 64, 1, [](double x, double) { return x < 32.25 ? 0u : 1u; },
        [&](double x, double) {
          const double s = x - 32.25;
          return Values{(s < 0 ? 3 * s : step - 2 * s) + s * s / 20};
        });
    return measure_line(image, {32.25, 0}, {32.25, 64}, edge);
  };
  EXPECT_NEAR(measure(-0.125).gap.max(), 0.025, 1e-13);
  const LineJump jump = measure(0.125);
  EXPECT_EQ(jump.gap.count(), 32u);
  EXPECT_NEAR(jump.gap.max(), 0.125, 1e-13);
  EXPECT_NEAR(jump.gap.rms(), 0.125, 1e-13);
  LineJump twice = jump;
  twice.merge(jump);
  EXPECT_EQ(twice.gap.count(), 64u);
}

TEST(MeasureLine, AnEdgeThroughPixelCentresBelongsToEither) {
  // The column of centres 20.5 is on the edge, or a little beside it: vertices snapped to 1/256.
  for (const double off : {0.0, 0x1p-9, -0x1p-9, 0x1p-8, -0x1p-8, 0x1p-6, -0x1p-6}) {
    for (const bool to_left : {true, false}) {
      for (const bool vertical : {true, false}) {
        const auto left = [&](double x, double y) {
          const double across = vertical ? x : y;
          return across < 20 || (across < 21 && to_left);
        };
        const auto image = paint(
            40, 40, 1, [&](double x, double y) { return left(x, y) ? 0u : 1u; },
            [&](double x, double y) {
              const double s = (vertical ? x : y) - 20.5;
              return Values{left(x, y) ? 0.25 * s : 1 - 0.5 * s};
            });
        const double at = 20.5 + off;
        const LineJump jump =
            measure_line(image, vertical ? Vec2{at, 4} : Vec2{4, at}, vertical ? Vec2{at, 36} : Vec2{36, at}, edge);
        // Beyond the tolerance the column must be where the geometry says.
        const bool follows = off > 0 ? to_left : !to_left;
        if (std::fabs(off) > edge_tolerance && !follows) {
          EXPECT_EQ(jump.profiles(), 0u) << off;
          continue;
        }
        EXPECT_EQ(jump.profiles(), 16u) << off << to_left;
        EXPECT_NEAR(jump.line_value.max(), std::fabs(1 - 0.75 * off), 1e-12) << off << to_left;
        EXPECT_NEAR(jump.parabola_value.max(), std::fabs(1 - 0.75 * off), 1e-12) << off << to_left;
        EXPECT_NEAR(jump.line_slope.max(), 0.75 * 40, 1e-11) << off << to_left;
      }
    }
  }
}

TEST(MeasureLine, SlopesArePerLongerSide) {
  for (const auto& [width, height] : {std::pair{64, 256}, std::pair{256, 64}, std::pair{32, 32}}) {
    const auto image = paint(width, height, 1, [](double x, double) { return Values{std::max(0.0, x - 16)}; });
    const LineJump jump = measure_line(image, {16, 0}, {16, 32}, inside);
    EXPECT_EQ(jump.line_slope.max(), std::max(width, height));
  }
}

TEST(MeasureLine, MaximumAndRootMeanSquare) {
  // Slopes of rows 8 to 23 jump by 1, but by 3 in row 10.
  const auto image =
      paint(32, 32, 1, [](double x, double y) { return Values{std::max(0.0, x - 16) / 32 * (y == 10.5 ? 3 : 1)}; });
  const LineJump jump = measure_line(image, {16, 0}, {16, 32}, inside);
  EXPECT_EQ(jump.profiles(), 16u);
  EXPECT_DOUBLE_EQ(jump.line_slope.max(), 3);
  EXPECT_DOUBLE_EQ(jump.line_slope.rms(), std::sqrt((15 + 9) / 16.0));
  LineJump both = jump;
  both.merge(measure_line(image, {16, 16}, {16, 32}, inside));  // rows 20 to 27
  EXPECT_EQ(both.profiles(), 24u);
  EXPECT_DOUBLE_EQ(both.line_slope.max(), 3);
  EXPECT_DOUBLE_EQ(both.line_slope.rms(), std::sqrt((15 + 9 + 8) / 24.0));
  LineJump other_order = measure_line(image, {16, 16}, {16, 32}, inside);
  other_order.merge(jump);
  EXPECT_DOUBLE_EQ(other_order.line_slope.max(), 3);
}

TEST(MeasureLine, HolesAndUndefinedPixels) {
  const auto plane = paint(32, 32, 2, [](double x, double y) { return Values{x, y}; });
  const auto count = [&](const AttributeImage& image) {
    const LineJump jump = measure_line(image, {16, 0}, {16, 32}, inside);
    return std::array<std::uint64_t, 2>{jump.profiles(), jump.undefined};
  };
  using Counts = std::array<std::uint64_t, 2>;
  EXPECT_EQ(count(plane), (Counts{16, 0}));
  for (int x = 10; x < 22; ++x) {
    const bool counts = x >= 12 && x < 20;  // four on either side of 16
    AttributeImage image = plane;
    test::erase(image, x, 10);
    EXPECT_EQ(count(image), (Counts{counts ? 15u : 16u, 0})) << x;

    image = plane;
    image.quad[image.pixel(x, 10)] = 1;
    EXPECT_EQ(count(image), (Counts{counts ? 15u : 16u, 0})) << x;

    image = plane;
    image.set_undefined(x, 10, 0);
    EXPECT_EQ(count(image), (Counts{counts ? 15u : 16u, counts ? 1u : 0u})) << x;

    for (const double bad : {nan, infinity, -infinity}) {
      image = plane;
      image.values(image.pixel(x, 10))[1] = bad;
      EXPECT_EQ(count(image), (Counts{counts ? 15u : 16u, counts ? 1u : 0u})) << x;
    }
  }
  AttributeImage image = plane;
  test::erase(image, 13, 10);
  image.set_undefined(18, 10, 0);
  EXPECT_EQ(count(image), (Counts{15, 0})) << "the hole would have kept it from being measured anyway";
  EXPECT_EQ(count(AttributeImage(32, 32, 2)), (Counts{0, 0}));
  const LineJump of_nothing =
      measure_line(AttributeImage(32, 32, 2), {16, 0}, {16, 32}, {AttributeImage::no_quad, AttributeImage::no_quad});
  EXPECT_EQ(of_nothing.profiles(), 0u);
  EXPECT_EQ(of_nothing.undefined, 0u);
}

TEST(MeasureLine, TooFewPixels) {
  const auto plane = [](double x, double y) { return Values{x + y}; };
  EXPECT_EQ(measure_line(paint(7, 32, 1, plane), {3.5, 0}, {3.5, 32}, inside).profiles(), 0u);
  const auto eight = paint(8, 32, 1, plane);
  EXPECT_EQ(measure_line(eight, {4, 0}, {4, 32}, inside).profiles(), 16u);
  EXPECT_EQ(measure_line(eight, {4.5, 0}, {4.5, 32}, inside).profiles(), 16u);
  EXPECT_EQ(measure_line(eight, {4.6, 0}, {4.6, 32}, inside).profiles(), 0u);
  EXPECT_EQ(measure_line(eight, {3.5, 0}, {3.5, 32}, inside).profiles(), 0u);
  EXPECT_EQ(measure_line(eight, {3.6, 0}, {3.6, 32}, inside).profiles(), 16u);
  const auto flat = paint(32, 8, 1, plane);
  EXPECT_EQ(measure_line(flat, {0, 4}, {32, 4}, inside).profiles(), 16u);
  EXPECT_EQ(measure_line(flat, {0, 4.6}, {32, 4.6}, inside).profiles(), 0u);
  // A strip of seven columns of the quad, and one of eight.
  const auto strip = [&](double last) {
    return paint(
        32, 32, 1, [&](double x, double) { return x > 12 && x < last ? 0u : AttributeImage::no_quad; }, plane);
  };
  EXPECT_EQ(measure_line(strip(19), {16, 0}, {16, 32}, inside).profiles(), 0u);
  EXPECT_EQ(measure_line(strip(20), {16, 0}, {16, 32}, inside).profiles(), 16u);
  EXPECT_EQ(measure_line(paint(1, 1, 1, plane), {0, 0}, {1, 1}, inside).profiles(), 0u);
}

TEST(MeasureLine, HugeValuesGiveInfinityNotNaN) {
  const auto image =
      paint(32, 32, 1, [](double x, double) { return Values{std::fmod(std::floor(x), 3) == 0 ? -1.7e308 : 1.7e308}; });
  const LineJump jump = measure_line(image, {16, 0}, {16, 32}, inside);
  ASSERT_EQ(jump.profiles(), 16u);
  for (const JumpStats& stats :
       {jump.line_slope, jump.line_value, jump.parabola_slope, jump.parabola_value, jump.gap}) {
    EXPECT_FALSE(std::isnan(stats.max()));
    EXPECT_FALSE(std::isnan(stats.rms()));
  }
  EXPECT_EQ(jump.line_slope.max(), infinity);
  EXPECT_EQ(jump.gap.max(), infinity);
}

TEST(AttributeImage, Sizes) {
  EXPECT_THROW(AttributeImage(0, 1, 1), std::invalid_argument);
  EXPECT_THROW(AttributeImage(1, -1, 1), std::invalid_argument);
  EXPECT_THROW(AttributeImage(1, 1, 0), std::invalid_argument);
  const AttributeImage image(3, 2, 4);
  EXPECT_EQ(image.value.size(), 24u);
  EXPECT_EQ(image.pixel(2, 1), 5u);
  EXPECT_FALSE(image.covered(5));
  EXPECT_FALSE(image.defined(5));
}

}  // namespace
}  // namespace quadrille::compare
