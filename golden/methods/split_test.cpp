// The diagonal split against Cramer's rule in 113 bits, equation 11 of Hormann & Tarini, and clipped geometry.
#include "golden/methods/builders.hpp"
#include "golden/methods/surface_test_support.hpp"

#include <algorithm>
#include <map>

namespace quadrille::golden::methods {
namespace {

using namespace test;
using Corners = std::array<std::size_t, 3>;

constexpr View view64{64, 64, true};
constexpr std::array<std::array<Corners, 2>, 2> triangles{
    {{Corners{0, 1, 2}, Corners{0, 2, 3}}, {Corners{1, 2, 3}, Corners{1, 3, 0}}}};

std::unique_ptr<Method> split(std::size_t which) { return make_split(which == 0 ? Diagonal::v0_v2 : Diagonal::v1_v3); }

/// What the first and the second triangle give a pixel.
using Pixels = std::map<std::array<int, 2>, std::vector<MethodSample>>;

Pixels by_pixel(const std::vector<MethodSample>& samples) {
  Pixels pixels;
  for (const MethodSample& sample : samples) pixels[{sample.x, sample.y}].push_back(sample);
  return pixels;
}

double largest_difference(const MethodSample& a, const MethodSample& b) {
  double d = std::abs(a.z - b.z);
  for (std::size_t i = 0; i < 4; ++i) d = std::fmax(d, std::abs(a.lambda[i] - b.lambda[i]));
  return d;
}

/// Barycentric coordinates in space of a triangle at a sample's pixel.
std::array<double, 3> weights_of(const std::array<WindowVertex, 3>& v, const MethodSample& sample) {
  const std::array<Real, 3> m = cramer(v, sample.x + Real{0.5}, sample.y + Real{0.5}).m;
  const Real sum = m[0] + m[1] + m[2];
  return {static_cast<double>(m[0] / sum), static_cast<double>(m[1] / sum), static_cast<double>(m[2] / sum)};
}

void compare_with_cramer(const Quad& quad, std::size_t which, const View& view, int& compared) {
  const Pixels drawn = by_pixel(draw(*split(which), quad, view));
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      std::vector<MethodSample> expected;
      bool on_edge = false;
      for (const Corners& corner : triangles[which]) {
        const std::array<WindowVertex, 3> v{quad.vertex[corner[0]], quad.vertex[corner[1]], quad.vertex[corner[2]]};
        const auto [m, determinant] = cramer(v, x + Real{0.5}, y + Real{0.5});
        const auto [low, high] = std::ranges::minmax(m);
        const Real scale = high > -low ? high : -low;
        for (const Real k : m) on_edge |= k < scale * 1e-9 && -k < scale * 1e-9;
        if (low < 0) continue;
        MethodSample sample{x, y, determinant < 0, false, 0, {}};
        Real z = 0;
        for (std::size_t i = 0; i < 3; ++i) {
          z += m[i] * v[i].z;
          sample.lambda[corner[i]] =
              static_cast<double>(view.perspective ? m[i] / (m[0] + m[1] + m[2]) : m[i] * v[i].w);
        }
        sample.z = static_cast<double>(z);
        expected.push_back(sample);
      }
      if (on_edge) continue;
      const auto found = drawn.find({x, y});
      ASSERT_EQ(found == drawn.end() ? 0u : found->second.size(), expected.size()) << x << ", " << y;
      for (std::size_t n = 0; n < expected.size(); ++n) {
        const MethodSample& sample = found->second[n];
        const double size = std::ranges::max(expected[n].lambda, {}, [](double l) { return std::abs(l); });
        ASSERT_LT(largest_difference(sample, expected[n]), 1e-9 * std::abs(size)) << x << ", " << y;
        ASSERT_EQ(sample.front, expected[n].front);
        ++compared;
      }
    }
  }
}

TEST(Split, AgreesWithCramersRule) {
  Prng prng(1);
  int compared = 0;
  for (int n = 0; n < 80; ++n) {
    const Quad quad = random_quad(prng, 64, n % 2 == 1);
    for (const bool perspective : {true, false})
      compare_with_cramer(quad, prng.below(2), View{64, 64, perspective}, compared);
  }
  EXPECT_GT(compared, 50'000);
}

/// H&T equation 11 with the areas of equation 5, on the one triangle that holds a pixel of a convex quad.
TEST(Split, InterpolatesAttributesOverWAsEquation11) {
  const Quad quad = centred_quad(centred_corners);
  for (const std::size_t which : {0, 1}) {
    const std::vector<MethodSample> samples = draw(*split(which), quad, view64);
    ASSERT_GT(samples.size(), 1000u);
    for (const MethodSample& sample : samples) {
      const Real x = sample.x + 0.5, y = sample.y + 0.5;
      const auto area = [&](std::size_t i, std::size_t j) {
        const Point &p = centred_corners[i], &q = centred_corners[j];
        return (p[0] - x) * (q[1] - y) - (p[1] - y) * (q[0] - x);
      };
      std::array<Real, 4> expected{};
      for (const auto& [a, b, c] : triangles[which]) {
        const std::array<Real, 3> share{area(b, c), area(c, a), area(a, b)};
        if (std::ranges::any_of(share, [](Real s) { return s < 0; })) continue;
        expected = {};
        for (const auto& [corner, s] : {std::pair{a, share[0]}, {b, share[1]}, {c, share[2]}})
          expected[corner] = s / quad.vertex[corner].w;
      }
      const Real sum = expected[0] + expected[1] + expected[2] + expected[3];
      for (std::size_t i = 0; i < 4; ++i)
        ASSERT_NEAR(sample.lambda[i], static_cast<double>(expected[i] / sum), 1e-13) << sample.x << ", " << sample.y;
      ASSERT_FALSE(sample.front);  // the corners go clockwise on the screen
    }
  }
}

TEST(Split, ReproducesCornersAndIsLinearOnEdges) {
  for (const std::size_t which : {0, 1}) {
    expect_corners_and_linear_edges(*split(which), view64);
    expect_corners_and_linear_edges(*split(which), View{64, 64, false});
  }
}

TEST(Split, AtACornerThatIsDrawnTheWeightIsExact) {
  // A step to the right of corner 0 is inside: the tie rule draws it.
  const Quad quad = screen_quad({{{10.5, 20.5}, {50.5, 10.5}, {44.5, 50.5}, {20.5, 48.5}}}, {1, 2, 3, 4});
  const auto sample = sample_at(draw(*split(0), quad, view64), 10.5, 20.5);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->lambda, (std::array<double, 4>{1, 0, 0, 0}));
}

struct ClippedVertex {
  std::array<long double, 4> p{};  ///< x̃, ỹ, z̃, w
  std::array<long double, 4> weight{};
};

/// Sutherland and Hodgman against w >= low.
std::vector<ClippedVertex> clip(const std::vector<ClippedVertex>& polygon, long double low) {
  std::vector<ClippedVertex> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const ClippedVertex &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if (a.p[3] >= low) out.push_back(a);
    if ((a.p[3] >= low) == (b.p[3] >= low)) continue;
    const long double f = (low - a.p[3]) / (b.p[3] - a.p[3]);
    ClippedVertex v;
    for (std::size_t k = 0; k < 4; ++k) {
      v.p[k] = a.p[k] + f * (b.p[k] - a.p[k]);
      v.weight[k] = a.weight[k] + f * (b.weight[k] - a.weight[k]);
    }
    out.push_back(v);
  }
  return out;
}

TEST(Split, QuadsThroughTheEyePlaneAreTheirClippedGeometry) {
  Prng prng(2);
  int compared = 0;
  for (int n = 0; n < 120; ++n) {
    const Quad quad = random_quad(prng, 64, true);
    const std::size_t which = prng.below(2);
    const Pixels drawn = by_pixel(draw(*split(which), quad, view64));
    std::vector<std::vector<ClippedVertex>> polygons;
    for (const Corners& corner : triangles[which]) {
      std::vector<ClippedVertex> polygon;
      for (const std::size_t k : corner) {
        const WindowVertex& v = quad.vertex[k];
        polygon.push_back({{v.x, v.y, v.z, v.w}, {}});
        polygon.back().weight[k] = 1;
      }
      polygons.push_back(clip(polygon, 1e-9L));
    }
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x) {
        std::vector<std::array<long double, 4>> expected;
        bool near_edge = false;
        for (const auto& polygon : polygons) {
          // A fan of plane triangles on the screen, each with 1/w and weight/w linear.
          for (std::size_t i = 2; i < polygon.size(); ++i) {
            const std::array<const ClippedVertex*, 3> v{&polygon[0], &polygon[i - 1], &polygon[i]};
            std::array<long double, 3> area{};
            for (std::size_t k = 0; k < 3; ++k) {
              const auto &p = v[(k + 1) % 3]->p, &q = v[(k + 2) % 3]->p;
              const long double px = p[0] / p[3] - x - 0.5L, py = p[1] / p[3] - y - 0.5L;
              const long double qx = q[0] / q[3] - x - 0.5L, qy = q[1] / q[3] - y - 0.5L;
              area[k] = px * qy - py * qx;
              near_edge |= std::abs(area[k]) < 1e-4L * (1 + std::hypot(px - qx, py - qy));
            }
            const long double sign = area[0] > 0 ? 1 : -1;
            if (area[1] * sign < 0 || area[2] * sign < 0) continue;
            long double one_over_w = 0;
            std::array<long double, 4> weight{};
            for (std::size_t k = 0; k < 3; ++k) {
              one_over_w += area[k] / v[k]->p[3];
              for (std::size_t j = 0; j < 4; ++j) weight[j] += area[k] * v[k]->weight[j] / v[k]->p[3];
            }
            for (long double& s : weight) s /= one_over_w;
            expected.push_back(weight);
          }
        }
        if (near_edge) continue;
        const auto found = drawn.find({x, y});
        ASSERT_EQ(found == drawn.end() ? 0u : found->second.size(), expected.size()) << n << ": " << x << ", " << y;
        for (std::size_t k = 0; k < expected.size(); ++k) {
          for (std::size_t i = 0; i < 4; ++i)
            ASSERT_NEAR(found->second[k].lambda[i], static_cast<double>(expected[k][i]), 1e-5);
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 50'000);
}

TEST(Split, NeighboursLeaveNoPixelOutAndDrawNoneTwice) {
  Prng prng(3);
  for (int n = 0; n < 60; ++n) {
    // 6 × 6 points from -16 to 84 px; every third mesh with all points on pixel centres.
    std::array<std::array<Point, 6>, 6> points{};
    for (std::size_t j = 0; j < 6; ++j) {
      for (std::size_t i = 0; i < 6; ++i) {
        points[j][i] = {-15.5 + 20 * static_cast<double>(i), -15.5 + 20 * static_cast<double>(j)};
        for (double& c : points[j][i]) c += n % 3 == 0 ? static_cast<double>(prng.integer(-4, 4)) : prng.uniform(-4, 4);
      }
    }
    const auto quads = quad_mesh(prng, 5, 5, [&](std::size_t i, std::size_t j) { return points[j][i]; });
    for (const std::size_t which : {0, 1}) {
      const auto count = counts(*split(which), quads, view64);
      ASSERT_TRUE(std::ranges::all_of(count, [](int c) { return c == 1; })) << n;
    }
  }
}

TEST(Split, ConcaveAndCrossedQuadsKeepTheirTwoTriangles) {
  const auto pixels = [](std::size_t which, const Quad& quad) {
    return static_cast<double>(draw(*split(which), quad, view64).size());
  };
  // Corner 2 inside the triangle of the others, whose area is 56 · 56 / 2; halves 012 and 023 of 56 · 16 / 2 each.
  // The other diagonal draws all of that triangle, and again what of it is not the quad. Some 56 pixel centres are on
  // the line from corner 1 to corner 3.
  const Quad concave = screen_quad({{{4, 4}, {60, 4}, {20, 20}, {4, 60}}});
  EXPECT_NEAR(pixels(0, concave), 2 * 448, 30);
  EXPECT_NEAR(pixels(1, concave), 1568 + (1568 - 2 * 448), 60);
  // A bow-tie: both triangles of a diagonal are half of its hull, one seen from the front and one from the back.
  const Quad crossed = screen_quad({{{4, 4}, {60, 4}, {4, 60}, {60, 60}}});
  EXPECT_NEAR(pixels(0, crossed), 56 * 56, 60);
  const auto samples = draw(*split(0), crossed, view64);
  EXPECT_NEAR(static_cast<double>(std::ranges::count(samples, true, &MethodSample::front)), 56 * 56 / 2.0, 30);
}

/// Corners 2 and 3 at one place on the screen: either diagonal leaves one of them out.
TEST(Split, ACollapsedEdgeWhoseEndsDifferIsAQuad) {
  for (const int difference : {0, 1, 2}) {
    Quad quad = triangle_quad();
    (difference == 0 ? quad.texture[3][0] : difference == 1 ? quad.attribute[3][0] : quad.object[3][0]) += 0.25;
    for (const std::size_t which : {0, 1}) {
      const std::size_t seen = which == 0 ? 2 : 3;
      const auto samples = draw(*split(which), quad, view64);
      EXPECT_NEAR(static_cast<double>(samples.size()), (40 * 40 - 10 * 34) / 2.0, 40);
      for (const MethodSample& sample : samples) {
        const auto m = weights_of({quad.vertex[0], quad.vertex[1], quad.vertex[2]}, sample);
        const std::array<double, 4> expected{m[0], m[1], seen == 2 ? m[2] : 0, seen == 3 ? m[2] : 0};
        for (std::size_t i = 0; i < 4; ++i) ASSERT_NEAR(sample.lambda[i], expected[i], 1e-12) << which << ", " << i;
      }
      EXPECT_EQ(split(which)->census(std::vector{quad}, view64).triangles, 2u);
      EXPECT_EQ(split(which)->wireframe(quad, view64).size(), 2u);
    }
  }
}

TEST(Split, CensusCountsTriangles) {
  const Quad triangle = triangle_quad();
  const std::vector<Quad> quads{centred_quad(centred_corners), triangle, centred_quad(centred_corners)};
  Census expected;
  expected.quads = expected.emitted_quads = 3;
  expected.triangles = 5;
  for (const std::size_t which : {0, 1}) {
    EXPECT_EQ(split(which)->census(quads, view64), expected);
    EXPECT_EQ(split(which)->wireframe(triangle, view64).size(), 1u);
    EXPECT_EQ(split(which)->wireframe(quads[0], view64).size(), 2u);
    // A triangle is the same whatever the diagonal.
    const auto samples = draw(*split(which), triangle, view64);
    EXPECT_NEAR(static_cast<double>(samples.size()), (40 * 40 - 10 * 34) / 2.0, 40);
    for (const MethodSample& sample : samples) EXPECT_EQ(sample.lambda[3], 0);
  }
  EXPECT_EQ(split(0)->name(), "split02");
  EXPECT_EQ(split(1)->name(), "split13");
}

}  // namespace
}  // namespace quadrille::golden::methods
