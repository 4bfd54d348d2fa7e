// Adaptive subdivision: the paper's figures, the bilinear surface, the stopping rules, T-vertices counted by hand.
#include "golden/methods/adaptive.hpp"

#include "golden/methods/builders.hpp"
#include "golden/methods/surface_test_support.hpp"

#include <algorithm>

namespace quadrille::golden::methods {
namespace {

using namespace test;

constexpr View view64{64, 64, true};
constexpr View view512{512, 512, true};

/// Object space (x, y, 0), the screen a multiple of it, so that the projected area is `area`.
Quad planar_quad(const std::array<Point, 4>& shape, double shape_area, double area) {
  const double scale = std::sqrt(area / shape_area);
  std::array<Point, 4> screen = shape;
  for (Point& p : screen)
    for (double& c : p) c = 8.3 + scale * c;
  Quad quad = screen_quad(screen);
  for (std::size_t i = 0; i < 4; ++i) quad.object[i] = {shape[i][0], shape[i][1], 0};
  return quad;
}

/// The trapezoid A = (0, 0), B = (1, 0), C = (3/4, 1), D = (1/4, 1) of area 3/4.
constexpr std::array<Point, 4> trapezoid{{{0, 0}, {1, 0}, {0.75, 1}, {0.25, 1}}};

/// How many parts the trapezoid has by the closed form of its two differences: on the part at (s, t) of size e with
/// P(s, t) = (s + t (1 - 2 s)/4, t) the edges along s are e (1 - t/2) and e (1 - (t + e)/2) long, those along t lean by
/// e (1 - 2 s)/4 and e (1 - 2 s - 2 e)/4, hence |V1·V2 - V3·V4| = e^3 |1 - t/2 - (1 - 2 s)/4| / 2 and
/// |V1·V4 - V2·V3| = e^3 |1 - t/2 + (1 - 2 s)/4 - e/2| / 2.
std::size_t trapezoid_parts(double s, double t, double e, double area) {
  const double d1 = e * e * e / 2 * std::abs(1 - t / 2 - (1 - 2 * s) / 4);
  const double d2 = e * e * e / 2 * std::abs(1 - t / 2 + (1 - 2 * s) / 4 - e / 2);
  if (area < 200 || (d1 < 1e-3 && d2 < 1e-3)) return 1;
  const double h = e / 2;
  return trapezoid_parts(s, t, h, area / 4) + trapezoid_parts(s + h, t, h, area / 4) +
         trapezoid_parts(s, t + h, h, area / 4) + trapezoid_parts(s + h, t + h, h, area / 4);
}

TEST(Adaptive, FewerPartsForSmallerProjectionsAsInFigure13) {
  std::size_t previous = 1u << 20;
  for (const double area : {33600.0, 11879.0, 3051.0, 795.0, 197.0}) {
    const std::size_t parts = subdivide(planar_quad(trapezoid, 0.75, area), view512, 1e-3).size();
    EXPECT_LT(parts, previous);
    EXPECT_EQ(parts, trapezoid_parts(0, 0, 1, area)) << area;
    previous = parts;
  }
  EXPECT_EQ(previous, 1u);
}

TEST(Adaptive, ParallelogramsAreNotSubdivided) {
  const std::array<Point, 4> shape{{{0, 0}, {2, 0.5}, {3, 2.5}, {1, 2}}};  // area 2 · 2 - 0.5 · 1
  Quad quad = planar_quad(shape, 3.5, 100'000);
  EXPECT_EQ(subdivide(quad, view512, 1e-3).size(), 1u);
  // In perspective too: only object and texture space count. Five pixels to the left at the far side.
  for (const std::size_t i : {2, 3}) {
    WindowVertex& v = quad.vertex[i];
    v = {(v.x - 5) * 3, v.y * 3, v.z * 3, 3};
  }
  EXPECT_EQ(subdivide(quad, view512, 1e-3).size(), 1u);

  Quad bent = quad;
  bent.object[2][0] += 0.1;
  EXPECT_GT(subdivide(bent, view512, 1e-3).size(), 1u);
  // V1 = (-2, -0.5), V2 = (1.1, 2), V3 = (2.1, 0.5), V4 = (-1, -2): d1 = |-3.2 + 3.1|, d2 = |3 - 3.31|.
  EXPECT_EQ(subdivide(bent, view512, 0.32).size(), 1u);
  EXPECT_GT(subdivide(bent, view512, 0.30).size(), 1u);
}

TEST(Adaptive, TheTextureHasATenthOfTheThreshold) {
  Quad quad = planar_quad({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}, 1, 100'000);
  // C = (1 + d, 1): V1 = (-1, 0), V2 = (d, 1), V3 = (1 + d, 0), V4 = (0, -1): differences d and d (1 + d).
  quad.texture[2][0] = 1 + 0x1p-10;
  const double largest = 0x1p-10 * (1 + 0x1p-10);
  EXPECT_EQ(subdivide(quad, view512, 10 * largest * 1.001).size(), 1u);
  EXPECT_EQ(subdivide(quad, view512, 10 * largest * 0.999).size(), 4u);
  // The same in object space has the threshold itself.
  quad.texture[2][0] = 1;
  quad.object[2][0] = 1 + 0x1p-10;
  EXPECT_EQ(subdivide(quad, view512, largest * 1.001).size(), 1u);
  EXPECT_EQ(subdivide(quad, view512, largest * 0.999).size(), 4u);
}

/// Every corner of every part is the bilinear surface's point at its weights, in window, object and texture space; the
/// parts tile the unit square.
TEST(Adaptive, PartsAreOnTheBilinearSurface) {
  Prng prng(1);
  for (int n = 0; n < 30; ++n) {
    Quad quad = random_quad(prng, 512, n % 3 == 0);
    for (Vec3& p : quad.object)
      for (double& c : p) c = prng.uniform(-1, 1);
    for (Vec2& p : quad.texture)
      for (double& c : p) c = prng.uniform(0, 1);
    const auto parts = subdivide(quad, view512, 1e-2);
    ASSERT_GT(parts.size(), 1u);
    double tiled = 0;
    for (const SubQuad& part : parts) {
      std::array<Point, 4> st{};
      for (std::size_t i = 0; i < 4; ++i) {
        const auto& w = part.corner[i].weight;
        const double s = w[1] + w[2], t = w[2] + w[3];
        st[i] = {s, t};
        // Multiples of 2^-10: exact.
        ASSERT_EQ(w, (std::array<double, 4>{(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t}));
        const auto blend = [&](auto&& value) {
          double sum = 0;
          for (std::size_t k = 0; k < 4; ++k) sum += w[k] * value(k);
          return sum;
        };
        const WindowVertex& v = part.corner[i].vertex;
        ASSERT_NEAR(v.x, blend([&](std::size_t k) { return quad.vertex[k].x; }), 1e-11);
        ASSERT_NEAR(v.y, blend([&](std::size_t k) { return quad.vertex[k].y; }), 1e-11);
        ASSERT_NEAR(v.z, blend([&](std::size_t k) { return quad.vertex[k].z; }), 1e-14);
        ASSERT_NEAR(v.w, blend([&](std::size_t k) { return quad.vertex[k].w; }), 1e-14);
        for (std::size_t c = 0; c < 3; ++c)
          ASSERT_NEAR(part.object[i][c], blend([&](std::size_t k) { return quad.object[k][c]; }), 1e-14);
        for (std::size_t c = 0; c < 2; ++c)
          ASSERT_NEAR(part.texture[i][c], blend([&](std::size_t k) { return quad.texture[k][c]; }), 1e-14);
      }
      const double size = st[1][0] - st[0][0];
      ASSERT_EQ(st[1], (Point{st[0][0] + size, st[0][1]}));
      ASSERT_EQ(st[2], (Point{st[0][0] + size, st[0][1] + size}));
      ASSERT_EQ(st[3], (Point{st[0][0], st[0][1] + size}));
      tiled += size * size;
    }
    ASSERT_EQ(tiled, 1);
  }
}

TEST(Adaptive, ReproducesCornersAndIsLinearOnEdges) { expect_corners_and_linear_edges(*make_adaptive(1e-3), view64); }

TEST(Adaptive, DrawsTheBilinearSurface) {
  const Quad quad = planar_quad(trapezoid, 0.75, 33600);
  const auto error = [&](const Method& method) {
    double largest = 0;
    const auto samples = draw(method, quad, view512);
    EXPECT_NEAR(static_cast<double>(samples.size()), 33600, 300);
    for (const MethodSample& sample : samples) largest = std::fmax(largest, bilinear_error(quad, sample));
    return largest;
  };
  // The split's error on parts of size e is about e^2 of that on the whole quad (twice that at the trapezoid's narrow
  // end, where they are as oblique and half as wide); the largest parts have e = 1/8.
  const double split = error(*make_split(Diagonal::v0_v2));
  EXPECT_GT(split, 0.05);
  EXPECT_LT(error(*make_adaptive(1e-3)), split / 32);
  EXPECT_NEAR(error(*make_adaptive(1)), split, 1e-12);  // above both differences, 0.375 and 0.125: one part
}

TEST(Adaptive, AreaIsTestedOnPlanarQuadsOnly) {
  // Some 150 pixels: a planar quad stays whole whatever its shape.
  Quad quad = planar_quad(trapezoid, 0.75, 150);
  EXPECT_EQ(subdivide(quad, view512, 1e-3).size(), 1u);
  // The largest distance is sqrt(25/16): corner 3 off the plane of the others by 1e-6 of it and a little less or more
  // (that plane is of triangle 012, the largest).
  quad.object[3][2] = 1.24e-6;
  EXPECT_EQ(subdivide(quad, view512, 1e-3).size(), 1u);
  quad.object[3][2] = 1.26e-6;
  EXPECT_EQ(subdivide(quad, view512, 1e-3).size(), trapezoid_parts(0, 0, 1, HUGE_VAL));
  // Corner 3 almost on the line of 0 and 1: the plane of these three would be off corner 2 by far more.
  Quad sliver = planar_quad({{{0, 0}, {1, 0}, {0.5, 1}, {0.5, -0.001}}}, 0.5, 150);
  sliver.object[3][2] = 1e-7;
  EXPECT_EQ(subdivide(sliver, view512, 1e-3).size(), 1u);
}

TEST(Adaptive, BehindTheEyeTheAreaIsTheViewports) {
  Quad quad = planar_quad(trapezoid, 0.75, 150);
  for (std::size_t i = 0; i < 4; ++i)
    for (double& c : quad.object[i]) c *= 1000;  // every difference is above the threshold at every level
  quad.vertex[1].w = -0.25;
  // 64 · 64 = 4096 pixels, 1024, 256, 64; 512 · 512 / 4^5 = 256, / 4^6 = 64.
  EXPECT_EQ(subdivide(quad, view64, 1e-3).size(), 64u);
  EXPECT_EQ(subdivide(quad, view512, 1e-3).size(), 4096u);
}

TEST(Adaptive, TrianglesStayWhole) {
  Quad quad = planar_quad({{{0, 0}, {1, 0}, {0.5, 1}, {0.5, 1}}}, 0.5, 30'000);
  quad.vertex[3] = quad.vertex[2];
  const auto method = make_adaptive(1e-3);
  EXPECT_GT(subdivide(quad, view512, 1e-3).size(), 1u);  // a collapsed edge that still has two texture coordinates
  quad.texture[3] = quad.texture[2];
  quad.attribute[3] = quad.attribute[2];
  EXPECT_EQ(subdivide(quad, view512, 1e-3).size(), 1u);
  const Census census = method->census(std::vector{quad}, view512);
  EXPECT_EQ(census.emitted_quads, 1u);
  EXPECT_EQ(census.triangles, 1u);
  quad.attribute[3].push_back(1);
  EXPECT_GT(subdivide(quad, view512, 1e-3).size(), 1u);  // or two attributes
}

// ---------------------------------------------------------------- T-vertices

/// A quad that is huge in object space, so that only the area stops: `levels` levels.
Quad halved_quad(const std::array<Point, 4>& s, int levels) {
  const double twice = (s[2][0] - s[0][0]) * (s[3][1] - s[1][1]) - (s[2][1] - s[0][1]) * (s[3][0] - s[1][0]);
  Quad quad = planar_quad(s, std::abs(twice) / 2, 150 * std::pow(4.0, levels));
  for (Vec3& p : quad.object)
    for (double& c : p) c *= 1024;
  return quad;
}

TEST(Adaptive, TVerticesOfNeighboursAtOtherLevels) {
  const auto method = make_adaptive(1e-3);
  // Edge (1, 0)-(1, 1) is shared.
  const std::array<Point, 4> left{{{0, 0}, {1, 0}, {1, 1}, {0.25, 1.5}}}, right{{{1, 0}, {2, 0.25}, {1.75, 1}, {1, 1}}};
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      const std::vector<Quad> quads{halved_quad(left, a), renumbered(halved_quad(right, b), 2, true)};
      const Census census = method->census(quads, view512);
      const auto parts = static_cast<std::uint64_t>((1 << 2 * a) + (1 << 2 * b));
      EXPECT_EQ(census.quads, 2u);
      EXPECT_EQ(census.emitted_quads, parts);
      EXPECT_EQ(census.triangles, 2 * parts);
      // 2^max + 1 points on the edge, 2^min + 1 of which both sides have.
      EXPECT_EQ(census.t_vertices, static_cast<std::uint64_t>((1 << std::max(a, b)) - (1 << std::min(a, b))));
    }
  }
}

/// Three quads at one edge, of 4, 2 and 1 pieces: its three inner points, two of which are inside two edges.
TEST(Adaptive, TVerticesAreCountedOnceAPosition) {
  const std::array<Point, 4> left{{{0, 0}, {1, 0}, {1, 1}, {0.25, 1.5}}}, right{{{1, 0}, {2, 0.25}, {1.75, 1}, {1, 1}}};
  const std::array<Point, 4> third{{{1, 0}, {3, 0}, {2.5, 2}, {1, 1}}};
  const std::vector<Quad> quads{halved_quad(left, 2), halved_quad(right, 1), halved_quad(third, 0)};
  EXPECT_EQ(make_adaptive(1e-3)->census(quads, view512).t_vertices, 3u);
}

TEST(Adaptive, TVerticesInsideAQuadAgainstEveryPair) {
  std::uint64_t total = 0;
  Prng prng(2);
  for (int n = 0; n < 100; ++n) {
    const double threshold = prng.log2_spread(-12, -4);
    std::array<Point, 4> shape{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (Point& p : shape)
      for (double& c : p) c += prng.uniform(-0.35, 0.35);
    const Quad quad = planar_quad(shape, 1, 2e7);
    // In integers: (s, t) in units of 2^-10.
    using Grid = std::array<int, 2>;
    std::vector<std::array<Grid, 4>> parts;
    std::vector<Grid> vertices;
    for (const SubQuad& part : subdivide(quad, view512, threshold)) {
      parts.emplace_back();
      for (std::size_t i = 0; i < 4; ++i) {
        const auto& w = part.corner[i].weight;
        vertices.push_back(
            parts.back()[i] = {static_cast<int>((w[1] + w[2]) * 1024), static_cast<int>((w[2] + w[3]) * 1024)});
      }
    }
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::uint64_t expected = 0;
    for (const Grid& v : vertices) {
      const auto inside = [&](const std::array<Grid, 4>& part) {
        const bool s_in = part[0][0] < v[0] && v[0] < part[2][0], t_in = part[0][1] < v[1] && v[1] < part[2][1];
        const bool s_on = part[0][0] == v[0] || v[0] == part[2][0], t_on = part[0][1] == v[1] || v[1] == part[2][1];
        return (s_in && t_on) || (t_in && s_on);
      };
      expected += std::ranges::any_of(parts, inside) ? 1 : 0;
    }
    EXPECT_EQ(make_adaptive(threshold)->census(std::vector{quad}, view512).t_vertices, expected);
    total += expected;
  }
  EXPECT_GT(total, 100u);
}

TEST(Adaptive, NameAndWireframe) {
  EXPECT_EQ(make_adaptive(1e-3)->name(), "adaptive:0.001");
  const Quad quad = planar_quad(trapezoid, 0.75, 11879);
  const auto parts = subdivide(quad, view512, 1e-3);
  const auto outlines = make_adaptive(1e-3)->wireframe(quad, view512);
  ASSERT_EQ(outlines.size(), parts.size());
  for (std::size_t n = 0; n < parts.size(); ++n) {
    ASSERT_EQ(outlines[n].size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(outlines[n][i].x, parts[n].corner[i].vertex.x);
  }
}

}  // namespace
}  // namespace quadrille::golden::methods
