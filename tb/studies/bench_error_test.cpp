// What `bench --error` counts, on quads whose counts follow by hand, and that it finds faults put into a machine.
#include "tb/studies/bench_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

namespace quadrille::tb {
namespace {

/// Corners on pixel centres 16 apart. Ties count as if the centre were moved by (+eps, +eps^2): 16 x 16 pixels are
/// covered, the 31 of the first row and column lie on an edge or corner.
constexpr std::uint64_t square_fragments = 256, square_on_edge = 31;

WindowQuad square(double z = 0.5, int attributes = 0) {
  WindowQuad quad;
  quad.vertex = {{{4.5, 4.5, z, 1}, {20.5, 4.5, z, 1}, {20.5, 20.5, z, 1}, {4.5, 20.5, z, 1}}};
  for (std::size_t v = 0; v < 4; ++v)
    for (int a = 0; a < attributes; ++a) quad.attribute[v].push_back(a == 0 ? 1 : 0.25 * static_cast<double>(v) - 0.3);
  return quad;
}

class ErrorBenchTest : public testing::Test {
 protected:
  ErrorBenchTest() {
    settings_.rtl = false;
    settings_.state.width = settings_.state.height = settings_.state.scissor_x1 = settings_.state.scissor_y1 = 64;
  }

  ErrorBench compare(const std::vector<WindowQuad>& quads, int attributes = 0) const {
    ErrorBench bench(settings_, quads, attributes);
    bench.compare();
    return bench;
  }

  /// `fault` changes what one body draws, in the first draw.
  template <class Fault>
  void break_body(EngineKind broken, Fault fault) {
    settings_.draw = [=](EngineKind body, std::span<const SnappedQuad> quads, const Config& config,
                         const DrawState& state) {
      std::vector<Fragment> fragments = draw_body(body, quads, config, state);
      if (body == broken) fault(fragments);
      return fragments;
    };
  }

  ErrorBench::Settings settings_;
};

constexpr EngineKind own_machines[] = {EngineKind::model, EngineKind::model_plain, EngineKind::model_clocked};

TEST_F(ErrorBenchTest, CountsOfASquare) {
  const ErrorBench bench = compare({square(0.5, 5)}, 5);  // more attributes than the machine has slots
  EXPECT_TRUE(bench.failures().empty()) << bench.failures().front();
  for (const EngineKind body : own_machines) {
    const BodyResult& r = bench.result(body);
    EXPECT_EQ(r.fragments, square_fragments);
    EXPECT_EQ(r.undefined + r.missing, 0u);
    EXPECT_EQ(r.lambda.count(), square_fragments);
    EXPECT_GT(r.lambda.max(), 0);
    EXPECT_LT(r.lambda.max(), 0x1p-15);
  }
  for (const EngineKind body : {EngineKind::paper_single, EngineKind::paper_float}) {
    const BodyResult& r = bench.result(body);
    EXPECT_EQ(r.fragments, square_fragments);
    EXPECT_EQ(r.undefined, square_on_edge);
    EXPECT_EQ(r.missing, 0u);
    for (const ErrorStats* stats : {&r.lambda, &r.attribute, &r.depth})
      EXPECT_EQ(stats->count(), square_fragments - square_on_edge);
    // Some ulps times |v|^2/|A| <= 2 * 20^2 / 16 one pixel from an edge, and not those of the other precision.
    const double ulp = body == EngineKind::paper_single ? 0x1p-23 : 0x1p-52;
    EXPECT_GT(r.lambda.max(), ulp / 16);
    EXPECT_LT(r.lambda.max(), ulp * 0x1p10);
    EXPECT_LT(r.depth.max(), ulp * 0x1p10);
    EXPECT_GT(r.attribute.max(), 0);
    EXPECT_LT(r.attribute.max(), ulp * 0x1p10);
  }
  const BodyResult& truth = bench.result(EngineKind::truth);
  EXPECT_EQ(truth.fragments, square_fragments);
  EXPECT_EQ(truth.lambda.count(), square_fragments);
  EXPECT_EQ(truth.lambda.max() + truth.attribute.max() + truth.depth.max(), 0);
  EXPECT_FALSE(bench.has(EngineKind::rtl));
  EXPECT_EQ(bench.result(EngineKind::rtl).fragments, 0u);
}

TEST_F(ErrorBenchTest, WithoutAttributesOrDepthTheyHaveNoErrors) {
  settings_.state.depth = false;
  const ErrorBench bench = compare({square()});
  EXPECT_TRUE(bench.failures().empty());
  for (const EngineKind body :
       {EngineKind::paper_single, EngineKind::paper_float, EngineKind::truth, EngineKind::model}) {
    EXPECT_EQ(bench.result(body).attribute.count(), 0u);
    EXPECT_EQ(bench.result(body).depth.count(), 0u);
    EXPECT_GT(bench.result(body).lambda.count(), 0u);
  }
}

TEST_F(ErrorBenchTest, DepthRoundedOutOfItsIntervalIsMissing) {
  // z = 1 = zfar at every corner: sum(lambda) rounds to more than 1 now and then, in either precision.
  const ErrorBench bench = compare({square(1)});
  EXPECT_TRUE(bench.failures().empty());
  for (const EngineKind body : {EngineKind::paper_single, EngineKind::paper_float}) {
    const BodyResult& r = bench.result(body);
    EXPECT_GT(r.missing, 0u);
    EXPECT_LT(r.missing, square_fragments / 2);
    EXPECT_EQ(r.fragments, bench.result(EngineKind::model).fragments);  // which lacks some itself, and may
    EXPECT_EQ(r.undefined + r.missing + r.lambda.count(), r.fragments);
  }
}

TEST_F(ErrorBenchTest, AVertexBehindTheEyeWithoutPerspectiveHasNoWeightErrors) {
  WindowQuad quad = square(0.5, 1);
  quad.vertex[2] = {-50, -50, -0.5, -1};
  settings_.state.perspective = false;
  const ErrorBench flat = compare({quad}, 1);
  settings_.state.perspective = true;
  const ErrorBench deep = compare({quad}, 1);
  for (const EngineKind body :
       {EngineKind::paper_single, EngineKind::paper_float, EngineKind::truth, EngineKind::model}) {
    EXPECT_GT(flat.result(body).fragments, 0u);
    EXPECT_EQ(flat.result(body).lambda.count(), 0u);
    EXPECT_EQ(flat.result(body).attribute.count(), 0u);
    EXPECT_GT(deep.result(body).lambda.count(), 0u);
    EXPECT_GT(deep.result(body).attribute.count(), 0u);
  }
}

TEST_F(ErrorBenchTest, DrawsQuadsUntilThereIsEnough) {
  const std::vector<WindowQuad> quads(40, square());
  settings_.limit_fragments = 1000;  // four squares, but 16 quads are the least
  EXPECT_EQ(ErrorBench(settings_, quads, 0).quads(), ErrorBench::least_quads);
  settings_.limit_fragments = 5000;  // 19.5 squares
  const ErrorBench bench = compare(quads);
  EXPECT_EQ(bench.quads(), 20u);
  EXPECT_EQ(bench.result(EngineKind::model).fragments, 20 * square_fragments);
  EXPECT_EQ(bench.result(EngineKind::paper_single).undefined, 20 * square_on_edge);
}

TEST_F(ErrorBenchTest, NoFragmentsIsAFailure) {
  WindowQuad outside = square();
  for (WindowVertex& vertex : outside.vertex) vertex.x += 200;
  const ErrorBench bench = compare({outside});
  ASSERT_EQ(bench.failures().size(), std::size(own_machines));
  EXPECT_EQ(bench.failures().front(), "model: no fragments");
}

TEST_F(ErrorBenchTest, MachinesThatDifferAreAFailure) {
  break_body(EngineKind::model_clocked, [](std::vector<Fragment>& fragments) { fragments[7].attribute[3] ^= 1; });
  const ErrorBench bench = compare({square()});
  ASSERT_EQ(bench.failures().size(), 1u);  // one bit is within the bound
  EXPECT_EQ(bench.failures().front().rfind("model-clocked differs from model: fragment 7 (", 0), 0u);
  EXPECT_EQ(bench.result(EngineKind::model_clocked).fragments, square_fragments);
}

TEST_F(ErrorBenchTest, AMissingPixelIsAFailure) {
  break_body(EngineKind::model_plain, [](std::vector<Fragment>& fragments) { fragments.pop_back(); });
  const ErrorBench bench = compare({square()});
  ASSERT_EQ(bench.failures().size(), 2u);
  EXPECT_NE(bench.failures()[0].find("model-plain differs from model: fragment 255"), std::string::npos);
  EXPECT_NE(bench.failures()[1].find("model-plain: 1 pixels that differ from the truth"), std::string::npos);
  EXPECT_EQ(bench.result(EngineKind::model_plain).missing, 1u);
  EXPECT_EQ(bench.result(EngineKind::model).missing, 0u);
}

TEST_F(ErrorBenchTest, AWeightBeyondTheBoundIsAFailure) {
  // Twice the bound of 2^-(s-3).
  const int shift = settings_.config.attribute_frac() - settings_.config.significand_bits + 4;
  break_body(EngineKind::model, [=](std::vector<Fragment>& f) { f[100].attribute[0] += std::int64_t{1} << shift; });
  const ErrorBench bench = compare({square()});
  const auto says = [&](const std::string& text) {
    return std::any_of(bench.failures().begin(), bench.failures().end(),
                       [&](const std::string& failure) { return failure == text; });
  };
  EXPECT_TRUE(says("model: 1 weights beyond the bound"));
  EXPECT_NEAR(bench.result(EngineKind::model).lambda.max(), 0x1p-14, 0x1p-16);
  EXPECT_LT(bench.result(EngineKind::model_plain).lambda.max(), 0x1p-15);
}

TEST_F(ErrorBenchTest, NamesTheFirstDifference) {
  std::vector<Fragment> a(3), b(3);
  EXPECT_EQ(first_difference(a, b), "");
  b[1] = {9, 4, 5};
  a[1] = {9, 4, 6};
  EXPECT_EQ(first_difference(a, b), "fragment 1 (quad 9, pixel (4, 6)) differs");
  b = {a[0], a[1]};
  EXPECT_EQ(first_difference(a, b), "fragment 2 (quad 0, pixel (0, 0)) is missing");
  EXPECT_EQ(first_difference(b, a), "fragment 2 (quad 0, pixel (0, 0)) is one too many");
}

TEST_F(ErrorBenchTest, TimesEveryBody) {
  ErrorBench bench(settings_, std::vector<WindowQuad>(2, square()), 0);
  bench.compare();
  bench.time(1);
  for (const EngineKind body : {EngineKind::paper_single, EngineKind::paper_float, EngineKind::truth,
                                EngineKind::model_plain, EngineKind::model, EngineKind::model_clocked}) {
    EXPECT_GT(bench.result(body).seconds_per_fragment, 1e-10);
    EXPECT_LT(bench.result(body).seconds_per_fragment, 1e-2);
    EXPECT_GT(bench.result(body).fragments, 0u) << "the errors stay";
  }
  EXPECT_EQ(bench.result(EngineKind::rtl).seconds_per_fragment, 0);
}

}  // namespace
}  // namespace quadrille::tb
