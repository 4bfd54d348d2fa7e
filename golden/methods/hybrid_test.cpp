// Method hybrid: close to the truth on ordinary quads, and wrong exactly where and how the published programs are.
#include "golden/methods/builders.hpp"
#include "golden/methods/quad_test_support.hpp"
#include "golden/reference/paper_float.hpp"
#include "golden/reference/truth.hpp"
#include "model/support/prng.hpp"

namespace quadrille::golden::methods {
namespace {

using test::by_pixel;
using test::largest_difference;
using test::Pixel;
using test::quad_at;

constexpr std::array forms{HybridForm::pixels, HybridForm::ndc, HybridForm::tarini, HybridForm::bloomenthal};

DrawState draw_state(int size, bool perspective) {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = size;
  state.attributes = 0;
  state.perspective = perspective;
  return state;
}

WindowQuad window_quad(const Quad& quad) {
  WindowQuad out;
  out.vertex = quad.vertex;
  return out;
}

TEST(Hybrid, CloseToTheTruthOnAnOrdinaryQuad) {
  constexpr int size = 128;
  const Quad quad = quad_at({{{10.3, 15.7}, {20.9, 110.2}, {118.6, 90.4}, {99.1, 8.8}}}, {1, 2.5, 0.7, 3.1});
  for (const bool perspective : {true, false}) {
    const TruthQuad truth(window_quad(quad), draw_state(size, perspective));
    for (const HybridForm form : forms) {
      const auto method = make_hybrid(form);
      const auto pixels = by_pixel(*method, quad, {size, size, perspective});
      double largest = 0, largest_z = 0;
      std::size_t covered = 0;
      for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
          const ReferenceSample expected = truth.sample(x, y);
          ASSERT_EQ(pixels.contains({x, y}), expected.covered) << method->name();
          if (!expected.covered) continue;
          ++covered;
          const MethodSample& s = pixels.at({x, y});
          ASSERT_FALSE(s.undefined);
          ASSERT_EQ(s.front, expected.front);
          largest = std::max(largest, largest_difference(s.lambda, expected.lambda));
          largest_z = std::max(largest_z, std::abs(s.z - expected.z));
        }
      }
      EXPECT_GT(covered, 6000u);
      EXPECT_LE(largest, 1e-4) << method->name();
      EXPECT_GT(largest, 1e-8) << method->name() << " is better than single precision";
      // By the weights, or a triangle's own, which is another surface: V_0 to V_3 are not in one plane.
      const bool by_weights = form == HybridForm::pixels || form == HybridForm::tarini;
      EXPECT_EQ(largest_z <= 1e-4, by_weights) << method->name() << " " << largest_z;
    }
  }
}

TEST(Hybrid, TariniIsThePseudoCodeInSinglePrecision) {
  // The reference's pseudo-code in float, bit for bit: eq. (7), and depth by eq. (4).
  Prng random(1);
  std::size_t compared = 0, undefined = 0;
  for (int n = 0; n < 200; ++n) {
    std::array<Vec2, 4> point{};
    // Half of the corners on pixel centres or half way between, so that 0/0 occurs.
    for (Vec2& p : point) {
      p = random.chance(0.5) ? Vec2{random.uniform(0, 32), random.uniform(0, 32)}
                             : Vec2{0.5 * static_cast<double>(random.integer(0, 64)),
                                    0.5 * static_cast<double>(random.integer(0, 64))};
    }
    const Quad quad = quad_at(point, {1, 2, 0.5, 4});
    const PaperFp32Quad paper(window_quad(quad), draw_state(32, false));
    for (const MethodSample& s : test::draw(*make_hybrid(HybridForm::tarini), quad, {32, 32, false})) {
      const auto expected = paper.interpolate(s.x, s.y);
      const bool finite = std::ranges::all_of(expected.lambda, [](float v) { return std::isfinite(v); });
      ASSERT_EQ(s.undefined, !finite);
      undefined += s.undefined ? 1 : 0;
      if (s.undefined) continue;
      for (std::size_t i = 0; i < 4; ++i) ASSERT_EQ(s.lambda[i], static_cast<double>(expected.lambda[i]));
      ASSERT_EQ(s.z, static_cast<double>(expected.z));
      ++compared;
    }
  }
  EXPECT_GT(compared, 10'000u);
  EXPECT_GT(undefined, 10u);
}

/// A square whose top edge runs through the centres of row 0; the middle of that edge is the centre of pixel (4, 0).
const Quad square_on_centres = quad_at({{{0.5, 0.5}, {8.5, 0.5}, {8.5, 8.5}, {0.5, 8.5}}});

TEST(Hybrid, GuardGivesWrongWeightsOnAnEdge) {
  // Right is (1/2, 1/2, 0, 0). With t_01 = 0 instead of infinity: seen from the middle of the edge, t_12 = t_30 =
  // tan(atan(2) / 2) = (sqrt(5) - 1) / 2, t_23 = tan(atan(1/2)) = 1/2, distances 4 and 4 sqrt(5) px.
  const double golden = (std::sqrt(5.0) - 1) / 2;
  const double near = golden / 4, far = (golden + 0.5) / (4 * std::sqrt(5.0));
  const double corner = near / (2 * near + 2 * far);
  for (const HybridForm form : {HybridForm::pixels, HybridForm::ndc, HybridForm::bloomenthal}) {
    // 16 px: both coordinates of the edge are exact in NDC too.
    const auto pixels = by_pixel(*make_hybrid(form), square_on_centres, {16, 16, true});
    const MethodSample& s = pixels.at({4, 0});
    ASSERT_FALSE(s.undefined);
    EXPECT_LE(largest_difference(s.lambda, std::array{corner, corner, 0.5 - corner, 0.5 - corner}), 1e-6);
    EXPECT_GT(largest_difference(s.lambda, std::array{0.5, 0.5, 0.0, 0.0}), 0.2);
  }
}

TEST(Hybrid, WithoutGuardAnEdgeIsUndefined) {
  const auto pixels = by_pixel(*make_hybrid(HybridForm::tarini), square_on_centres, {16, 16, true});
  ASSERT_EQ(pixels.size(), 64u) << "a NaN has no sign, so nothing is killed";
  for (const auto& [pixel, s] : pixels) EXPECT_EQ(s.undefined, pixel.first == 0 || pixel.second == 0);
}

TEST(Hybrid, AtAVertexEveryFormIsUndefined) {
  // r = 0: with the guard (0 + 0) / 0, without it 0/0 before.
  for (const HybridForm form : forms) {
    EXPECT_TRUE(by_pixel(*make_hybrid(form), square_on_centres, {16, 16, true}).at({0, 0}).undefined);
  }
}

TEST(Hybrid, CollapsedEdgeIsUndefinedWithoutGuard) {
  const Quad triangle = quad_at({{{2.2, 3.1}, {27.7, 9.3}, {11.9, 28.4}, {11.9, 28.4}}});
  const auto without = by_pixel(*make_hybrid(HybridForm::tarini), triangle, {32, 32, true});
  const auto with = by_pixel(*make_hybrid(HybridForm::pixels), triangle, {32, 32, true});
  ASSERT_GT(without.size(), 200u);
  for (const auto& [pixel, s] : without) EXPECT_TRUE(s.undefined) << "A_23 = 0 at every pixel, r r' - D = 0 or noise";
  std::size_t defined = 0;
  for (const auto& [pixel, s] : with) defined += s.undefined ? 0 : 1;
  EXPECT_EQ(defined, with.size());
}

TEST(Hybrid, VertexInTheEyePlaneIsUndefinedEverywhere) {
  Quad quad = quad_at({{{2, 3}, {27, 9}, {20, 28}, {5, 20}}});
  quad.vertex[3].w = 0;  // v_3 at infinity
  for (const HybridForm form : forms) {
    const auto samples = test::draw(*make_hybrid(form), quad, {32, 32, true});
    ASSERT_GT(samples.size(), 50u);
    for (const MethodSample& s : samples) ASSERT_TRUE(s.undefined);
  }
}

TEST(Hybrid, KillLeavesTheQuadAndNoKillBothTriangles) {
  // Concave at corner 2, so that triangles 013 and 123 overlap outside the quad; tilted to keep ties away.
  const Quad concave = quad_at({{{2.3, 3.2}, {29.1, 4.3}, {9.2, 9.6}, {4.4, 28.7}}}, {1, 2, 1.5, 3});
  const Quad crossed = quad_at({{{2.3, 3.2}, {29.1, 27.3}, {28.2, 4.6}, {4.4, 28.7}}}, {1, 2, 1.5, 3});
  for (const Quad& quad : {concave, crossed}) {
    const TruthQuad truth(window_quad(quad), draw_state(32, true));
    std::size_t inside = 0;
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) inside += truth.cover(x, y).covered ? 1 : 0;
    }
    for (const HybridForm form : {HybridForm::pixels, HybridForm::ndc, HybridForm::tarini}) {
      const auto pixels = by_pixel(*make_hybrid(form), quad, {32, 32, true});
      EXPECT_EQ(pixels.size(), inside);
      for (const auto& [pixel, s] : pixels) {
        const auto expected = truth.sample(pixel.first, pixel.second);
        ASSERT_TRUE(expected.covered);
        ASSERT_EQ(s.front, expected.front);
        ASSERT_LE(largest_difference(s.lambda, expected.lambda), 1e-4);
      }
    }
    std::map<Pixel, int> times;
    for (const MethodSample& s : test::draw(*make_hybrid(HybridForm::bloomenthal), quad, {32, 32, true}))
      ++times[{s.x, s.y}];
    std::size_t once = 0, twice = 0;
    for (const auto& [pixel, n] : times) {
      ASSERT_EQ(n, truth.cover(pixel.first, pixel.second).covered ? 1 : 2) << "outside, both triangles draw";
      ++(n == 1 ? once : twice);
    }
    EXPECT_EQ(once, inside);
    EXPECT_GT(twice, 20u);
  }
}

TEST(Hybrid, KillsByTheSignsOfEquation10) {
  // One corner behind the eye: inside, the weights of eq. (7) have mixed signs, those of eq. (10) have not.
  const Quad quad = quad_at({{{20.3, 20.1}, {30.2, 5.4}, {40.6, 21.2}, {31.1, 30.7}}}, {1, -1.3, 1.2, 2});
  const TruthQuad truth(window_quad(quad), draw_state(64, true));
  std::size_t visible = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) visible += truth.cover(x, y).visible ? 1 : 0;
  }
  ASSERT_GT(visible, 500u);
  for (const HybridForm form : {HybridForm::pixels, HybridForm::ndc, HybridForm::tarini}) {
    const auto pixels = by_pixel(*make_hybrid(form), quad, {64, 64, true});
    EXPECT_LE(pixels.size(), visible);
    EXPECT_GE(pixels.size() + 2, visible) << "pinholes: a sign that single precision gets wrong beside an edge";
    for (const auto& [pixel, s] : pixels) {
      ASSERT_LE(largest_difference(s.lambda, truth.sample(pixel.first, pixel.second).lambda), 1e-3);
    }
  }
}

TEST(Hybrid, WeightsOfTheNdcFormsFollowTheShapeOfTheViewport) {
  // Mean value coordinates change when x and y are scaled differently: 64 x 32 px in NDC are as the quad squeezed to
  // half its width, on a square.
  const std::array<Vec2, 4> point{{{6.3, 3.2}, {20.1, 28.3}, {56.2, 25.6}, {44.4, 4.7}}};
  std::array<Vec2, 4> squeezed = point;
  for (Vec2& p : squeezed) p[0] /= 2;
  const TruthQuad wide(window_quad(quad_at(point)), draw_state(64, true));
  const auto ndc = by_pixel(*make_hybrid(HybridForm::ndc), quad_at(point), {64, 32, true});
  const auto pixels = by_pixel(*make_hybrid(HybridForm::pixels), quad_at(point), {64, 32, true});
  const auto half = by_pixel(*make_hybrid(HybridForm::ndc), quad_at(squeezed), {32, 32, true});
  ASSERT_EQ(ndc.size(), pixels.size());
  double largest = 0;
  for (const auto& [pixel, s] : ndc) {
    const auto expected = wide.sample(pixel.first, pixel.second).lambda;
    ASSERT_LE(largest_difference(pixels.at(pixel).lambda, expected), 1e-4);
    largest = std::max(largest, largest_difference(s.lambda, expected));
  }
  EXPECT_GT(largest, 0.01);
  ASSERT_GT(half.size(), 100u);
}

TEST(Hybrid, CensusNamesAndWireframe) {
  const std::vector<Quad> quads(3);
  const std::array<std::string, 4> names{"hybrid:pixels", "hybrid:ndc", "hybrid:tarini", "hybrid:bloomenthal"};
  for (std::size_t i = 0; i < forms.size(); ++i) {
    const auto method = make_hybrid(forms[i]);
    EXPECT_EQ(method->census(quads, {}), (Census{.quads = 3, .emitted_quads = 3, .triangles = 6}));
    EXPECT_EQ(method->name(), names[i]);
    const auto outline = method->wireframe(square_on_centres, {});
    ASSERT_EQ(outline.size(), 2u);
    // Listing 1 cuts from corner 1 to 3, so its first triangle ends there; section 5.1's at corner 2.
    const bool listing = forms[i] == HybridForm::ndc || forms[i] == HybridForm::bloomenthal;
    EXPECT_EQ(outline[0][2].x, square_on_centres.vertex[listing ? 3 : 2].x);
  }
}

}  // namespace
}  // namespace quadrille::golden::methods
