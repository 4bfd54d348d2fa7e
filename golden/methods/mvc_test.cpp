// Method mvc against the properties of the paper, an evaluation by angles, hand-made singular pixels and the 113-bit
// truth; coverage of whole quads against tilings that are known to cover every pixel once.
#include "golden/methods/builders.hpp"
#include "golden/methods/quad_test_support.hpp"
#include "golden/reference/truth.hpp"
#include "golden/scenes/random_mesh.hpp"
#include "golden/scenes/stress.hpp"
#include "model/support/float113.hpp"
#include "model/support/prng.hpp"

#include <numbers>
#include <tuple>

namespace quadrille::golden::methods {
namespace {

using test::by_pixel;
using test::largest_difference;
using test::Pixel;
using test::quad_at;

constexpr double ulp = 0x1p-52;

const std::unique_ptr<Method> mvc = make_mvc();

Quad random_quad(Prng& random, int size, bool vary_w) {
  std::array<Vec2, 4> point{};
  std::array<double, 4> w{1, 1, 1, 1};
  for (std::size_t i = 0; i < 4; ++i) {
    point[i] = {random.uniform(0, size), random.uniform(0, size)};
    if (vary_w) w[i] = random.log2_spread(-2, 2);
  }
  return quad_at(point, w);
}

TEST(Mvc, CornersHaveWeightOne) {
  // The tie rule keeps the top left corner; every corner takes that place in turn.
  const std::array<Vec2, 4> square{{{4.5, 4.5}, {4.5, 12.5}, {12.5, 12.5}, {12.5, 4.5}}};
  for (std::size_t shift = 0; shift < 4; ++shift) {
    std::array<Vec2, 4> turned{};
    for (std::size_t i = 0; i < 4; ++i) turned[(i + shift) & 3] = square[i];
    for (const bool perspective : {true, false}) {
      const Quad quad = quad_at(turned, {1, 2, 0.5, 4});
      const auto pixels = by_pixel(*mvc, quad, {16, 16, perspective});
      ASSERT_EQ(pixels.size(), 64u);
      const MethodSample& s = pixels.at({4, 4});
      EXPECT_TRUE(s.front) << "down, right, up is counter-clockwise as seen when y points down";
      for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(s.lambda[i], i == shift ? 1.0 : 0.0);
      EXPECT_DOUBLE_EQ(s.z, quad.vertex[shift].z / quad.vertex[shift].w);
    }
  }
}

TEST(Mvc, OtherWindingIsBackFacing) {
  const Quad quad = quad_at({{{4.5, 4.5}, {12.5, 4.5}, {12.5, 12.5}, {4.5, 12.5}}});
  const auto pixels = by_pixel(*mvc, quad, {16, 16, true});
  ASSERT_EQ(pixels.size(), 64u);
  for (const auto& [pixel, s] : pixels) EXPECT_FALSE(s.front);
}

TEST(Mvc, CentreOfASquare) {
  const std::array<double, 4> w{1, 2, 0.5, 4};
  const Quad quad = quad_at({{{4.5, 4.5}, {4.5, 12.5}, {12.5, 12.5}, {12.5, 4.5}}}, w);
  const MethodSample with = by_pixel(*mvc, quad, {16, 16, true}).at({8, 8});
  const MethodSample without = by_pixel(*mvc, quad, {16, 16, false}).at({8, 8});
  const double sum = 1 + 0.5 + 2 + 0.25;  // of 1/w; eq. (7) gives 1/4 each, eq. (10) that over w
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(without.lambda[i], 0.25, ulp);
    EXPECT_NEAR(with.lambda[i], 1 / w[i] / sum, ulp);
  }
  EXPECT_NEAR(with.z, (0.1 + 0.3 + 0.7 + 0.2) / 4, ulp);
  EXPECT_NEAR(without.z, with.z, ulp) << "depth is linear on the screen either way";
}

TEST(Mvc, LinearAlongEdges) {
  const std::array<double, 4> w{1, 3, 0.5, 4};
  const Quad quad = quad_at({{{2.5, 2.5}, {2.5, 18.5}, {18.5, 22.5}, {18.5, 2.5}}}, w);
  const auto with = by_pixel(*mvc, quad, {24, 24, true}), without = by_pixel(*mvc, quad, {24, 24, false});
  for (int p = 1; p < 16; ++p) {
    const double s = p / 16.0;
    const MethodSample &left = with.at({2, 2 + p}), &top = with.at({2 + p, 2});
    // Linear in space: the point (1 - t) V_0 + t V_1 lands at s = t w_1 / ((1 - t) w_0 + t w_1).
    const double t = s * w[0] / (s * w[0] + (1 - s) * w[1]), t_top = s * w[0] / (s * w[0] + (1 - s) * w[3]);
    EXPECT_LE(largest_difference(left.lambda, std::array{1 - t, t, 0.0, 0.0}), 2 * ulp);
    EXPECT_LE(largest_difference(top.lambda, std::array{1 - t_top, 0.0, 0.0, t_top}), 2 * ulp);
    EXPECT_LE(largest_difference(without.at({2, 2 + p}).lambda, std::array{1 - s, s, 0.0, 0.0}), 2 * ulp);
    EXPECT_NEAR(left.z, (1 - s) * 0.1 + s * 0.3, ulp);
  }
}

TEST(Mvc, TwoCornersAtAPixelCountForHalf) {
  // A triangle: corners 2 and 3 coincide, on the pixel centre that the tie rule keeps.
  const std::array<Vec2, 4> point{{{12.5, 12.5}, {14.5, 4.5}, {4.5, 4.5}, {4.5, 4.5}}};
  for (const bool perspective : {true, false}) {
    const auto pixels = by_pixel(*mvc, quad_at(point, {1, 2, 3, 5}), {16, 16, perspective});
    EXPECT_EQ(pixels.at({4, 4}).lambda, (std::array{0.0, 0.0, 0.5, 0.5}));
  }
}

TEST(Mvc, TriangleHasBarycentricCoordinates) {
  const std::array<Vec2, 4> point{{{3.25, 2.75}, {27.5, 9.125}, {11.75, 28.5}, {11.75, 28.5}}};
  const double whole = test::area(point[0], point[1], point[2]);
  const auto pixels = by_pixel(*mvc, quad_at(point), {32, 32, true});
  ASSERT_GT(pixels.size(), 200u);
  for (const auto& [pixel, s] : pixels) {
    const Vec2 p{pixel.first + 0.5, pixel.second + 0.5};
    EXPECT_NEAR(s.lambda[0], test::area(p, point[1], point[2]) / whole, 8 * ulp);
    EXPECT_NEAR(s.lambda[1], test::area(p, point[2], point[0]) / whole, 8 * ulp);
    EXPECT_NEAR(s.lambda[2] + s.lambda[3], test::area(p, point[0], point[1]) / whole, 8 * ulp);
  }
}

TEST(Mvc, CrossingOfTwoEdgesIsTheMeanOfBoth) {
  // Edges 01 and 23 cross at the centre of pixel (8, 8), half way along both.
  const Quad quad = quad_at({{{4.5, 4.5}, {12.5, 12.5}, {12.5, 4.5}, {4.5, 12.5}}}, {1, 2, 3, 4});
  const MethodSample with = by_pixel(*mvc, quad, {16, 16, true}).at({8, 8});
  // Half way on the screen the point of an edge is w_1 : w_0 of its corners; each edge counts for half.
  EXPECT_LE(largest_difference(with.lambda, std::array{1.0 / 3, 1.0 / 6, 2.0 / 7, 3.0 / 14}), ulp);
  const MethodSample without = by_pixel(*mvc, quad, {16, 16, false}).at({8, 8});
  EXPECT_LE(largest_difference(without.lambda, std::array{0.25, 0.25, 0.25, 0.25}), ulp);
}

TEST(Mvc, WeightsReproduceThePixelAndArePositive) {
  Prng random(1);
  std::size_t count = 0;
  for (int n = 0; n < 400; ++n) {
    const Quad quad = random_quad(random, 48, true);
    for (const auto& [pixel, s] : by_pixel(*mvc, quad, {48, 48, true})) {
      ASSERT_NEAR(s.lambda[0] + s.lambda[1] + s.lambda[2] + s.lambda[3], 1, 4 * ulp);  // eq. (3)
      ASSERT_LE(test::distance_from_pixel(quad, s), 1e-9);                             // eq. (9)
      ASSERT_GE(*std::ranges::min_element(s.lambda), -1e-12);
      ++count;
    }
    for (const auto& [pixel, s] : by_pixel(*mvc, quad, {48, 48, false})) {
      Vec2 sum{};
      double z = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        const WindowVertex& v = quad.vertex[i];
        sum[0] += s.lambda[i] * v.x / v.w;
        sum[1] += s.lambda[i] * v.y / v.w;
        z += s.lambda[i] * v.z / v.w;
      }
      ASSERT_NEAR(sum[0], pixel.first + 0.5, 1e-9);  // eq. (2)
      ASSERT_NEAR(sum[1], pixel.second + 0.5, 1e-9);
      ASSERT_NEAR(s.z, z, 1e-12);  // eq. (4)
    }
  }
  EXPECT_GT(count, 50'000u);
}

TEST(Mvc, AgreesWithTheFormulaByAngles) {
  Prng random(2);
  std::size_t count = 0;
  for (int n = 0; n < 300; ++n) {
    // Corners on a circle in order: convex.
    std::array<Vec2, 4> point{};
    for (std::size_t i = 0; i < 4; ++i) {
      const double angle = (static_cast<double>(i) + random.uniform(0.1, 0.9)) * std::numbers::pi / 2;
      point[i] = {24 + 22 * std::cos(angle), 24 + 22 * std::sin(angle)};
    }
    for (const auto& [pixel, s] : by_pixel(*mvc, quad_at(point), {48, 48, false})) {
      std::array<long double, 4> half_tan{}, mu{}, r{};
      long double sum = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        const long double ax = point[i][0] - (pixel.first + 0.5), ay = point[i][1] - (pixel.second + 0.5);
        const long double bx = point[(i + 1) & 3][0] - (pixel.first + 0.5),
                          by = point[(i + 1) & 3][1] - (pixel.second + 0.5);
        half_tan[i] = std::tan((std::atan2(by, bx) - std::atan2(ay, ax)) / 2);
        r[i] = std::hypot(ax, ay);
      }
      for (std::size_t i = 0; i < 4; ++i) sum += mu[i] = (half_tan[(i + 3) & 3] + half_tan[i]) / r[i];  // eq. (8)
      for (std::size_t i = 0; i < 4; ++i) ASSERT_NEAR(s.lambda[i], static_cast<double>(mu[i] / sum), 1e-12);
      ++count;
    }
  }
  EXPECT_GT(count, 100'000u);
}

/// Whether rounding can decide coverage here: an edge function of (12) is within 16 units of 2^-53 of the sum of its
/// terms' magnitudes.
bool near_tie(const WindowQuad& quad, int px, int py) {
  const double x = px + 0.5, y = py + 0.5;
  for (const auto& [i, j] : {Pixel{0, 1}, {1, 2}, {2, 3}, {3, 0}, {2, 0}}) {
    const WindowVertex &p = quad.vertex[i], &q = quad.vertex[j];
    const auto minor = [](double a, double b, double c, double d) {
      return static_cast<Float113>(a) * b - static_cast<Float113>(c) * d;
    };
    const Float113 e = minor(p.y, q.w, q.y, p.w) * x + minor(q.x, p.w, p.x, q.w) * y + minor(p.x, q.y, q.x, p.y);
    const double size = (std::abs(p.y * q.w) + std::abs(q.y * p.w)) * x +
                        (std::abs(q.x * p.w) + std::abs(p.x * q.w)) * y + std::abs(p.x * q.y) + std::abs(q.x * p.y);
    if (std::abs(static_cast<double>(e)) <= 16 * 0x1p-53 * size) return true;
  }
  return false;
}

class AgainstTruth : public ::testing::TestWithParam<StressFamily> {};

TEST_P(AgainstTruth, CoverageWeightsAndDepth) {
  constexpr int size = 64;
  std::size_t compared = 0;
  for (const WindowQuad& given : make_stress(GetParam(), 12, 3, 1.0, size, size, 0)) {
    Quad quad;
    quad.vertex = given.vertex;
    for (const bool perspective : {true, false}) {
      DrawState state;
      state.width = state.height = state.scissor_x1 = state.scissor_y1 = size;
      state.attributes = 0;
      state.perspective = perspective;
      const TruthQuad truth(given, state);
      const auto pixels = by_pixel(*mvc, quad, {size, size, perspective});
      for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
          const ReferenceSample expected = truth.sample(x, y);
          const auto found = pixels.find({x, y});
          const bool drawn = found != pixels.end();
          if (drawn != (expected.covered && expected.visible)) {
            ASSERT_TRUE(near_tie(given, x, y) || std::abs(expected.visible_margin) < 0x1p-39)
                << "quad " << given.id << " pixel " << x << ", " << y << ": " << (drawn ? "drawn" : "missing");
            continue;
          }
          if (!drawn) continue;
          const MethodSample& s = found->second;
          ASSERT_FALSE(s.undefined);
          ASSERT_EQ(s.front, expected.front);
          // Without perspective sum(M w) is divided by, which cancels like the depth does, and weights grow with it.
          double scale = expected.condition;
          if (!perspective) {
            scale *= expected.z_condition;
            for (const double v : expected.lambda) scale = std::max(scale, std::abs(v) * expected.z_condition);
          }
          ASSERT_LE(largest_difference(s.lambda, expected.lambda), 1e-11 * scale)
              << "quad " << given.id << " pixel " << x << ", " << y;
          ASSERT_NEAR(s.z, expected.z,
                      1e-11 * expected.condition * expected.z_condition * std::max(1.0, std::abs(expected.z)));
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 20u);
}

/// fig9_j at 512 × 512. In exact fractions the edge function from vertex 2 to 3 is 8.0e-12 at both pixels, S taken as
/// rounded it is 0 at the first and 1.6e-11 at the second: the tie rule decides where the truth has no tie.
TEST(Mvc, TiesOfCoverageAreThoseOfDoublePrecision) {
  WindowQuad given;
  given.vertex = {{{192, 358.40000000000003, 0.5, 1},
                   {-389.12000000000006, -92.159999999999968, 0.5, -0.80000000000000004},
                   {568.32000000000005, 414.72000000000003, 0.5, 1.2},
                   {-239.36000000000001, -98.559999999999974, 0.5, -1.1000000000000001}}};
  Quad quad;
  quad.vertex = given.vertex;
  DrawState state;
  state.attributes = 0;
  const TruthQuad truth(given, state);
  const auto pixels = by_pixel(*mvc, quad, {512, 512, true});
  for (const auto& [x, y, drawn] : {std::tuple{475, 347, false}, {476, 348, true}}) {
    const ReferenceSample expected = truth.sample(x, y);
    EXPECT_TRUE(expected.covered && expected.visible);
    EXPECT_EQ(expected.flags & flag_tie, 0);
    EXPECT_TRUE(near_tie(given, x, y));
    EXPECT_EQ(pixels.contains({x, y}), drawn) << x;
  }
}

std::vector<StressFamily> all_families() {
  std::vector<StressFamily> all;
  for (const StressFamilyInfo& entry : stress_families()) all.push_back(entry.family);
  return all;
}

std::string family_name(const ::testing::TestParamInfo<StressFamily>& test) {
  return std::string(stress_family_name(test.param));
}

INSTANTIATE_TEST_SUITE_P(Families, AgainstTruth, ::testing::ValuesIn(all_families()), family_name);

TEST(Mvc, EveryPixelOfATilingIsDrawnOnce) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    RandomMeshOptions options;
    options.width = options.height = 128;
    options.tie_share = seed % 2 == 0 ? 0.5 : 0.0;
    options.vary_w = seed > 4;
    const RandomMesh mesh = make_random_mesh(seed, options);
    std::map<Pixel, int> times;
    for (const WindowQuad& cell : mesh.quads) {
      Quad quad;
      quad.vertex = cell.vertex;
      for (const auto& [pixel, s] : by_pixel(*mvc, quad, {options.width, options.height, true})) ++times[pixel];
    }
    for (int y = 0; y < options.height; ++y) {
      for (int x = 0; x < options.width; ++x) {
        const auto found = times.find({x, y});
        ASSERT_EQ(found == times.end() ? 0 : found->second, mesh.expected(x, y) ? 1 : 0) << x << ", " << y;
      }
    }
  }
}

TEST(Mvc, NothingIsSeenOfAQuadBehindTheEye) {
  const std::array<Vec2, 4> point{{{4.5, 4.5}, {4.5, 12.5}, {12.5, 12.5}, {12.5, 4.5}}};
  EXPECT_TRUE(test::draw(*mvc, quad_at(point, {-1, -2, -1, -3}), {16, 16, true}).empty());
}

TEST(Mvc, EyeInsideTheQuadsPlaneSeesNothing) {
  // Corners a P + b Q around the eye: every pixel is covered, and every point of the plane that M could show beside it
  // is the eye itself, so sum(M w) is 0 but for rounding.
  const WindowVertex p{31, 57, 0.3, 0.3}, q{-73, 29, 1.7, 1.7};
  constexpr std::array<Vec2, 4> around{{{1.1, 0.9}, {-0.7, 1.3}, {-1.2, -0.8}, {0.9, -1.4}}};
  Quad quad;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& [a, b] = around[i];
    quad.vertex[i] = {a * p.x + b * q.x, a * p.y + b * q.y, a * p.z + b * q.z, a * p.w + b * q.w};
  }
  EXPECT_TRUE(test::draw(*mvc, quad, {64, 64, true}).empty());
}

TEST(Mvc, EyeOnADiagonalMakesItFalseInBothSenses) {
  Quad quad = quad_at({{{10, 12}, {40, 7}, {10, 12}, {20, 50}}});
  WindowVertex& v = quad.vertex[2];
  v = {-2 * v.x, -2 * v.y, -2 * v.z, -2 * v.w};
  EXPECT_TRUE(test::draw(*mvc, quad, {64, 64, true}).empty());
}

TEST(Mvc, Census) {
  const std::vector<Quad> quads(5);
  EXPECT_EQ(mvc->census(quads, {}), (Census{.quads = 5, .emitted_quads = 5}));
  EXPECT_EQ(mvc->name(), "mvc");
}

}  // namespace
}  // namespace quadrille::golden::methods
