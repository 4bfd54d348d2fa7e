#include "model/support/prng.hpp"
#include "tb/studies/compare/line_jump_test_support.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace quadrille::compare {
namespace {

TEST(LineProfiles, ByHand) {
  const AttributeImage image(32, 24, 1);
  const auto expect = [&](const Vec2& p, const Vec2& q, const std::vector<Profile>& expected) {
    for (const bool turned : {false, true}) {
      const auto profiles = turned ? line_profiles(image, q, p) : line_profiles(image, p, q);
      ASSERT_EQ(profiles.size(), expected.size());
      for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(profiles[i].axis, expected[i].axis) << i;
        EXPECT_EQ(profiles[i].x, expected[i].x) << i;
        EXPECT_EQ(profiles[i].y, expected[i].y) << i;
        EXPECT_EQ(profiles[i].distance, expected[i].distance) << i;
      }
    }
  };
  // Middle half: from 6 to 10.
  expect({10, 4}, {10, 12},
         {{Axis::x, 10, 6, 0.5}, {Axis::x, 10, 7, 0.5}, {Axis::x, 10, 8, 0.5}, {Axis::x, 10, 9, 0.5}});
  expect({4, 9.25}, {12, 9.25},
         {{Axis::y, 6, 9, 0.25}, {Axis::y, 7, 9, 0.25}, {Axis::y, 8, 9, 0.25}, {Axis::y, 9, 9, 0.25}});
  expect({4, 9.75}, {8, 9.75}, {{Axis::y, 5, 10, 0.75}, {Axis::y, 6, 10, 0.75}});
  // At 45 degrees rows. Through pixel centres: the centre is on the far side.
  expect({2, 2}, {10, 10}, {{Axis::x, 4, 4, 0}, {Axis::x, 5, 5, 0}, {Axis::x, 6, 6, 0}, {Axis::x, 7, 7, 0}});
  expect({10, 2}, {2, 10}, {{Axis::x, 7, 4, 0}, {Axis::x, 6, 5, 0}, {Axis::x, 5, 6, 0}, {Axis::x, 4, 7, 0}});
  // y = x / 2, for x from 4 to 12: columns.
  expect({0, 0}, {16, 8},
         {{Axis::y, 4, 2, 0.25},
          {Axis::y, 5, 3, 0.75},
          {Axis::y, 6, 3, 0.25},
          {Axis::y, 7, 4, 0.75},
          {Axis::y, 8, 4, 0.25},
          {Axis::y, 9, 5, 0.75},
          {Axis::y, 10, 5, 0.25},
          {Axis::y, 11, 6, 0.75}});
  // Partly outside: x = y + 30 with the middle half from y = -14 to 18, and columns -9 to 13.
  expect({0, -30}, {64, 34}, {{Axis::x, 30, 0, 0}, {Axis::x, 31, 1, 0}});
  expect({10, 15}, {10, 31},
         {{Axis::x, 10, 19, 0.5},
          {Axis::x, 10, 20, 0.5},
          {Axis::x, 10, 21, 0.5},
          {Axis::x, 10, 22, 0.5},
          {Axis::x, 10, 23, 0.5}});
  expect({-20, 5.5}, {24, 5.5},
         {{Axis::y, 0, 5, 0},
          {Axis::y, 1, 5, 0},
          {Axis::y, 2, 5, 0},
          {Axis::y, 3, 5, 0},
          {Axis::y, 4, 5, 0},
          {Axis::y, 5, 5, 0},
          {Axis::y, 6, 5, 0},
          {Axis::y, 7, 5, 0},
          {Axis::y, 8, 5, 0},
          {Axis::y, 9, 5, 0},
          {Axis::y, 10, 5, 0},
          {Axis::y, 11, 5, 0},
          {Axis::y, 12, 5, 0}});
}

TEST(LineProfiles, NoneOfADegenerateSegment) {
  const AttributeImage image(32, 32, 1);
  EXPECT_TRUE(line_profiles(image, {10, 10}, {10, 10}).empty());
  EXPECT_TRUE(line_profiles(image, {10, 9.6}, {10, 10.4}).empty()) << "9.8 to 10.2: no centre line";
  EXPECT_EQ(line_profiles(image, {10, 10.1}, {10, 10.9}).size(), 1u);
  EXPECT_TRUE(line_profiles(image, {100, 0}, {100, 32}).empty());
  EXPECT_TRUE(line_profiles(image, {-1, 0}, {-1, 32}).empty());
  EXPECT_TRUE(line_profiles(image, {0, 100}, {32, 120}).empty());
  EXPECT_TRUE(line_profiles(image, {0, -100}, {0, -50}).empty());
  for (const double bad : {nan, infinity, -infinity}) {
    EXPECT_TRUE(line_profiles(image, {bad, 0}, {10, 32}).empty());
    EXPECT_TRUE(line_profiles(image, {10, 0}, {10, bad}).empty());
    EXPECT_TRUE(line_profiles(image, {10, bad}, {10, bad}).empty());
  }
  EXPECT_TRUE(line_profiles(image, {-1e308, 1e308}, {1e308, -1e308}).empty());
  EXPECT_TRUE(line_profiles(image, {10, 10}, {10, std::nextafter(10.0, 11.0)}).empty());
}

/// Least squares by the normal equations, independent of the orthogonal polynomials: coefficients of
/// f(s) = c0 + c1 s (+ c2 s^2) by Cramer's rule, s the distance from the line.
std::array<long double, 3> normal_equations(const std::array<double, 4>& f, double distance, bool parabola) {
  std::array<long double, 5> m{};
  std::array<long double, 3> r{};
  for (std::size_t i = 0; i < 4; ++i) {
    const long double s = static_cast<long double>(distance) + static_cast<long double>(i);
    long double power = 1;
    for (std::size_t k = 0; k < 5; ++k, power *= s) {
      m[k] += power;
      if (k < 3) r[k] += power * f[i];
    }
  }
  if (!parabola) {
    const long double det = m[0] * m[2] - m[1] * m[1];
    return {(r[0] * m[2] - m[1] * r[1]) / det, (m[0] * r[1] - m[1] * r[0]) / det, 0};
  }
  const auto det3 = [](long double a, long double b, long double c, long double d, long double e, long double g,
                       long double h, long double i,
                       long double j) { return a * (e * j - g * i) - b * (d * j - g * h) + c * (d * i - e * h); };
  const long double det = det3(m[0], m[1], m[2], m[1], m[2], m[3], m[2], m[3], m[4]);
  return {det3(r[0], m[1], m[2], r[1], m[2], m[3], r[2], m[3], m[4]) / det,
          det3(m[0], r[0], m[2], m[1], r[1], m[3], m[2], r[2], m[4]) / det,
          det3(m[0], m[1], r[0], m[1], m[2], r[1], m[2], m[3], r[2]) / det};
}

TEST(MeasureProfile, IsTheLeastSquaresFit) {
  golden::Prng random(1);
  for (int round = 0; round < 300; ++round) {
    const bool row = random.chance(0.5);
    const int channels = static_cast<int>(random.integer(1, 3));
    AttributeImage image = row ? AttributeImage(8, 1, channels) : AttributeImage(1, 8, channels);
    for (std::size_t p = 0; p < 8; ++p) {
      image.state[p] = PixelState::drawn, image.quad[p] = 5;
      for (double& v : image.values(p)) v = random.uniform(-1, 1);
    }
    const double distance = random.uniform();
    const Profile profile = row ? Profile{Axis::x, 4, 0, distance} : Profile{Axis::y, 0, 4, distance};
    ProfileJump jump;
    ASSERT_EQ(measure_profile(image, profile, {5, 5}, jump), ProfileState::measured);
    std::vector<std::array<long double, 3>> difference(static_cast<std::size_t>(channels));
    for (const bool parabola : {false, true}) {
      long double slope = 0, value = 0;
      for (std::size_t c = 0; c < difference.size(); ++c) {
        std::array<double, 4> far_side{}, near_side{};
        for (std::size_t i = 0; i < 4; ++i) far_side[i] = image.values(4 + i)[c], near_side[i] = image.values(3 - i)[c];
        const auto f = normal_equations(far_side, distance, parabola);
        const auto n = normal_equations(near_side, 1 - distance, parabola);
        slope = std::max(slope, 8 * std::fabs(f[1] + n[1]));
        value = std::max(value, std::fabs(f[0] - n[0]));
        difference[c][parabola] = f[0] - n[0];
        difference[c][2] =
            std::lerp(far_side[0], far_side[1], -distance) - std::lerp(near_side[0], near_side[1], distance - 1);
      }
      const Jump& actual = parabola ? jump.parabola : jump.line;
      EXPECT_NEAR(actual.slope, static_cast<double>(slope), 1e-11) << round;
      EXPECT_NEAR(actual.value, static_cast<double>(value), 1e-11) << round;
    }
    long double gap = 0;
    for (const auto& [a, b, c] : difference)
      if (std::signbit(a) == std::signbit(b) && std::signbit(b) == std::signbit(c))
        gap = std::max(gap, std::min({std::fabs(a), std::fabs(b), std::fabs(c)}));
    EXPECT_NEAR(jump.gap, static_cast<double>(gap), 1e-11) << round;
  }
}

/// The gap of a row of eight pixels with the line in its middle: channel values at the centres -3.5 … 3.5.
double gap_of_row(const std::vector<std::function<double(double)>>& channels) {
  AttributeImage image(8, 1, static_cast<int>(channels.size()));
  for (int x = 0; x < 8; ++x) {
    Values values;
    for (const auto& channel : channels) values.push_back(channel(x - 3.5));
    image.set(x, 0, x < 4 ? 0 : 1, values);
  }
  ProfileJump jump;
  EXPECT_EQ(measure_profile(image, {Axis::x, 4, 0, 0.5}, edge, jump), ProfileState::measured);
  return jump.gap;
}

TEST(MeasureProfile, AGapIsWhatEveryFitSees) {
  const auto step = [](double s) { return s < 0 ? 2 * s : 0.25 - s; };
  EXPECT_NEAR(gap_of_row({step}), 0.25, 1e-15);
  // A crease beyond the second pixel of the far side: the nearest two see straight lines. The least-squares fits take
  // max(0, s - 2) of the third and fourth pixel, 1/2 and 3/2: mean 1/2, slope 1/2, bend 1/4, at t = -2 the line is at
  // -1/2 and the parabola at -1/2 + 11/16 = 3/16.
  const auto crease = [](double s) { return std::max(0.0, s - 2); };
  EXPECT_NEAR(gap_of_row({crease}), 0, 1e-15);
  // It may hide a part of a gap, but does not add to it: 1/4 + 3/160, 1/4 - 1/20, 1/4; and the other way up.
  EXPECT_NEAR(gap_of_row({[&](double s) { return step(s) + 0.1 * crease(s); }}), 0.2, 1e-15);
  EXPECT_NEAR(gap_of_row({[&](double s) { return step(s) - 0.1 * crease(s); }}), 0.25 - 3.0 / 160, 1e-15);
  // Both sides' straight lines miss by -11/4 s² and -3/4 s² at the line: parabolas do not.
  const auto curved = [](double s) { return s < 0 ? s * s : -2 * s * s; };
  EXPECT_NEAR(gap_of_row({curved}), 0, 1e-14);
  EXPECT_NEAR(gap_of_row({[&](double s) { return step(s) + curved(s); }}), 0.25, 1e-14);
  // Channels on their own: no fit agrees with all of them.
  EXPECT_NEAR(gap_of_row({crease, curved}), 0, 1e-14);
  EXPECT_NEAR(gap_of_row({crease, step, curved}), 0.25, 1e-14);
  // Crease and curvature: c times the crease alone adds 3 c / 16 to the parabola, -c / 2 to the line and nothing to the
  // pair; 4 s² of the far side adds nothing, -11 and -3. With c = 8: 3/2, -15, -3. They differ in sign.
  EXPECT_EQ(gap_of_row({[&](double s) { return s < 0 ? 0 : 4 * s * s + 8 * crease(s); }}), 0);
  // With c = -8: -3/2, -7, -3, and 3/2 downwards is the smallest either way up.
  for (const double sign : {1.0, -1.0})
    EXPECT_NEAR(gap_of_row({[&](double s) { return s < 0 ? 0 : sign * (4 * s * s - 8 * crease(s)); }}), 1.5, 1e-13);
  // A crease within the nearest two pixels is not told from a gap: 0, 1/2, 3/2, 5/2 have mean 9/8, slope 17/20 and bend
  // 1/8, so -23/40 by the line, -37/160 by the parabola; -1/4 by the pair.
  EXPECT_NEAR(gap_of_row({[](double s) { return std::max(0.0, s - 1); }}), 37.0 / 160, 1e-15);
}

}  // namespace
}  // namespace quadrille::compare
