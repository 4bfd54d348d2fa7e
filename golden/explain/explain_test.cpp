// Why a pixel is drawn or is not, and what exact arithmetic has beside the stored numbers, of quads whose answers are
// known by hand or from the truth.
#include "golden/explain/explain.hpp"
#include "golden/explain/compare.hpp"
#include "golden/reference/truth.hpp"
#include "golden/scenes/stress.hpp"
#include "model/port/boundaries.hpp"
#include "model/port/draw_state.hpp"
#include "model/port/snap.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

namespace quadrille::explain {
namespace {

DrawState state64() {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = 64;
  state.attributes = 1;
  return state;
}

/// Corners 0 to 3 anticlockwise on the screen, a front face: upper left, lower left, lower right, upper right. The
/// attribute is 0 on the left and 1 on the right; z likewise from `left` to `right`.
WindowQuad box(double x0, double y0, double x1, double y1, double left = 0.25, double right = 0.25) {
  WindowQuad quad;
  quad.vertex = {{{x0, y0, left, 1}, {x0, y1, left, 1}, {x1, y1, right, 1}, {x1, y0, right, 1}}};
  quad.attribute = {{{0}, {0}, {1}, {1}}};
  return quad;
}

WindowQuad turned(WindowQuad quad) {
  std::swap(quad.vertex[1], quad.vertex[3]);
  std::swap(quad.attribute[1], quad.attribute[3]);
  return quad;
}

Explanation of(const WindowQuad& quad, int x, int y, const DrawState& state = state64()) {
  return explain(Config{}, state, std::span(&quad, 1), x, y).front();
}

const Number& number(const Explanation& e, const std::string& stage, const std::string& name) {
  for (const Stage& s : e.stages)
    for (const Number& n : s.numbers)
      if (s.name == stage && n.name == name) return n;
  throw std::out_of_range(stage + " has no " + name);
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Explain, NumbersThatAreKnownByHand) {
  const Explanation e = of(box(10, 10, 31, 31), 20, 20);
  EXPECT_EQ(e.outcome, Outcome::drawn);
  EXPECT_TRUE(e.front);
  EXPECT_TRUE(e.seen);
  EXPECT_FALSE(e.homogeneous);
  EXPECT_EQ(e.place, "inside");
  // The centre of a square of 21 px: corners at (∓10.5, ∓10.5). The diagonal 20 goes through it.
  for (const char* pair : {"01", "12", "23", "30"}) {
    EXPECT_EQ(number(e, "diff", std::string("A") + pair).value, -220.5);
    EXPECT_EQ(number(e, "diff", std::string("D") + pair).value, 0);
    EXPECT_EQ(number(e, "ratio", std::string("u") + pair).exact, 220.5);
  }
  EXPECT_EQ(number(e, "diff", "A20").value, 0);
  EXPECT_EQ(number(e, "diff", "D20").value, -220.5);
  EXPECT_EQ(e.flags, std::vector<std::string>{"tie"});
  for (const char* corner : {"0", "1", "2", "3"}) {
    EXPECT_EQ(number(e, "diff", std::string("R²") + corner).value, 220.5);
    const Number r = number(e, "sqrt", std::string("r") + corner);
    EXPECT_EQ(r.exact_digits, "14.8492424049174980124177316042");    // 21 / sqrt(2)
    EXPECT_LE(std::fabs(r.value - *r.exact), std::ldexp(1.0, -13));  // 18 bits of 14.8
    const Number lambda = number(e, "lambda", std::string("λ'") + corner);
    EXPECT_EQ(lambda.exact, 0.25);
    EXPECT_NEAR(lambda.value, 0.25, std::ldexp(1.0, -15));
    EXPECT_EQ(lambda.given, 0.25);
  }
  EXPECT_EQ(number(e, "fragment", "a0").exact, 0.5);
  EXPECT_EQ(number(e, "fragment", "z").value, 0.25);
  EXPECT_EQ(number(e, "snapping", "X0").value, 9.5);  // pixel centres are whole numbers
  EXPECT_EQ(number(e, "snapping", "X0").error_ulp, 0);
}

TEST(Explain, RulesThatRejectAPixel) {
  const WindowQuad quad = box(10, 10, 30, 30);
  Explanation e = of(quad, 40, 20);
  EXPECT_EQ(e.outcome, Outcome::outside);
  EXPECT_EQ(e.missed_by, 10.5);  // from the right edge, x = 30, to the centre of pixel 40
  EXPECT_TRUE(says(e.why, "E23 is positive, not negative (10.5 px from its line)")) << e.why;

  DrawState state = state64();
  state.cull = Cull::front;
  e = of(quad, 20, 20, state);
  EXPECT_EQ(e.outcome, Outcome::left_out);
  EXPECT_EQ(e.reject, QuadReject::culled);
  state.skip = 0;
  EXPECT_EQ(of(quad, 20, 20, state).outcome, Outcome::culled);
  EXPECT_EQ(of(turned(quad), 20, 20, state).outcome, Outcome::drawn);
  EXPECT_FALSE(of(turned(quad), 20, 20, state).front);

  state = state64();
  state.scissor_x0 = 15;
  EXPECT_EQ(of(quad, 14, 20, state).outcome, Outcome::scissor);
  EXPECT_EQ(of(quad, 15, 20, state).outcome, Outcome::drawn);

  state = state64();
  state.zfar = 0.5;
  EXPECT_EQ(of(box(10, 10, 30, 30, 0, 1), 15, 20, state).outcome, Outcome::drawn);
  e = of(box(10, 10, 30, 30, 0, 1), 25, 20, state);
  EXPECT_EQ(e.outcome, Outcome::depth_limits);
  EXPECT_TRUE(says(e.why, "window z = 0.775 is above zfar = 0.5")) << e.why;
  EXPECT_EQ(of(box(10, 10, 30, 30, 0.75, 0.75), 25, 20, state).reject, QuadReject::depth);
  state.zfar = 1;
  state.znear = 0.5;
  e = of(box(10, 10, 30, 30, 0, 1), 15, 20, state);
  EXPECT_TRUE(says(e.why, "window z = 0.275 is below znear = 0.5")) << e.why;
  // Beyond the range that is stored: no number that would lie within the limits.
  state.znear = 0;
  WindowQuad around = box(10, 10, 30, 30, 0.5, 0.5);
  for (const bool far : {false, true}) {
    around.vertex[2] = {60, -60, far ? 3.0 : -3.0, -1};
    e = of(around, far ? 24 : 27, 20, state);
    EXPECT_TRUE(says(e.why, far ? "window z is above zfar = 1" : "window z is below znear = 0")) << e.why;
  }

  WindowQuad behind = quad;
  for (WindowVertex& v : behind.vertex) v = {-v.x, -v.y, -v.z, -1};
  EXPECT_EQ(of(behind, 20, 20).reject, QuadReject::behind);
  state = state64();
  state.skip = 0;
  EXPECT_EQ(of(behind, 20, 20, state).outcome, Outcome::behind_eye);

  EXPECT_EQ(of(box(20.6, 20.6, 21.4, 21.4), 20, 20).reject, QuadReject::empty);
  WindowQuad line = box(10, 10, 30, 30);
  for (WindowVertex& v : line.vertex) v.y = v.x;
  EXPECT_EQ(of(line, 20, 20).reject, QuadReject::line);

  WindowQuad refused = quad;
  refused.vertex[2].x = std::numeric_limits<double>::quiet_NaN();
  e = of(refused, 20, 20);
  EXPECT_EQ(e.outcome, Outcome::refused);
  EXPECT_TRUE(says(e.why, "vertex 2")) << e.why;
  EXPECT_FALSE(e.covered());

  EXPECT_THROW(of(quad, 64, 0), std::invalid_argument);
  EXPECT_THROW(of(quad, 0, -1), std::invalid_argument);
}

/// Centres on the outline: the top-left rule decides, and says how.
TEST(Explain, Ties) {
  const WindowQuad quad = box(10.5, 10.5, 30.5, 30.5);
  Explanation e = of(quad, 10, 20);
  EXPECT_EQ(e.outcome, Outcome::drawn);
  EXPECT_EQ(e.place, "on an edge");
  EXPECT_EQ(e.flags, (std::vector<std::string>{"on_edge", "tie"}));
  EXPECT_TRUE(e.edges[0].tie);
  EXPECT_EQ(e.edges[0].name, "E01");
  EXPECT_EQ(e.edges[0].why, "falls to the right: negative");
  EXPECT_FALSE(e.edges[1].tie);

  e = of(quad, 30, 20);  // on the right edge: not inside
  EXPECT_EQ(e.outcome, Outcome::outside);
  EXPECT_TRUE(e.edges[2].tie);
  EXPECT_EQ(e.edges[2].why, "grows to the right: positive");
  e = of(quad, 20, 10);  // on the upper edge: inside
  EXPECT_EQ(e.outcome, Outcome::drawn);
  EXPECT_EQ(e.edges[3].why, "constant to the right, falls downward: negative");
  EXPECT_EQ(of(quad, 20, 30).outcome, Outcome::outside);

  e = of(quad, 10, 10);
  EXPECT_EQ(e.place, "on a corner");
  EXPECT_EQ(e.flags, (std::vector<std::string>{"on_vertex", "tie"}));
  EXPECT_EQ(number(e, "lambda", "λ'0").value, 1);
  EXPECT_EQ(number(e, "weight", "M0").value, 1);
  EXPECT_EQ(number(e, "weight", "M1").value, 0);
}

TEST(Explain, TheNearestQuadIsSeen) {
  std::vector<WindowQuad> quads{box(0, 0, 60, 60, 0.5, 0.5), box(0, 0, 60, 60, 0.25, 0.25),
                                box(0, 0, 60, 60, 0.25, 0.25), box(0, 0, 5, 5, 0.1, 0.1)};
  for (std::size_t i = 0; i < quads.size(); ++i) quads[i].id = static_cast<std::uint32_t>(i + 100);
  const auto seen = [&](const DrawState& state) {
    std::vector<int> out;
    for (const Explanation& e : explain(Config{}, state, quads, 20, 20)) out.push_back(e.seen);
    return out;
  };
  EXPECT_EQ(seen(state64()), (std::vector{0, 1, 0, 0}));  // of equal depths the earlier one
  DrawState no_depth = state64();
  no_depth.depth = false;
  EXPECT_EQ(seen(no_depth), (std::vector{0, 0, 1, 0}));  // the last that is drawn
  const std::vector<Explanation> all = explain(Config{}, state64(), quads, 20, 20);
  EXPECT_EQ(all[1].quad, 101u);
  EXPECT_EQ(all[1].index, 1u);
  EXPECT_EQ(all[3].outcome, Outcome::outside);
  EXPECT_TRUE(all[3].stages.empty());  // of several quads those that cover it have stages
  EXPECT_TRUE(says(summary(all), "quad 103, the nearest (its outline is 21.9 px away)")) << summary(all);
}

/// On quads of every kind: what is called exact is the truth's, and no number is beyond its bound.
TEST(Explain, ExactValuesAndBounds) {
  for (const bool perspective : {true, false})
    for (const int bits : {10, 18, 24}) {
      Config config;
      config.set("significand_bits", bits);
      DrawState state = state64();
      state.perspective = perspective;
      state.attributes = 2;
      std::size_t compared = 0, bounded = 0;
      for (const golden::StressFamilyInfo& family : golden::stress_families()) {
        SCOPED_TRACE(std::string(family.name) + ", s = " + std::to_string(bits));
        for (const WindowQuad& quad : golden::make_stress(family.family, 2, 5, 1.0, 64, 64, 2)) {
          const SnappedQuad snapped = snap_quad(quad, config, state);
          const golden::TruthQuad truth(snapped, config, state);
          int left = 4;
          for (int n = 0; n < 400 && left > 0; ++n) {
            const int x = n * 37 % 64, y = n * 23 % 64;
            const golden::ReferenceSample sample = truth.sample(x, y);
            if (!sample.covered) continue;
            const Explanation e = explain(config, state, std::span(&quad, 1), x, y).front();
            if (e.outcome != Outcome::drawn) continue;
            --left;
            SCOPED_TRACE("quad " + std::to_string(quad.id) + ", pixel " + std::to_string(x) + "," + std::to_string(y));
            EXPECT_EQ(e.front, sample.front);
            EXPECT_TRUE(e.remarks.empty() || !says(e.remarks.back(), "truth")) << e.remarks.back();
            const auto near = [&](const Number& number, double expected) {
              EXPECT_NEAR(*number.exact, expected, std::ldexp(std::max(1.0, std::fabs(expected)), -45)) << number.name;
              ++compared;
            };
            for (std::size_t i = 0; i < 4; ++i) near(number(e, "lambda", "λ'" + std::to_string(i)), sample.lambda[i]);
            near(number(e, "fragment", "z"), std::max(sample.z, 0.0));
            for (std::size_t a = 0; a < 2; ++a)
              if (std::ranges::find(e.flags, "saturated") == e.flags.end())
                near(number(e, "fragment", "a" + std::to_string(a)), sample.attribute[a]);
            for (const Stage& stage : e.stages)
              for (const Number& one : stage.numbers)
                if (one.of_bound) {
                  EXPECT_LE(*one.of_bound, 1) << stage.name << " " << one.name << ", error " << one.error_ulp;
                  ++bounded;
                }
          }
        }
      }
      EXPECT_GT(compared, 500u);
      EXPECT_GT(bounded, 5000u);
    }
}

TEST(Explain, NoBoundWithDroppedBits) {
  Config config;
  config.set("quadratic_frac_bits", 9);
  const WindowQuad quad = box(10.3, 10.7, 31.1, 31.9);
  const Explanation e = explain(config, state64(), std::span(&quad, 1), 20, 20).front();
  EXPECT_NE(number(e, "diff", "R²0").error_ulp, 0);
  // The stored units have an odd power of two; px are px.
  const Explanation whole = of(quad, 20, 20);
  for (const auto& [stage, name] : {std::pair{"sqrt", "r0"}, {"ratio", "u01"}, {"norm", "A12"}, {"norm", "R²3"}}) {
    EXPECT_NEAR(*number(e, stage, name).exact, *number(whole, stage, name).exact, 1e-12) << name;
    EXPECT_NEAR(number(e, stage, name).value, *number(e, stage, name).exact, 0.2) << name;
  }
  EXPECT_FALSE(number(e, "diff", "R²0").of_bound);
  EXPECT_EQ(number(e, "diff", "A01").of_bound, 0);
  EXPECT_FALSE(number(e, "lambda", "λ'1").of_bound);
}

TEST(Explain, RecordsOfAnotherMachine) {
  const WindowQuad quad = box(10, 10, 31, 31);
  Explanation e = of(quad, 20, 20);
  Stage& stage = *std::ranges::find(e.stages, "sqrt", &Stage::name);
  const RecordLayout layout = boundary_layout(Boundary::sqrt, Config{});
  Record record(layout.bits());
  for (const Number& n : stage.numbers)
    for (const Field& field : n.stored) record.set(layout.field(field.name, field.index), field.value);
  compare(stage, layout, &record);
  EXPECT_EQ(stage.compared, Stage::Compared::same);
  const RecordField& spoiled = layout.field("sig", 2);
  record.set(spoiled, record.get(spoiled) ^ 4);
  compare(stage, layout, &record);
  EXPECT_EQ(stage.compared, Stage::Compared::differs);
  EXPECT_FALSE(stage.numbers[1].differs);
  EXPECT_TRUE(stage.numbers[2].differs);
  EXPECT_TRUE(says(to_text(e), "(RTL: differs)"));
  EXPECT_TRUE(says(to_text(e), "  RTL  "));
  compare(stage, layout, nullptr);
  EXPECT_EQ(stage.compared, Stage::Compared::differs);
}

TEST(Explain, JsonTextAndPage) {
  std::vector<WindowQuad> quads{box(10, 10, 31, 31), box(0, 0, 5, 5)};
  const std::vector<Explanation> all = explain(Config{}, state64(), quads, 20, 20);
  const nlohmann::json json = nlohmann::json::parse(to_json(all[0]));
  EXPECT_EQ(json["outcome"], "drawn");
  EXPECT_EQ(json["edges"].size(), 5u);
  std::vector<std::string> stages;
  for (const auto& stage : json["stages"]) stages.push_back(stage["name"]);
  EXPECT_EQ(stages, (std::vector<std::string>{"snapping", "setup", "tile", "stamp", "diff", "norm", "sqrt", "ratio",
                                              "weight", "sum", "reciprocal", "fragment", "lambda"}));
  const nlohmann::json& area = json["stages"][4]["numbers"][4];
  EXPECT_EQ(area["name"], "A01");
  EXPECT_EQ(area["stored"]["a[0]"], -220.5 * (1 << 30));
  EXPECT_EQ(area["value"], -220.5);
  EXPECT_EQ(area["of_bound"], 0);
  EXPECT_EQ(nlohmann::json::parse(to_json(all[1]))["stages"].size(), 0u);

  const std::string text = to_text(all[0]);
  for (const char* part : {"Pixel (20, 20), quad 0: drawn", "1. ", "13. ", "A01", "exact: "})
    EXPECT_TRUE(says(text, part)) << part;
  EXPECT_GT(to_text(all[0], true).size(), text.size());
  std::istringstream lines(to_text(all[0], true) + summary(all));
  for (std::string line; std::getline(lines, line);)
    EXPECT_LE(std::ranges::count_if(line, [](char c) { return (c & 0xc0) != 0x80; }), 100) << line;
  DrawState bare = state64();
  bare.attributes = 0;
  EXPECT_TRUE(says(to_text(of(box(10, 10, 30, 30), 12, 15, bare)), "(1 number is not needed at this pixel, and 0)"));

  const std::string page = to_html(all, "A & B <c>", "quadrille explain --pixel 20,20");
  EXPECT_TRUE(says(page, "<h1>A &amp; B &lt;c&gt;</h1>"));
  for (const char* outside : {"http", "src=", "url(", "<script", "@import", "<link"})
    EXPECT_FALSE(says(page, outside)) << outside;
  const auto count = [&](const std::string& tag) {
    std::size_t n = 0;
    for (std::size_t at = page.find(tag); at != std::string::npos; at = page.find(tag, at + 1)) ++n;
    return n;
  };
  for (const std::string tag : {"details", "table", "tbody", "tr", "td", "div", "ul", "svg"})
    EXPECT_EQ(count("<" + tag + ">") + count("<" + tag + " "), count("</" + tag + ">")) << tag;
  EXPECT_EQ(count("<details"), 13u);
}

}  // namespace
}  // namespace quadrille::explain
