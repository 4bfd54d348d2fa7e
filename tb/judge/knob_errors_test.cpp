// Errors in units of the bound: what is exact has none, what fails is seen to fail, and a jump is found where one is.
#include "tb/judge/knob_errors.hpp"

#include "golden/analysis/judged_quad.hpp"
#include "golden/scenes/approach.hpp"
#include "golden/scenes/stress.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace quadrille::tb {
namespace {

constexpr unsigned paper =
    1u << static_cast<unsigned>(EngineKind::paper_float) | 1u << static_cast<unsigned>(EngineKind::paper_single);

DrawState draw_state(int extent) {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = extent;
  return state;
}

double weight(const BodyErrors& errors) { return errors.of(Output::weight).part; }

const BodyErrors& of(const KnobErrors& errors, EngineKind body) { return errors.body[body]; }

/// A corner at the pixel: the machine is exact, the paper's formulas divide by zero.
TEST(KnobErrors, ACornerAtAPixel) {
  WindowQuad quad;
  const double corners[4][2]{{0.5, 0.5}, {1.25, 0.5}, {1.25, 1.25}, {0.5, 1.25}};
  for (std::size_t i = 0; i < 4; ++i) {
    quad.vertex[i] = {corners[i][0], corners[i][1], 0.5, 1};
    quad.attribute[i] = {0.25};
  }
  const KnobErrors errors = measure_knob(std::span(&quad, 1), {}, 1, Config{}, draw_state(8), paper);
  EXPECT_TRUE(errors.verdict.ok());
  const BodyErrors& model = of(errors, EngineKind::model);
  EXPECT_EQ(model.fragments, 1u);
  for (const LargestError& error : model.largest) EXPECT_EQ(error.part, 0);
  for (const EngineKind body : {EngineKind::paper_float, EngineKind::paper_single}) {
    EXPECT_EQ(of(errors, body).fragments, 0u);
    EXPECT_EQ(of(errors, body).undefined, 1u);
    EXPECT_EQ(of(errors, body).lost.x, 0);
    EXPECT_EQ(of(errors, body).lost.y, 0);
  }
  EXPECT_EQ(of(errors, EngineKind::rtl).fragments + of(errors, EngineKind::rtl).missing, 0u);
}

/// The model's largest weight error is the judge's, found at the same pixel; the paper's formulas in double precision
/// are far more exact away from special cases, those in single precision lie between.
TEST(KnobErrors, AgreeWithTheJudge) {
  const auto quads = golden::make_stress_without_weights(golden::StressFamily::perspective, 12, 5, 64, 64, 2);
  const KnobErrors errors = measure_knob(quads, {}, 2, Config{}, draw_state(64), paper);
  const BodyErrors& model = of(errors, EngineKind::model);
  EXPECT_TRUE(errors.verdict.ok());
  const LargestError& largest = model.of(Output::weight);
  EXPECT_EQ(largest.part, errors.verdict.worst.ratio);
  EXPECT_EQ(largest.place.index, errors.verdict.worst.place.index);
  EXPECT_EQ(largest.place.x, errors.verdict.worst.place.x);
  EXPECT_EQ(largest.place.y, errors.verdict.worst.place.y);
  // With the output's half code on either side of the quotient.
  EXPECT_GT(model.of(Output::attribute).part, errors.verdict.attribute.max);
  EXPECT_LE(model.of(Output::attribute).part, 1);
  EXPECT_EQ(errors.model.pixels.size(), model.fragments);
  EXPECT_EQ(errors.model.errors.size(), model.fragments * (4 + 2 + 1));
  EXPECT_GT(weight(model), 0.05);
  EXPECT_EQ(model.beyond, 0u);
  EXPECT_LT(weight(of(errors, EngineKind::paper_float)), 1e-3);
  EXPECT_GT(weight(of(errors, EngineKind::paper_single)), weight(of(errors, EngineKind::paper_float)));
  EXPECT_EQ(of(errors, EngineKind::paper_single).fragments + of(errors, EngineKind::paper_single).undefined +
                of(errors, EngineKind::paper_single).missing,
            model.fragments);
}

/// Two corners at one place: the paper's formulas divide by zero at every pixel, the machine does not notice; a pixel
/// apart both are fine.
TEST(KnobErrors, TheFormulasFailWhereAnEdgeCollapses) {
  const golden::Approach& approach = *golden::find_approach("edge_length");
  const auto apart = golden::make_approach(approach, 0, 1, 12, 1, 1),
             equal = golden::make_approach(approach, 8, 0, 12, 1, 1);
  const KnobErrors before = measure_knob(apart, {}, 1, Config{}, draw_state(64), paper),
                   after = measure_knob(equal, {}, 1, Config{}, draw_state(64), paper);
  EXPECT_GT(of(before, EngineKind::paper_single).fragments, 100u);
  const BodyErrors& model = of(after, EngineKind::model);
  EXPECT_GT(model.fragments, 100u);
  EXPECT_LT(weight(model), 1);
  for (const EngineKind body : {EngineKind::paper_float, EngineKind::paper_single}) {
    EXPECT_EQ(of(after, body).fragments, 0u);
    EXPECT_EQ(of(after, body).undefined + of(after, body).missing, model.fragments);
  }
}

/// Near the case are the pixels that the place says, and no others: of an edge through a pixel's centre that pixel.
TEST(KnobErrors, NearTheCase) {
  const golden::Approach& approach = *golden::find_approach("edge_distance");
  const auto quads = golden::make_approach(approach, 3, 1, 20, 1, 1);
  const auto places = golden::approach_places(approach, 3, 1, 20, 1);
  const KnobErrors errors = measure_knob(quads, places, 1, Config{}, draw_state(64), paper);
  std::size_t near_pixels = 0;
  float largest = 0;
  for (std::size_t i = 0; i < errors.model.pixels.size(); ++i) {
    const PixelSeries::Pixel& p = errors.model.pixels[i];
    if (p.x + 0.5 != places[p.index].near_x || p.y + 0.5 != places[p.index].near_y) continue;
    ++near_pixels;
    for (std::size_t v = 0; v < 4; ++v) largest = std::max(largest, std::fabs(errors.model.errors[i * 6 + v]));
  }
  const BodyErrors& model = errors.near_case[EngineKind::model];
  EXPECT_GT(near_pixels, 3u);
  EXPECT_EQ(model.fragments, near_pixels);
  EXPECT_LT(near_pixels, errors.body[EngineKind::model].fragments);
  EXPECT_EQ(static_cast<float>(weight(model)), largest);
  const BodyErrors& single = errors.near_case[EngineKind::paper_single];
  EXPECT_EQ(single.fragments + single.pixels_lost(), near_pixels);

  const KnobErrors nowhere = measure_knob(quads, {}, 1, Config{}, draw_state(64), paper);
  EXPECT_EQ(nowhere.near_case[EngineKind::model].fragments, 0u);
  EXPECT_EQ(weight(nowhere.body[EngineKind::model]), weight(errors.body[EngineKind::model]));
}

/// The quick tolerance of depth is the judge's, with vertices behind the eye too.
TEST(KnobErrors, ToleranceOfDepth) {
  const Config config;
  const Bounds bounds(config);
  for (const auto family : {golden::StressFamily::perspective, golden::StressFamily::eye_crossing}) {
    DrawState state = draw_state(64);
    state.attributes = 1;
    int compared = 0, unlimited = 0;
    for (const WindowQuad& given : golden::make_stress_without_weights(family, 60, 3, 64, 64, 1)) {
      const SnappedQuad snapped = snap_as(given, 0, config, state);
      const JudgedQuad quad(snapped, config, bounds, state);
      const ErrorBounds limits(quad, config, state);
      for (int y = 0; y < 64; y += 3)
        for (int x = 0; x < 64; x += 3) {
          const golden::ReferenceSample truth = quad.truth().sample(x, y);
          if (!truth.covered || !truth.visible) continue;
          const double exact = quad.depth_tolerance(x, y),
                       quick = limits.at(truth, x, y).depth - depth_format(config).unit() / 2;
          ++compared;
          unlimited += std::isinf(exact);
          EXPECT_EQ(std::isinf(quick), std::isinf(exact));
          if (std::isfinite(exact)) {
            EXPECT_NEAR(quick, exact, 1e-9 * exact + 1e-15) << x << ", " << y;
          }
        }
    }
    EXPECT_GT(compared, 50);
    EXPECT_EQ(unlimited, 0);
  }
}

/// Fragments beyond the bound are counted once each, whichever output is.
TEST(KnobErrors, BeyondTheBound) {
  const auto quads = golden::make_approach(*golden::find_approach("edge_length"), 8, 1, 12, 1, 1);
  const KnobErrors errors = measure_knob(quads, {}, 1, Config{}, draw_state(64), paper);
  const BodyErrors& single = of(errors, EngineKind::paper_single);
  EXPECT_GT(weight(single), 1);
  EXPECT_GE(single.beyond, 1u);
  EXPECT_LE(single.beyond, single.fragments);
  EXPECT_EQ(of(errors, EngineKind::model).beyond, 0u);
}

TEST(KnobErrors, Jump) {
  // Four weights, one attribute, depth.
  const PixelSeries a{{{0, 1, 1}, {0, 2, 1}, {1, 2, 1}},
                      {0.5, 0, 0, 0, 1, 0, /**/ 0, 0, 0, 0, 0, 0, /**/ 0, 0, 0, 9, 0, 0}};
  const PixelSeries b{{{0, 1, 1}, {0, 3, 1}}, {-0.25, 0, 0, 0.5, 0.875, 0.25, /**/ 7, 0, 0, 0, 0, 0}};
  for (const ErrorJump& jump : {error_jump(a, b), error_jump(b, a)}) {
    EXPECT_EQ(jump.pixels, 1u);
    EXPECT_EQ(jump.largest, (std::array{0.75, 0.125, 0.25}));
  }
  EXPECT_EQ(error_jump(a, {}).pixels, 0u);
  ErrorJump sum = error_jump(a, b);
  sum.merge({2, {0.5, 0.5, 0.5}});
  EXPECT_EQ(sum.pixels, 3u);
  EXPECT_EQ(sum.largest, (std::array{0.75, 0.5, 0.5}));
}

}  // namespace
}  // namespace quadrille::tb
