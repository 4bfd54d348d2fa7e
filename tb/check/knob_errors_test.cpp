// Errors in units of the bound: what is exact has none, what fails is seen to fail, and a jump is found where one is.
#include "tb/check/knob_errors.hpp"

#include "golden/scenes/approach.hpp"
#include "golden/scenes/stress.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace quadrille::cli {
namespace {

constexpr unsigned paper =
    1u << static_cast<unsigned>(KnobBody::paper_float) | 1u << static_cast<unsigned>(KnobBody::fp32);

DrawState draw_state(int extent) {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = extent;
  return state;
}

const BodyErrors& of(const KnobErrors& errors, KnobBody body) { return errors.body[static_cast<std::size_t>(body)]; }

/// A corner at the pixel: the machine is exact, the paper's formulas divide by zero.
TEST(KnobErrors, ACornerAtAPixel) {
  WindowQuad quad;
  const double corners[4][2]{{0.5, 0.5}, {1.25, 0.5}, {1.25, 1.25}, {0.5, 1.25}};
  for (std::size_t i = 0; i < 4; ++i) {
    quad.vertex[i] = {corners[i][0], corners[i][1], 0.5, 1};
    quad.attribute[i] = {0.25};
  }
  const KnobErrors errors = measure_knob(std::span(&quad, 1), 1, Config{}, draw_state(8), paper);
  EXPECT_TRUE(errors.verdict.ok());
  const BodyErrors& model = of(errors, KnobBody::model);
  EXPECT_EQ(model.fragments, 1u);
  EXPECT_EQ(model.weight, 0);
  EXPECT_EQ(model.attribute, 0);
  EXPECT_EQ(model.depth, 0);
  for (const KnobBody body : {KnobBody::paper_float, KnobBody::fp32}) {
    EXPECT_EQ(of(errors, body).fragments, 0u);
    EXPECT_EQ(of(errors, body).undefined, 1u);
  }
  EXPECT_EQ(of(errors, KnobBody::rtl).fragments + of(errors, KnobBody::rtl).missing, 0u);
}

/// The model's largest weight error is the judge's, found at the same pixel; the paper's formulas in double precision
/// are far more exact away from special cases, those in single precision lie between.
TEST(KnobErrors, AgreeWithTheJudge) {
  const auto quads = golden::make_stress_without_weights(golden::StressFamily::perspective, 12, 5, 64, 64, 2);
  const KnobErrors errors = measure_knob(quads, 2, Config{}, draw_state(64), paper);
  const BodyErrors& model = of(errors, KnobBody::model);
  EXPECT_TRUE(errors.verdict.ok());
  EXPECT_EQ(model.weight, errors.verdict.worst.ratio);
  EXPECT_EQ(model.worst.index, errors.verdict.worst.place.index);
  EXPECT_EQ(model.worst.x, errors.verdict.worst.place.x);
  EXPECT_EQ(model.worst.y, errors.verdict.worst.place.y);
  EXPECT_EQ(model.attribute, errors.verdict.attribute.max);
  EXPECT_EQ(errors.weights.size(), model.fragments);
  EXPECT_GT(model.weight, 0.05);
  EXPECT_LT(of(errors, KnobBody::paper_float).weight, 1e-3);
  EXPECT_GT(of(errors, KnobBody::fp32).weight, of(errors, KnobBody::paper_float).weight);
  EXPECT_EQ(
      of(errors, KnobBody::fp32).fragments + of(errors, KnobBody::fp32).undefined + of(errors, KnobBody::fp32).missing,
      model.fragments);
}

/// Two corners at one place: the paper's formulas divide by zero at every pixel, the machine does not notice; a pixel
/// apart both are fine.
TEST(KnobErrors, TheFormulasFailWhereAnEdgeCollapses) {
  const golden::Approach& approach = *golden::find_approach("edge_length");
  const auto apart = golden::make_approach(approach, 0, 1, 12, 1, 1),
             equal = golden::make_approach(approach, 8, 0, 12, 1, 1);
  const KnobErrors before = measure_knob(apart, 1, Config{}, draw_state(64), paper),
                   after = measure_knob(equal, 1, Config{}, draw_state(64), paper);
  EXPECT_GT(of(before, KnobBody::fp32).fragments, 100u);
  const BodyErrors& model = of(after, KnobBody::model);
  EXPECT_GT(model.fragments, 100u);
  EXPECT_LT(model.weight, 1);
  for (const KnobBody body : {KnobBody::paper_float, KnobBody::fp32}) {
    EXPECT_EQ(of(after, body).fragments, 0u);
    EXPECT_EQ(of(after, body).undefined + of(after, body).missing, model.fragments);
  }
}

TEST(KnobErrors, Jump) {
  const std::vector<WeightErrors> a{{0, 1, 1, {0.5, 0, 0, 0}}, {0, 2, 1, {0, 0, 0, 0}}, {1, 2, 1, {0, 0, 0, 9}}};
  const std::vector<WeightErrors> b{{0, 1, 1, {-0.25, 0, 0, 0.5}}, {0, 3, 1, {7, 0, 0, 0}}};
  EXPECT_EQ(error_jump(a, b).pixels, 1u);
  EXPECT_EQ(error_jump(a, b).largest, 0.75);
  EXPECT_EQ(error_jump(b, a).largest, 0.75);
}

}  // namespace
}  // namespace quadrille::cli
