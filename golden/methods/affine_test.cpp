// The affinity test against affinities and perturbations computed by hand; drawing against the affine map itself.
#include "golden/methods/affine.hpp"

#include "golden/methods/builders.hpp"
#include "golden/methods/surface_test_support.hpp"

#include <algorithm>

namespace quadrille::golden::methods {
namespace {

using namespace test;

constexpr View view64{64, 64, true};
constexpr View screen64{64, 64, false};

/// Corners at origin + u U + v V in homogeneous window space, which is object space too; texture (u, v).
Quad affine_quad(const std::array<Point, 4>& uv, const Vec3& origin, const Vec3& by_u, const Vec3& by_v) {
  Quad quad;
  for (std::size_t i = 0; i < 4; ++i) {
    Vec3 p = origin;
    for (std::size_t k = 0; k < 3; ++k) p[k] += uv[i][0] * by_u[k] + uv[i][1] * by_v[k];
    quad.vertex[i] = {p[0], p[1], 0.5 * p[2], p[2]};
    quad.object[i] = p;
    quad.texture[i] = uv[i];
    quad.attribute[i] = {uv[i][0], uv[i][1]};
  }
  return quad;
}

/// In the plane z = 0 with the texture coordinates of the unit square.
Quad flat_quad(const std::array<Point, 4>& position) {
  Quad quad = screen_quad(position);
  for (std::size_t i = 0; i < 4; ++i) quad.object[i] = {position[i][0], position[i][1], 0};
  return quad;
}

constexpr std::array<Point, 4> unit_square{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

Vec3 random_vector(Prng& prng, double size) {
  return {prng.uniform(-size, size), prng.uniform(-size, size), prng.uniform(-size, size)};
}

TEST(Affine, EveryAffineImageOfAnyShapePasses) {
  Prng prng(1);
  for (int n = 0; n < 300; ++n) {
    std::array<Point, 4> uv = unit_square;
    if (n % 2 == 1)
      for (Point& p : uv)
        for (double& c : p) c = prng.uniform(0, 1);
    Vec3 by_u = random_vector(prng, 1), by_v = random_vector(prng, 1);
    if (n % 3 == 0) by_v = {0, 0, 1};  // parallel to z: its areas have no z
    const Quad quad = affine_quad(uv, random_vector(prng, 10), by_u, by_v);
    EXPECT_TRUE(is_affine(quad, view64, 1e-6)) << n;
    // Any size: areas count as zero relative to the quad's.
    Quad small = quad;
    for (Vec3& p : small.object)
      for (double& c : p) c = std::ldexp(c, -30);
    EXPECT_TRUE(is_affine(small, view64, 1e-6)) << n;
  }
}

/// P2 = (1 + d, 1 + d) instead of (1, 1). By hand: P2 = (1 + d) P1 - (1 + 2 d) P0 + (1 + d) P3, for the texture with
/// d = 0: the coordinates differ by d (1, -2, 1), sqrt(6) d long; at the other corners by less.
TEST(Affine, ToleranceIsTheDistanceOfBarycentricCoordinates) {
  for (const double tolerance : {0.01, 0.1}) {
    const double d = tolerance / std::sqrt(6.0);
    for (const double factor : {0.999, 1.001}) {
      const double moved = 1 + d * factor;
      for (std::size_t first = 0; first < 4; ++first) {
        const Quad quad = flat_quad({{{0, 0}, {1, 0}, {moved, moved}, {0, 1}}});
        EXPECT_EQ(is_affine(renumbered(quad, first, false), view64, tolerance), factor < 1);
        EXPECT_EQ(is_affine(renumbered(quad, first, true), view64, tolerance), factor < 1);
      }
    }
  }
}

TEST(Affine, ACornerOffThePlaneIsNotAffine) {
  // The extent is sqrt(2).
  Quad quad = flat_quad(unit_square);
  quad.object[2][2] = 0.014;
  EXPECT_TRUE(is_affine(quad, view64, 0.01));
  quad.object[2][2] = 0.0145;
  EXPECT_FALSE(is_affine(quad, view64, 0.01));
}

TEST(Affine, OtherNumbersOfAttributes) {
  const Quad square = flat_quad(unit_square);
  const auto with = [&](const std::array<std::vector<double>, 4>& attribute) {
    Quad quad = square;
    quad.attribute = attribute;
    return is_affine(quad, view64, 0.01);
  };
  EXPECT_TRUE(with({}));
  // On a parallelogram a_0 - a_1 + a_2 - a_3 must be within the tolerance of the largest difference, 5.
  EXPECT_TRUE(with({{{1}, {3}, {6}, {4}}}));
  EXPECT_TRUE(with({{{1}, {3}, {6}, {4.049}}}));
  EXPECT_FALSE(with({{{1}, {3}, {6}, {4.051}}}));
  EXPECT_TRUE(with({{{7}, {7}, {7}, {7}}}));
  // Bloomenthal figure 10: blue, red, yellow, cyan are a square in colour space, with green and black they are not.
  EXPECT_TRUE(with({{{0, 0, 1}, {1, 0, 0}, {1, 1, 0}, {0, 1, 1}}}));
  EXPECT_FALSE(with({{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}}}));
  EXPECT_FALSE(with({{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}));
}

TEST(Affine, TrianglesAreAffineAndCollapsedEdgesWithTwoTexturesAreNot) {
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    Quad quad = flat_quad({{{3, 2}, {50, 9}, {44, 60}, {7, 41}}});
    quad.vertex[j] = quad.vertex[i];
    quad.object[j] = quad.object[i];
    EXPECT_FALSE(is_affine(quad, view64, 0.01));
    quad.attribute[j] = quad.attribute[i];
    EXPECT_TRUE(is_affine(quad, view64, 0.01));
  }
}

TEST(Affine, WithoutPerspectiveTheScreenIsTheGeometry) {
  // A square in space whose far side is half as long on the screen.
  Quad quad = flat_quad(unit_square);
  quad.vertex = {{{8, 8, 0, 1}, {40, 8, 0, 1}, {64, 40, 0, 2}, {32, 40, 0, 2}}};
  EXPECT_TRUE(is_affine(quad, view64, 0.01));
  EXPECT_FALSE(is_affine(quad, screen64, 0.01));
  // A parallelogram on the screen that is none in space.
  Quad parallelogram = screen_quad({{{8, 8}, {40, 12}, {44, 50}, {12, 46}}}, {1, 2, 3, 1});
  EXPECT_FALSE(is_affine(parallelogram, view64, 0.01));
  EXPECT_TRUE(is_affine(parallelogram, screen64, 0.01));
  // The same screen point, behind the eye.
  WindowVertex& v = parallelogram.vertex[0];
  v = {-v.x, -v.y, -v.z, -v.w};
  EXPECT_FALSE(is_affine(parallelogram, screen64, 0.01));
}

// ---------------------------------------------------------------- drawing

/// (u, v) of the plane's point at a pixel: origin + u U + v V is a multiple of (x, y, 1), solved with Cramer's rule.
Point plane_uv(const Vec3& origin, const Vec3& by_u, const Vec3& by_v, int x, int y) {
  const auto vertex = [](const Vec3& p) { return WindowVertex{p[0], p[1], 0, p[2]}; };
  const auto m = cramer({vertex(origin), vertex(by_u), vertex(by_v)}, x + 0.5, y + 0.5).m;
  return {static_cast<double>(m[1] / m[0]), static_cast<double>(m[2] / m[0])};
}

/// Inside the polygon by its winding number, from angles.
bool winds(const std::array<Point, 4>& polygon, double x, double y) {
  double turned = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Point &p = polygon[i], &q = polygon[(i + 1) % 4];
    turned += std::remainder(std::atan2(q[1] - y, q[0] - x) - std::atan2(p[1] - y, p[0] - x), 2 * M_PI);
  }
  return std::abs(turned) > 1;
}

TEST(Affine, DrawsTheAffineMapInsideTheQuad) {
  Prng prng(2);
  const std::array<std::array<Point, 4>, 4> shapes{{unit_square,
                                                    {{{0, 0}, {1, 0.1}, {0.9, 0.8}, {0.2, 1}}},
                                                    {{{0, 0}, {1, 0}, {0.3, 0.3}, {0, 1}}},
                                                    {{{0, 0}, {1, 0}, {0, 1}, {1, 1}}}}};
  const auto method = make_affine(0.01);
  int compared = 0;
  for (int n = 0; n < 80; ++n) {
    const auto& uv = shapes[static_cast<std::size_t>(n) % 4];
    const bool through_eye = n % 8 >= 4;
    const Vec3 origin{prng.uniform(0, 40), prng.uniform(0, 40), 1};
    const Vec3 by_u{prng.uniform(20, 90), prng.uniform(-20, 20), prng.uniform(-0.4, 0.4) * (through_eye ? 4 : 1)};
    const Vec3 by_v{prng.uniform(-20, 20), prng.uniform(20, 90), prng.uniform(-0.4, 0.4) * (through_eye ? 4 : 1)};
    const Quad quad = affine_quad(uv, origin, by_u, by_v);
    ASSERT_TRUE(is_affine(quad, view64, 0.01));
    std::vector<int> count(64 * 64);
    for (const MethodSample& sample : draw(*method, quad, view64)) {
      const Point expected = plane_uv(origin, by_u, by_v, sample.x, sample.y);
      for (std::size_t k = 0; k < 2; ++k) {
        double attribute = 0;
        for (std::size_t i = 0; i < 4; ++i) attribute += sample.lambda[i] * quad.attribute[i][k];
        ASSERT_NEAR(attribute, expected[k], 1e-9) << n << ": " << sample.x << ", " << sample.y;
      }
      ++count[static_cast<std::size_t>(sample.y * 64 + sample.x)];
      ++compared;
    }
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x) {
        const Point p = plane_uv(origin, by_u, by_v, x, y);
        const double w = origin[2] + p[0] * by_u[2] + p[1] * by_v[2];
        const auto inside = [&](double du, double dv) { return w > 0 && winds(uv, p[0] + du, p[1] + dv); };
        const bool covered = inside(0, 0);
        if (inside(1e-7, 0) != covered || inside(0, 1e-7) != covered || inside(-1e-7, 0) != covered) continue;
        ASSERT_EQ(count[static_cast<std::size_t>(y * 64 + x)], covered ? 1 : 0) << n << ": " << x << ", " << y;
      }
    }
  }
  EXPECT_GT(compared, 50'000);
}

TEST(Affine, ReproducesCornersAndIsLinearOnEdges) {
  for (const double tolerance : {0.01, 1.0}) {
    expect_corners_and_linear_edges(*make_affine(tolerance), view64);
    expect_corners_and_linear_edges(*make_affine(tolerance), screen64);
  }
}

TEST(Affine, OtherQuadsAreMeanValueQuads) {
  const Quad quad = flat_quad({{{3, 2}, {50, 9}, {44, 60}, {7, 41}}});
  ASSERT_FALSE(is_affine(quad, view64, 0.01));
  const auto drawn = draw(*make_affine(0.01), quad, view64), expected = draw(*make_mvc(), quad, view64);
  ASSERT_GT(expected.size(), 1000u);
  ASSERT_EQ(drawn.size(), expected.size());
  for (std::size_t i = 0; i < drawn.size(); ++i) ASSERT_EQ(drawn[i].lambda, expected[i].lambda);
  // An affine one is not: one of its weights is zero, on either side of the diagonal.
  const Quad square = flat_quad({{{8, 8}, {48, 8}, {48, 48}, {8, 48}}});
  for (const MethodSample& sample : draw(*make_affine(0.01), square, view64))
    ASSERT_EQ(sample.lambda[sample.x > sample.y ? 3 : 1], 0);
  for (const MethodSample& sample : draw(*make_affine(0.01), renumbered(square, 0, true), view64))
    ASSERT_EQ(sample.lambda[sample.x > sample.y ? 1 : 3], 0);
}

TEST(Affine, CensusCountsWhatIsDrawn) {
  const Quad square = flat_quad({{{8, 8}, {48, 8}, {48, 48}, {8, 48}}});
  const Quad other = flat_quad({{{3, 2}, {50, 9}, {44, 60}, {7, 41}}});
  const auto census = [](const std::vector<Quad>& quads) { return make_affine(0.01)->census(quads, view64); };
  EXPECT_EQ(census({square, other, square}), (Census{.quads = 3, .emitted_quads = 3, .triangles = 2 + 2, .affine = 2}));
  // One triangle, whichever edge is collapsed: one half of the split has no area.
  for (std::size_t first = 0; first < 4; ++first)
    EXPECT_EQ(census({renumbered(triangle_quad(), first, false)}),
              (Census{.quads = 1, .emitted_quads = 1, .triangles = 1, .affine = 1}));
  // Affine images that are concave, corner 2 inside, and crossed are drawn with mean value coordinates.
  for (const Quad& quad : {affine_quad({{{0, 0}, {1, 0}, {0.3, 0.3}, {0, 1}}}, {8, 8, 1}, {40, 0, 0}, {0, 40, 0}),
                           affine_quad({{{0, 0}, {1, 0}, {0, 1}, {1, 1}}}, {8, 8, 1}, {40, 0, 0}, {0, 40, 0})}) {
    ASSERT_TRUE(is_affine(quad, view64, 0.01));
    EXPECT_EQ(census({quad}), (Census{.quads = 1, .emitted_quads = 1}));
    const auto drawn = draw(*make_affine(0.01), quad, view64), expected = draw(*make_mvc(), quad, view64);
    ASSERT_GT(expected.size(), 100u);
    ASSERT_EQ(drawn.size(), expected.size());
    for (std::size_t i = 0; i < drawn.size(); ++i) ASSERT_EQ(drawn[i].lambda, expected[i].lambda);
  }
  EXPECT_EQ(make_affine(0.01)->name(), "affine:0.01");
}

}  // namespace
}  // namespace quadrille::golden::methods
