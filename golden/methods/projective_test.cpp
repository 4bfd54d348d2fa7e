// Method projective against the homography in another form: its homogeneous weights at the corners are the areas of the
// opposite triangles.
#include "golden/methods/builders.hpp"
#include "golden/methods/quad_test_support.hpp"
#include "model/support/prng.hpp"

#include <numbers>

namespace quadrille::golden::methods {
namespace {

using test::area;
using test::by_pixel;
using test::largest_difference;
using test::quad_at;

const std::unique_ptr<Method> projective = make_projective();

/// q_i with q_0 (v_0, 1) - q_1 (v_1, 1) + q_2 (v_2, 1) - q_3 (v_3, 1) = 0: the homography of the unit square sends (s,
/// t) to sum(lambda_i q_i v_i) / sum(lambda_i q_i) with lambda = ((1-s)(1-t), s(1-t), st, (1-s)t).
std::array<double, 4> corner_weights(const std::array<Vec2, 4>& v) {
  return {area(v[1], v[2], v[3]), area(v[0], v[2], v[3]), area(v[0], v[1], v[3]), area(v[0], v[1], v[2])};
}

TEST(Projective, ForwardMapReturnsThePixel) {
  Prng random(1);
  std::size_t count = 0;
  for (int n = 0; n < 300; ++n) {
    std::array<Vec2, 4> v{};
    for (std::size_t i = 0; i < 4; ++i) {
      const double angle = (static_cast<double>(i) + random.uniform(0.05, 0.95)) * std::numbers::pi / 2;
      v[i] = {24 + 22 * std::cos(angle), 24 + 22 * std::sin(angle)};
    }
    if (n % 2 == 1) std::swap(v[1], v[3]);
    const auto q = corner_weights(v);
    const auto pixels = by_pixel(*projective, quad_at(v), {48, 48, true});
    for (const auto& [pixel, s] : pixels) {
      ASSERT_EQ(s.front, n % 2 == 1) << "the circle is run through clockwise as seen, y down";
      ASSERT_NEAR(s.lambda[0] + s.lambda[1] + s.lambda[2] + s.lambda[3], 1, 1e-14);
      ASSERT_NEAR(s.lambda[0] * s.lambda[2], s.lambda[1] * s.lambda[3], 1e-14) << "bilinear in (s, t)";
      ASSERT_GE(*std::ranges::min_element(s.lambda), -1e-12);
      double x = 0, y = 0, sum = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        x += s.lambda[i] * q[i] * v[i][0];
        y += s.lambda[i] * q[i] * v[i][1];
        sum += s.lambda[i] * q[i];
      }
      ASSERT_NEAR(x / sum, pixel.first + 0.5, 1e-10);
      ASSERT_NEAR(y / sum, pixel.second + 0.5, 1e-10);
      ++count;
    }
  }
  EXPECT_GT(count, 100'000u);
}

TEST(Projective, CornersHaveWeightOne) {
  const std::array<Vec2, 4> point{{{4.5, 4.5}, {6.5, 14.5}, {12.5, 12.5}, {14.5, 3.5}}};
  for (std::size_t shift = 0; shift < 4; ++shift) {
    std::array<Vec2, 4> turned{};
    for (std::size_t i = 0; i < 4; ++i) turned[(i + shift) & 3] = point[i];
    const Quad quad = quad_at(turned, {1, 2, 3, 4});
    const auto s = by_pixel(*projective, quad, {16, 16, true}).at({4, 4});
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(s.lambda[i], i == shift ? 1.0 : 0.0, 1e-15);
    EXPECT_NEAR(s.z, quad.vertex[shift].z / quad.vertex[shift].w, 1e-15);
  }
}

/// A vector of window coordinates before the division.
struct Vector {
  double x, y, w;
};

double det(const Vector& p, const Vector& q, const Vector& r) {
  return p.x * (q.y * r.w - q.w * r.y) - p.y * (q.x * r.w - q.w * r.x) + p.w * (q.x * r.y - q.y * r.x);
}

/// The parallelogram o + s a + t b in space.
struct Parallelogram {
  Vector o, a, b;

  Quad quad() const {
    const auto corner = [&](double s, double t) {
      const double w = o.w + s * a.w + t * b.w, z = 1 - 0.5 / w;  // depth as a perspective projection gives it
      return WindowVertex{o.x + s * a.x + t * b.x, o.y + s * a.y + t * b.y, z * w, w};
    };
    Quad out;
    out.vertex = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
    return out;
  }

  /// Perspective-correct bilinear weights: (s, t) where the pixel's ray meets the plane, by Cramer's rule.
  std::array<double, 4> weights(const test::Pixel& pixel) const {
    const Vector ray{pixel.first + 0.5, pixel.second + 0.5, 1};
    const double s = -det(o, b, ray) / det(a, b, ray), t = -det(a, o, ray) / det(a, b, ray);
    return {(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
  }
};

TEST(Projective, PictureOfAParallelogramIsTrue) {
  const Parallelogram shape{{6, 10, 1}, {55, 8, 1.25}, {9, 60, 0.5}};
  const Quad quad = shape.quad();
  const auto pixels = by_pixel(*projective, quad, {64, 64, true});
  ASSERT_GT(pixels.size(), 200u);
  for (const auto& [pixel, s] : pixels) {
    ASSERT_LE(largest_difference(s.lambda, shape.weights(pixel)), 1e-13);
    double w = 0;
    for (std::size_t i = 0; i < 4; ++i) w += s.lambda[i] * quad.vertex[i].w;
    // z = 1 - 0.5 / w_i interpolated with weights that are linear in space, not on the screen, is not 1 - 0.5 / w.
    double z = 0;
    for (std::size_t i = 0; i < 4; ++i) z += s.lambda[i] * (1 - 0.5 / quad.vertex[i].w);
    ASSERT_NEAR(s.z, z, 1e-14);
    ASSERT_LE(s.z, 1 - 0.5 / w + 1e-14) << "1 - 0.5 / w is concave in w";
  }
}

TEST(Projective, EqualsPerspectiveBilinearWhereAnEdgeIsParallelToTheScreen) {
  // Inverse bilinear on the screen divides by w afterwards: beta_i ~ lambda_i w_i is bilinear only if w_0 w_2 = w_1
  // w_3, which for a parallelogram (w_0 + w_2 = w_1 + w_3) means that two edges are level in w.
  const Parallelogram level{{6, 10, 1}, {55, 8, 0}, {20, 60, 0.75}}, tilted{{6, 10, 1}, {55, 8, 1.25}, {9, 60, 0.5}};
  const auto difference = [](const Parallelogram& shape) {
    const auto bilinear = by_pixel(*make_bilinear(), shape.quad(), {64, 64, true});
    const auto pixels = by_pixel(*projective, shape.quad(), {64, 64, true});
    EXPECT_EQ(bilinear.size(), pixels.size());
    EXPECT_GT(pixels.size(), 200u);
    double largest = 0;
    for (const auto& [pixel, s] : pixels)
      largest = std::max(largest, largest_difference(s.lambda, bilinear.at(pixel).lambda));
    return largest;
  };
  EXPECT_LE(difference(level), 1e-13);
  EXPECT_GT(difference(tilted), 1e-3);
}

TEST(Projective, CornersOwnDepthPlaysNoRole) {
  const std::array<Vec2, 4> point{{{4.25, 4.5}, {6.5, 27.5}, {22.5, 29.25}, {28.5, 5.5}}};
  const auto flat = by_pixel(*projective, quad_at(point), {32, 32, true});
  const auto deep = by_pixel(*projective, quad_at(point, {1, 0.25, 8, 3}), {32, 32, true});
  const auto screen = by_pixel(*projective, quad_at(point, {1, 0.25, 8, 3}), {32, 32, false});
  ASSERT_GT(flat.size(), 400u);
  ASSERT_EQ(deep.size(), flat.size());
  for (const auto& [pixel, s] : flat) {
    ASSERT_LE(largest_difference(deep.at(pixel).lambda, s.lambda), 1e-14);
    ASSERT_EQ(screen.at(pixel).lambda, deep.at(pixel).lambda);
    double z = 0;
    for (std::size_t i = 0; i < 4; ++i) z += s.lambda[i] * std::array{0.1, 0.3, 0.7, 0.2}[i];
    ASSERT_NEAR(s.z, z, 1e-14);
  }
}

/// Weight of corner 1 along the edge from corner 0 at the left (x = 2.5), 16 px long, of a quad with the given far
/// side.
std::vector<double> along_left_edge(const Vec2& below, const Vec2& above) {
  const auto pixels = by_pixel(*projective, quad_at({{{2.5, 2.5}, {2.5, 18.5}, below, above}}), {32, 32, true});
  std::vector<double> out;
  for (int y = 3; y < 18; ++y) {
    const MethodSample& s = pixels.at({2, y});
    EXPECT_NEAR(s.lambda[2], 0, 1e-15);
    EXPECT_NEAR(s.lambda[3], 0, 1e-15);
    out.push_back(s.lambda[1]);
  }
  return out;
}

TEST(Projective, EdgesBendSoThatNeighboursDisagree) {
  // Two neighbours of one edge; the second is mirrored in it, which the map does not notice, so that both draw the
  // edge's pixels.
  const std::array<std::array<Vec2, 2>, 2> far_side{{{{{12.5, 18.5}, {26.5, 2.5}}}, {{{26.5, 18.5}, {12.5, 2.5}}}}};
  std::array<std::vector<double>, 2> weight;
  for (std::size_t n = 0; n < 2; ++n) {
    const auto& [below, above] = far_side[n];
    weight[n] = along_left_edge(below, above);
    const auto q = corner_weights({{{2.5, 2.5}, {2.5, 18.5}, below, above}});
    for (std::size_t i = 0; i < weight[n].size(); ++i) {
      // The forward map on the edge: linear = weight q_1 / ((1 - weight) q_0 + weight q_1).
      const double linear = static_cast<double>(i + 1) / 16;
      EXPECT_NEAR(weight[n][i], linear * q[0] / (linear * q[0] + (1 - linear) * q[1]), 1e-14);
    }
  }
  double gap = 0, bend = 0;
  for (std::size_t i = 0; i < weight[0].size(); ++i) {
    gap = std::max(gap, std::abs(weight[0][i] - weight[1][i]));
    bend = std::max(bend, std::abs(weight[0][i] - static_cast<double>(i + 1) / 16));
  }
  EXPECT_GT(bend, 0.1);
  EXPECT_GT(gap, 0.1) << "no C0 gap";
}

TEST(Projective, RefusesWhatItCannotDraw) {
  const std::array<Vec2, 4> convex{{{4.5, 4.5}, {4.5, 12.5}, {12.5, 12.5}, {12.5, 4.5}}};
  const std::vector<Quad> quads{
      quad_at(convex),
      quad_at({{{4, 4}, {12, 4}, {7, 7}, {4, 12}}}),    // concave
      quad_at({{{4, 4}, {12, 12}, {12, 4}, {4, 12}}}),  // crossed
      quad_at({{{4, 4}, {8, 4}, {12, 4}, {8, 12}}}),    // straight corner
      quad_at({{{4, 4}, {12, 4}, {8, 12}, {8, 12}}}),   // triangle
      quad_at(convex, {1, 1, -1, 1}),
      quad_at(convex, {1, 1, 0, 1}),
  };
  for (std::size_t i = 1; i < quads.size(); ++i) {
    EXPECT_TRUE(test::draw(*projective, quads[i], {16, 16, true}).empty()) << i;
  }
  EXPECT_EQ(test::draw(*projective, quads[0], {16, 16, true}).size(), 64u);
  EXPECT_EQ(projective->census(quads, {}), (Census{.quads = 7, .refused = 6, .emitted_quads = 1}));
  EXPECT_EQ(projective->name(), "projective");
}

}  // namespace
}  // namespace quadrille::golden::methods
