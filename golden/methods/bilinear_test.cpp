// Method bilinear against the forward bilinear map: weights are right if they are those of some (u, v) in the unit
// square and reproduce the pixel.
#include "golden/methods/builders.hpp"
#include "golden/methods/quad_test_support.hpp"
#include "golden/scenes/stress.hpp"
#include "model/support/prng.hpp"

#include <optional>

namespace quadrille::golden::methods {
namespace {

using test::area;
using test::by_pixel;
using test::largest_difference;
using test::quad_at;

const std::unique_ptr<Method> bilinear = make_bilinear();

Vec2 on_screen(const WindowVertex& v) { return {v.x / v.w, v.y / v.w}; }

TEST(Bilinear, ForwardMapReturnsThePixel) {
  Prng random(1);
  std::size_t count = 0;
  for (int n = 0; n < 400; ++n) {
    // Any four points: convex, concave and crossed quads.
    std::array<Vec2, 4> v{};
    for (Vec2& p : v) p = {random.uniform(0, 48), random.uniform(0, 48)};
    const std::array<double, 4> w{1, random.uniform(0.25, 4), random.uniform(0.25, 4), random.uniform(0.25, 4)};
    const auto screen = by_pixel(*bilinear, quad_at(v, w), {48, 48, false});
    const auto space = by_pixel(*bilinear, quad_at(v, w), {48, 48, true});
    ASSERT_EQ(screen.size(), space.size());
    for (const auto& [pixel, s] : screen) {
      ASSERT_FALSE(s.undefined);
      Vec2 p{};
      double z = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        ASSERT_GE(s.lambda[i], 0);
        p[0] += s.lambda[i] * v[i][0];
        p[1] += s.lambda[i] * v[i][1];
        z += s.lambda[i] * std::array{0.1, 0.3, 0.7, 0.2}[i];
      }
      ASSERT_NEAR(s.lambda[0] + s.lambda[1] + s.lambda[2] + s.lambda[3], 1, 1e-15);
      ASSERT_NEAR(s.lambda[0] * s.lambda[2], s.lambda[1] * s.lambda[3], 1e-15) << "((1-u)(1-v), u(1-v), uv, (1-u)v)";
      ASSERT_NEAR(p[0], pixel.first + 0.5, 1e-10);
      ASSERT_NEAR(p[1], pixel.second + 0.5, 1e-10);
      ASSERT_NEAR(s.z, z, 1e-14);
      // With perspective beta_i / w_i, normalised: eq. (10) of Hormann & Tarini.
      double sum = 0;
      for (std::size_t i = 0; i < 4; ++i) sum += s.lambda[i] / w[i];
      for (std::size_t i = 0; i < 4; ++i) ASSERT_NEAR(space.at(pixel).lambda[i], s.lambda[i] / w[i] / sum, 1e-14);
      ASSERT_LE(test::distance_from_pixel(quad_at(v, w), space.at(pixel)), 1e-9);
      ++count;
    }
  }
  EXPECT_GT(count, 50'000u);
}

TEST(Bilinear, CornersAndEdges) {
  const std::array<double, 4> w{1, 3, 0.5, 4};
  const std::array<Vec2, 4> point{{{2.5, 2.5}, {2.5, 18.5}, {18.5, 22.5}, {18.5, 2.5}}};
  const auto pixels = by_pixel(*bilinear, quad_at(point, w), {24, 24, true});
  EXPECT_LE(largest_difference(pixels.at({2, 2}).lambda, std::array{1.0, 0.0, 0.0, 0.0}), 1e-15);
  for (int p = 1; p < 16; ++p) {
    const double s = p / 16.0;
    // Linear in space: the point (1 - t) V_0 + t V_1 lands at s = t w_1 / ((1 - t) w_0 + t w_1).
    const double t = s * w[0] / (s * w[0] + (1 - s) * w[1]), t_top = s * w[0] / (s * w[0] + (1 - s) * w[3]);
    EXPECT_LE(largest_difference(pixels.at({2, 2 + p}).lambda, std::array{1 - t, t, 0.0, 0.0}), 1e-14);
    EXPECT_LE(largest_difference(pixels.at({2 + p, 2}).lambda, std::array{1 - t_top, 0.0, 0.0, t_top}), 1e-14);
  }
  // Each corner in turn at the place that the tie rule keeps.
  const std::array<Vec2, 4> square{{{4.5, 4.5}, {4.5, 12.5}, {12.5, 13.5}, {12.5, 4.5}}};
  for (std::size_t shift = 0; shift < 4; ++shift) {
    std::array<Vec2, 4> turned{};
    for (std::size_t i = 0; i < 4; ++i) turned[(i + shift) & 3] = square[i];
    const auto corner = by_pixel(*bilinear, quad_at(turned, w), {16, 16, true}).at({4, 4});
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(corner.lambda[i], i == shift ? 1.0 : 0.0, 1e-15);
  }
}

TEST(Bilinear, ParallelEdges) {
  // Both pairs (k2 = k1's slope = 0), edges 01 and 23, edges 12 and 30: (u, v) by similar triangles.
  const auto rectangle = by_pixel(*bilinear, quad_at({{{2.5, 2.5}, {18.5, 2.5}, {18.5, 10.5}, {2.5, 10.5}}}), {24, 24});
  ASSERT_EQ(rectangle.size(), 128u);
  for (const auto& [pixel, s] : rectangle) {
    const double u = (pixel.first - 2) / 16.0, v = (pixel.second - 2) / 8.0;
    EXPECT_LE(largest_difference(s.lambda, std::array{(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v}), 1e-15);
  }
  // Rows from x = 2.5 to 22.5 at the top, to 12.5 at the bottom; the second run starts at another corner.
  const std::array<Vec2, 4> trapezoid{{{2.5, 2.5}, {22.5, 2.5}, {12.5, 12.5}, {2.5, 12.5}}};
  for (const std::size_t shift : {0u, 1u}) {
    std::array<Vec2, 4> turned{};
    for (std::size_t i = 0; i < 4; ++i) turned[(i + shift) & 3] = trapezoid[i];
    const auto pixels = by_pixel(*bilinear, quad_at(turned), {24, 24});
    ASSERT_GT(pixels.size(), 100u);
    for (const auto& [pixel, s] : pixels) {
      const double v = (pixel.second - 2) / 10.0, u = (pixel.first - 2) / (20 - 10 * v);
      const std::array expected{(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
      for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(s.lambda[(i + shift) & 3], expected[i], 1e-14);
    }
  }
}

TEST(Bilinear, CollapsedEdgeIsATriangle) {
  const std::array<Vec2, 3> v{{{22.5, 1.25}, {24.75, 27.5}, {2.5, 2.5}}};
  for (std::size_t twice = 0; twice < 4; ++twice) {
    std::array<Vec2, 4> point{};
    for (std::size_t i = 0; i < 4; ++i) point[(i + twice) & 3] = v[std::min<std::size_t>(i, 2)];
    const std::size_t a = (2 + twice) & 3, b = (3 + twice) & 3;  // the two corners at (2.5, 2.5)
    const auto pixels = by_pixel(*bilinear, quad_at(point), {32, 32, true});
    ASSERT_GT(pixels.size(), 100u);
    for (const auto& [pixel, s] : pixels) {
      ASSERT_FALSE(s.undefined) << pixel.first << ", " << pixel.second;
      const double share = area({pixel.first + 0.5, pixel.second + 0.5}, v[0], v[1]) / area(v[0], v[1], v[2]);
      ASSERT_NEAR(s.lambda[a] + s.lambda[b], share, 1e-13);
    }
    const MethodSample& pole = pixels.at({2, 2});
    EXPECT_EQ(pole.lambda[a], 0.5) << "every u shows the same point";
    EXPECT_EQ(pole.lambda[b], 0.5);
  }
}

TEST(Bilinear, EveryCoveredPixelOfAQuadInFrontHasARoot) {
  // Covered means that the border winds around the pixel, so the patch cannot miss it: folds have two roots or more,
  // never none. True for every shape; here also at roundings' worst.
  std::size_t concave_or_crossed = 0;
  for (const StressFamilyInfo& info : stress_families()) {
    for (const WindowQuad& given : make_stress(info.family, 100, 5, 1.0, 96, 96, 0)) {
      if (!std::ranges::all_of(given.vertex, [](const WindowVertex& v) { return v.w > 0; })) continue;
      Quad quad;
      quad.vertex = given.vertex;
      const auto samples = test::draw(*bilinear, quad, {96, 96, true});
      for (const MethodSample& s : samples) ASSERT_FALSE(s.undefined) << info.name << " " << s.x << ", " << s.y;
      std::array<int, 2> turns{};
      for (std::size_t i = 0; i < 4; ++i) {
        const double turn =
            area(on_screen(quad.vertex[i]), on_screen(quad.vertex[(i + 1) & 3]), on_screen(quad.vertex[(i + 2) & 3]));
        ++turns[turn > 0 ? 1 : 0];
      }
      if (turns[0] != 0 && turns[1] != 0) concave_or_crossed += samples.size();
    }
  }
  EXPECT_GT(concave_or_crossed, 20'000u);
}

/// f(v) = cross of p against the line from a + (d - a) v to b + (c - b) v: the quadratic whose roots are wanted, known
/// by its values at v = 0, 1, -1.
struct Quadratic {
  double k0, k1, k2;

  Quadratic(const std::array<Vec2, 4>& corner, const Vec2& p) {
    const auto at = [&](double v) {
      const auto mix = [v](const Vec2& from, const Vec2& to) {
        return Vec2{from[0] + (to[0] - from[0]) * v, from[1] + (to[1] - from[1]) * v};
      };
      return area(p, mix(corner[1], corner[2]), mix(corner[0], corner[3]));
    };
    k0 = at(0), k1 = (at(1) - at(-1)) / 2, k2 = (at(1) + at(-1)) / 2 - at(0);
  }

  double discriminant() const { return k1 * k1 - 4 * k0 * k2; }
};

/// The other root of the quadratic beside the v that was found, if its u and v are both inside [0, 1].
std::optional<double> other_root(const std::array<Vec2, 4>& v, const Vec2& p, double found) {
  const Quadratic f(v, p);
  if (std::abs(f.k2) < 1) return std::nullopt;
  const double other = -f.k1 / f.k2 - found;  // Vieta
  if (other <= 1e-6 || other >= 1 - 1e-6 || std::abs(other - found) < 1e-6) return std::nullopt;
  Vec2 left{}, right{};
  for (std::size_t i = 0; i < 2; ++i) {
    left[i] = v[0][i] + (v[3][i] - v[0][i]) * other;
    right[i] = v[1][i] + (v[2][i] - v[1][i]) * other;
  }
  const std::size_t i = std::abs(right[0] - left[0]) > std::abs(right[1] - left[1]) ? 0 : 1;
  const double u = (p[i] - left[i]) / (right[i] - left[i]);
  return u > 1e-6 && u < 1 - 1e-6 ? std::optional(other) : std::nullopt;
}

TEST(Bilinear, TwoRootsOnlyWithCornersBehindTheEye) {
  Prng random(3);
  std::size_t in_front = 0, two = 0;
  for (int n = 0; n < 400; ++n) {
    std::array<Vec2, 4> v{};
    for (Vec2& p : v) p = {random.uniform(0, 32), random.uniform(0, 32)};
    // Quilez' k2, cross(g, f), fixes which square root is the negative one.
    const double k2 = (v[0][0] - v[1][0] + v[2][0] - v[3][0]) * (v[3][1] - v[0][1]) -
                      (v[0][1] - v[1][1] + v[2][1] - v[3][1]) * (v[3][0] - v[0][0]);
    for (const bool behind : {false, true}) {
      const Quad quad = quad_at(v, {1, behind ? -1.0 : 1.0, 1, 1});
      for (const auto& [pixel, s] : by_pixel(*bilinear, quad, {32, 32, false})) {
        if (s.undefined) continue;
        const double found = s.lambda[2] + s.lambda[3];
        const auto other = other_root(v, {pixel.first + 0.5, pixel.second + 0.5}, found);
        in_front += behind ? 0 : 1;
        if (!other) continue;
        ASSERT_TRUE(behind);
        ++two;
        ASSERT_EQ(found<*other, k2> 0) << "(-k1 - root) / (2 k2) is the smaller one for positive k2";
      }
    }
  }
  EXPECT_GT(in_front, 20'000u);
  EXPECT_GT(two, 1000u);
}

// ---------------------------------------------------------------- corners behind the eye (Bloomenthal, figure 14)

/// A level square, one corner ahead, `back` behind its first place; eye at the origin, 90 degrees.
Quad floor_moved_back(double back, int size) {
  const std::array<Vec3, 4> corner{{{0, -0.7, -1.2}, {2, -0.7, -3.2}, {0, -0.7, -5.2}, {-2, -0.7, -3.2}}};
  Quad quad;
  for (std::size_t i = 0; i < 4; ++i) {
    const double w = -(corner[i][2] + back);
    quad.vertex[i] = {(corner[i][0] + w) / 2 * size, (w - corner[i][1]) / 2 * size, w - 0.1, w};
  }
  return quad;
}

TEST(Bilinear, RegionWithoutRootGrowsAsTheQuadMovesToTheRear) {
  constexpr int size = 128;
  std::size_t last_no_root = 0;
  for (int step = -4; step <= 8; ++step) {
    const double back = 1.225 + 0.05 * step;  // corner 0 passes the eye at 1.2
    const Quad quad = floor_moved_back(back, size);
    const bool behind = quad.vertex[0].w < 0;
    std::array<Vec2, 4> corner{};
    for (std::size_t i = 0; i < 4; ++i) corner[i] = on_screen(quad.vertex[i]);
    std::size_t no_root = 0, undefined = 0;
    const auto pixels = by_pixel(*bilinear, quad, {size, size, true});
    ASSERT_GT(pixels.size(), 1000u);
    for (const auto& [pixel, s] : pixels) {
      undefined += s.undefined ? 1 : 0;
      if (Quadratic(corner, {pixel.first + 0.5, pixel.second + 0.5}).discriminant() >= 0) continue;
      ++no_root;
      ASSERT_TRUE(s.undefined);
    }
    // No other pixel is undefined: roots outside of the square are taken.
    EXPECT_EQ(undefined, no_root) << back;
    if (behind)
      EXPECT_GT(no_root, last_no_root) << back;
    else
      EXPECT_EQ(no_root, 0u) << back;
    last_no_root = no_root;
  }
  EXPECT_GT(last_no_root, 4000u);
}

// A level rectangle whose two nearer corners are behind the eye: its edges 1-2 and 3-0 stay straight lines through the
// picture, and in space u is a linear function of x alone.
TEST(Bilinear, TwoCornersBehindTheEyeGetTheRootInFrontOfIt) {
  constexpr int size = 64;
  const std::array<Vec3, 4> corner{{{-1, -1, 1}, {1, -1, 1}, {1, -1, -5}, {-1, -1, -5}}};
  Quad quad;
  for (std::size_t i = 0; i < 4; ++i) {
    const double w = -corner[i][2];
    quad.vertex[i] = {(corner[i][0] + w) / 2 * size, (w - corner[i][1]) / 2 * size, w - 0.1, w};
  }
  const auto pixels = by_pixel(*bilinear, quad, {size, size, true});
  ASSERT_GT(pixels.size(), 500u);
  for (const auto& [pixel, s] : pixels) {
    // The ray through the pixel meets y = -1 at depth w with (1 - 2 y / size) w = -1.
    const double w = 1 / (2 * (pixel.second + 0.5) / size - 1), x = (2 * (pixel.first + 0.5) / size - 1) * w;
    ASSERT_FALSE(s.undefined);
    ASSERT_NEAR(s.lambda[1] + s.lambda[2], (x + 1) / 2, 1e-10);
    ASSERT_NEAR(s.lambda[2] + s.lambda[3], (w + 1) / 6, 1e-10);
  }
}

TEST(Bilinear, CoversWhatMeanValueCoordinatesCover) {
  for (const StressFamily family : {StressFamily::any_w, StressFamily::eye_crossing, StressFamily::w_zero}) {
    std::size_t undefined = 0, outside = 0;
    for (const WindowQuad& given : make_stress(family, 20, 2, 1.0, 64, 64, 0)) {
      Quad quad;
      quad.vertex = given.vertex;
      const auto found = by_pixel(*bilinear, quad, {64, 64, true});
      const auto mvc = by_pixel(*make_mvc(), quad, {64, 64, true});
      ASSERT_EQ(found.size(), mvc.size());
      for (const auto& [pixel, s] : found) {
        ASSERT_TRUE(mvc.contains(pixel));
        undefined += s.undefined ? 1 : 0;
        outside += s.undefined && std::isnan(s.z) && std::isnan(s.lambda[0]) ? 1 : 0;
      }
    }
    EXPECT_GT(undefined, 100u) << stress_family_name(family);
    EXPECT_EQ(outside, undefined);
  }
}

TEST(Bilinear, Census) {
  const std::vector<Quad> quads(3);
  EXPECT_EQ(bilinear->census(quads, {}), (Census{.quads = 3, .emitted_quads = 3}));
  EXPECT_EQ(bilinear->name(), "bilinear");
}

}  // namespace
}  // namespace quadrille::golden::methods
