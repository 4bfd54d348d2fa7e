// Edge functions and the triangle rasterizer: exact signs, the tie rule, where nothing can be visible.
#include "golden/methods/homogeneous.hpp"
#include "model/support/float113.hpp"

#include "golden/methods/adaptive.hpp"
#include "golden/methods/quad_coverage.hpp"
#include "golden/scenes/stress.hpp"
#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <set>
#include <utility>
#include <vector>

namespace quadrille::golden::methods {
namespace {

constexpr View view64{64, 64, true};

TEST(DifferenceOfProducts, HasTheExactSign) {
  // (1 + u)(1 - u) = 1 - u^2: the product rounds to 1.
  constexpr double u = 0x1p-30;
  EXPECT_EQ(difference_of_products(1 + u, 1 - u, 1, 1), -u * u);
  EXPECT_EQ(difference_of_products(1, 1, 1 + u, 1 - u), u * u);
  EXPECT_EQ(difference_of_products(3, 5, 15, 1), 0);
  Prng prng(1);
  for (int n = 0; n < 100'000; ++n) {
    // Significands of 53 bits: 113 bits hold both products, and the sign of their difference is exact.
    const double a = prng.uniform(1, 2), b = prng.uniform(1, 2), c = prng.uniform(1, 2);
    const double d = n % 2 == 0 ? prng.uniform(1, 2) : b * c / a;  // or products that agree to a few units
    const Float113 exact = static_cast<Float113>(a) * d - static_cast<Float113>(b) * c;
    const double v = difference_of_products(a, d, b, c);
    ASSERT_EQ((v > 0) - (v < 0), (exact > 0) - (exact < 0));
    ASSERT_EQ(v, -difference_of_products(b, c, a, d));
  }
}

double edge_at(const WindowVertex& p, const WindowVertex& q, double x, double y) {
  return cross(PixelVector(p, x, y), PixelVector(q, x, y));
}
int edge_sign(const WindowVertex& p, const WindowVertex& q, double x, double y) {
  return side(PixelVector(p, x, y), PixelVector(q, x, y));
}

TEST(EdgeFunction, IsALinearAntisymmetricFunction) {
  Prng prng(2);
  const auto vertex = [&] {
    return WindowVertex{prng.uniform(-99, 99), prng.uniform(-99, 99), 0, prng.uniform(-2, 2)};
  };
  for (int n = 0; n < 10'000; ++n) {
    const WindowVertex p = vertex(), q = vertex();
    const double a = difference_of_products(p.y, q.w, q.y, p.w), b = difference_of_products(q.x, p.w, p.x, q.w),
                 c = difference_of_products(p.x, q.y, q.x, p.y);
    const double x = prng.uniform(0, 64), y = prng.uniform(0, 64);
    ASSERT_NEAR(edge_at(p, q, x, y), a * x + b * y + c, 1e-10);
    ASSERT_EQ(edge_at(p, q, x, y), -edge_at(q, p, x, y));
    ASSERT_EQ(edge_sign(p, q, x, y), -edge_sign(q, p, x, y));
  }
  // P to the left of Q, seen from below: clockwise with y down.
  EXPECT_GT(edge_at({10, 10, 0, 1}, {20, 10, 0, 1}, 15, 20), 0);
  EXPECT_EQ(edge_sign({10, 10, 0, 1}, {20, 20, 0, 2}, 3, 4), 0);  // one screen point twice: no edge
}

/// (x + eps, y + eps^2) is inside from the left and from the top edge, y down.
TEST(EdgeFunction, OnAnEdgeTheSignIsThatOfANearbyPoint) {
  const WindowVertex a{10.5, 10.5, 0, 1}, b{20.5, 10.5, 0, 1}, c{20.5, 20.5, 0, 1}, d{10.5, 20.5, 0, 1};
  int pixels = 0;
  const auto count = [&](const TrianglePixel& pixel) {
    EXPECT_TRUE(pixel.x >= 10 && pixel.x < 20 && pixel.y >= 10 && pixel.y < 20) << pixel.x << ", " << pixel.y;
    ++pixels;
  };
  raster_triangle({a, b, c}, view64, count);
  raster_triangle({a, c, d}, view64, count);
  EXPECT_EQ(pixels, 100);
}

TEST(PixelBox, HoldsPixelCentres) {
  const auto box = [](const std::array<WindowVertex, 3>& v) {
    const PixelRect b = pixel_box(v, view64);
    return std::array<int, 4>{b.x0, b.y0, b.x1, b.y1};
  };
  using Box = std::array<int, 4>;
  EXPECT_EQ(box({{{20.4, 3.2, 0, 2}, {30.7, 9.6, 0, 1}, {25, 7.4, 0, 1}}}), (Box{10, 2, 31, 10}));
  EXPECT_EQ(box({{{-9, 3, 0, 1}, {99, 9, 0, 1}, {5, 77, 0, 1}}}), (Box{0, 3, 64, 64}));
  EXPECT_EQ(box({{{20, 3, 0, 1}, {30, 9, 0, -1}, {5, 77, 0, 1}}}), (Box{0, 0, 64, 64}));
  // Behind the eye, left, above, right, below, whatever the signs of w.
  EXPECT_EQ(box({{{20, 3, 0, -1}, {30, 9, 0, 0}, {5, 7, 0, -2}}}), Box{});
  EXPECT_EQ(box({{{-2, 3, 0, 1}, {-3, 9, 0, -1}, {0, 7, 0, 2}}}), Box{});
  EXPECT_EQ(box({{{20, -3, 0, 1}, {30, -9, 0, -1}, {5, 0, 0, 2}}}), Box{});
  EXPECT_EQ(box({{{70, 3, 0, 1}, {-30, 9, 0, -1}, {130, 7, 0, 2}}}), Box{});
  EXPECT_EQ(box({{{7, 70, 0, 1}, {3, -30, 0, -1}, {9, 130, 0, 2}}}), Box{});
  // Not so where one vertex is not beyond the side.
  EXPECT_EQ(box({{{70, 3, 0, 1}, {-70, 9, 0, -1}, {130, 7, 0, 2}}}), (Box{0, 0, 64, 64}));
}

using Pixels = std::set<std::pair<int, int>>;

/// Every pixel of the view by the same edge functions.
Pixels triangle_by_scan(const std::array<WindowVertex, 3>& v, const View& view) {
  Pixels out;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const PixelVector a(v[0], x + 0.5, y + 0.5), b(v[1], x + 0.5, y + 0.5), c(v[2], x + 0.5, y + 0.5);
      const int sign = side(b, c);
      if (sign == 0 || side(c, a) != sign || side(a, b) != sign) continue;
      const std::array<double, 3> e{cross(b, c), cross(c, a), cross(a, b)};
      const double sum = e[0] + e[1] + e[2], sum_w = e[0] * v[0].w + e[1] * v[1].w + e[2] * v[2].w;
      if (sum != 0 && sum_w / sum > 0) out.insert({x, y});
    }
  }
  return out;
}

/// What is drawn is what a scan of the whole view draws: in front of the eye, through it, behind it, far away, thin.
TEST(RasterRows, LoseNoPixelOfTheFamilies) {
  std::size_t pixels = 0, behind = 0, out_of_sight = 0;
  for (const StressFamilyInfo& family : stress_families()) {
    for (const WindowQuad& made : make_stress(family.family, 6, 5, 1, 64, 64, 0)) {
      for (const double shift : {0.0, 3e5}) {
        std::array<WindowVertex, 4> vertex = made.vertex;
        for (WindowVertex& v : vertex) v.x += shift * std::abs(v.w);
        for (const bool mirrored : {false, true}) {
          if (mirrored)
            for (WindowVertex& v : vertex) v.x = -v.x, v.y = -v.y, v.w = -v.w;
          const auto& [a, b, c, d] = vertex;
          for (const std::array<WindowVertex, 3>& triangle : {std::array{a, b, c}, {a, c, d}, {b, c, d}}) {
            Pixels drawn;
            raster_triangle(triangle, view64, [&](const TrianglePixel& p) { drawn.insert({p.x, p.y}); });
            ASSERT_EQ(drawn, triangle_by_scan(triangle, view64)) << family.name << " " << made.id;
            pixels += drawn.size();
          }
          Pixels drawn, expected;
          raster_quad(vertex, view64, [&](int x, int y, bool) { drawn.insert({x, y}); });
          const PixelRect box = pixel_box(vertex, view64);
          for (int y = box.y0; y < box.y1; ++y)
            for (int x = box.x0; x < box.x1; ++x)
              if (quad_orientation(vertex, x + 0.5, y + 0.5) != 0) expected.insert({x, y});
          ASSERT_EQ(drawn, expected) << family.name << " " << made.id;
          pixels += drawn.size();
          behind += std::ranges::all_of(vertex, [](const WindowVertex& v) { return v.w < 0; }) ? 1 : 0;

          // Parts of a quad that is out of view draw nothing either.
          if (!out_of_view(vertex, view64)) continue;
          ++out_of_sight;
          Quad quad{.vertex = vertex};
          quad.object = {{{0, 0, 0}, {1, 0, 0}, {1.1, 1, 0.3}, {0, 0.8, 0}}};
          std::vector<MethodSample> samples;
          for (const SubQuad& part : subdivide(quad, view64, 0.1)) draw_split02(part.corner, view64, samples);
          ASSERT_TRUE(samples.empty()) << family.name << " " << made.id;
        }
      }
    }
  }
  EXPECT_GT(pixels, 100'000u);
  EXPECT_GT(behind, 100u);
  EXPECT_GT(out_of_sight, 200u);
}

}  // namespace
}  // namespace quadrille::golden::methods
