// The shader on OpenGL against the same formulas in double: every number within what GLSL's precision allows.
#include "tb/studies/shader/shader_engine.hpp"
#include "golden/reference/paper_float.hpp"
#include "golden/reference/port_number.hpp"
#include "golden/reference/truth.hpp"
#include "golden/scenes/scenes.hpp"
#include "tb/engines/engine.hpp"
#include "tb/studies/shader/fp32_bound.hpp"
#include "tb/studies/shader/quad_shader.hpp"
#include "tb/support/environment_error.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <tuple>

namespace quadrille::tb {
namespace {

/// What the formulas of section 4.2 may lose in fp32 at one pixel of a snapped quad.
struct Tolerance {
  std::array<double, 4> lambda{};
  double z = 0;
  std::array<double, max_attribute_slots> attribute{};
  bool certain = false;  ///< whether the signs are those of a pixel inside is beyond doubt in fp32
};

Tolerance tolerance(const SnappedQuad& quad, const Config& config, const DrawState& state, int x, int y) {
  const auto next = [](std::size_t i) { return (i + 1) % 4; };
  const auto number = [&](std::int32_t v) { return rounded(std::ldexp(static_cast<double>(v), -config.frac())); };
  const auto port = [&](const PortNumber& v) { return rounded(golden::port_value(v, config.significand_bits)); };
  std::array<Bounded, 4> sx, sy, r, t, mu, lambda, inverse_w, over_w, term;
  for (std::size_t i = 0; i < 4; ++i) {
    const SnappedVertex& v = quad.vertex[i];
    const Bounded w = number(v.w);
    sx[i] = number(v.x) / w - Bounded{static_cast<double>(x), 0};
    sy[i] = number(v.y) / w - Bounded{static_cast<double>(y), 0};
    inverse_w[i] = port(v.k) / w;
    r[i] = root(sx[i] * sx[i] + sy[i] * sy[i]);
    if (v.w < 0) r[i].value = -r[i].value;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = next(i);
    t[i] = (r[i] * r[j] - (sx[i] * sx[j] + sy[i] * sy[j])) / (sx[i] * sy[j] - sy[i] * sx[j]);
  }
  for (std::size_t i = 0; i < 4; ++i) mu[i] = (t[(i + 3) % 4] + t[i]) / r[i];
  const Bounded sum_mu = sum(mu);
  for (std::size_t i = 0; i < 4; ++i) lambda[i] = mu[i] / sum_mu;
  for (std::size_t i = 0; i < 4; ++i) over_w[i] = lambda[i] * inverse_w[i];
  const Bounded sum_over_w = sum(over_w);

  Tolerance result;
  bool inside = sum_over_w.value > sum_over_w.error, outside = sum_over_w.value < -sum_over_w.error;
  for (std::size_t i = 0; i < 4; ++i) {
    inside = inside && over_w[i].value > over_w[i].error;
    outside = outside || over_w[i].value < -over_w[i].error;
    result.lambda[i] = higher_orders * (state.perspective ? over_w[i] / sum_over_w : lambda[i]).error;
    const double w = std::ldexp(static_cast<double>(quad.vertex[i].w), -config.frac());
    const double z = golden::port_value(quad.vertex[i].z, config.significand_bits) +
                     w * std::ldexp(quad.base.depth, -config.depth_bits);
    term[i] = lambda[i] * (rounded(z) / number(quad.vertex[i].w));
  }
  result.certain = inside || outside;
  result.z = higher_orders * sum(term).error;
  for (std::size_t a = 0; a < static_cast<std::size_t>(state.attributes); ++a) {
    for (std::size_t i = 0; i < 4; ++i) {
      const SnappedVertex& v = quad.vertex[i];
      const double k = state.perspective ? golden::port_value(v.k, config.significand_bits)
                                         : std::ldexp(static_cast<double>(v.w), -config.frac());
      const double base = std::ldexp(static_cast<double>(quad.base.attribute[a]), -config.attribute_frac());
      const double above = i == 0 ? 0 : golden::port_value(v.attribute[a], config.significand_bits);
      term[i] = lambda[i] * (rounded(above + k * base) / number(v.w));
    }
    const Bounded mean = sum(term);
    result.attribute[a] = higher_orders * (state.perspective ? mean / sum_over_w : mean).error;
  }
  return result;
}

struct Agreement {
  std::uint64_t compared = 0, wrong = 0, undefined = 0;
  std::uint64_t only_float = 0, only_shader = 0;  ///< pixels that one of the two draws
  std::uint64_t far_apart = 0;                    ///< of these, those away from every edge where fp32 is certain
  double worst = 0;                               ///< error of a weight over its tolerance
  std::string first;                              ///< of what is wrong
};

constexpr int size = 96;
constexpr int attributes = 3;

DrawState draw_state(bool perspective) {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = size;
  state.attributes = attributes;
  state.perspective = perspective;
  return state;
}

/// The least distance of a pixel centre from the lines of the edges and the diagonal, in pixels.
double distance(const SnappedQuad& quad, int x, int y) {
  double least = INFINITY;
  for (const auto& [i, j] : {std::pair<std::size_t, std::size_t>{0, 1}, {1, 2}, {2, 3}, {3, 0}, {2, 0}}) {
    const SnappedVertex &a = quad.vertex[i], &b = quad.vertex[j];
    const double ax = a.x, ay = a.y, aw = a.w, bx = b.x, by = b.y, bw = b.w;
    // The line through both as a x + b y + c = 0.
    const double nx = ay * bw - by * aw, ny = aw * bx - bw * ax, c = ax * by - bx * ay;
    least = std::min(least, std::fabs(nx * x + ny * y + c) / std::hypot(nx, ny));
  }
  return least;
}

/// Draws a scene by both, quad by quad.
Agreement compare(const std::string& name, QuadShader& shader, const DrawState& state) {
  const Config config;
  Agreement result;
  for (WindowQuad quad : golden::scene_quads(golden::make_scene(name), size, size)) {
    for (std::size_t v = 0; v < 4; ++v)
      quad.attribute[v] = {1.0 - quad.attribute[v][0], 0.25 * static_cast<double>(v), 1.5};
    const SnappedQuad snapped = snap_as(quad, 0, config, state);
    const golden::PaperFp64Quad paper(snapped, config, state);
    ShaderQuads quads(attributes);
    quads.add(snapped, config, state.perspective);
    // One pixel more than the exact rule has; everywhere with vertices that are far or behind the eye.
    const bool near = std::ranges::all_of(
        snapped.vertex, [&](const SnappedVertex& v) { return v.w == std::int32_t{1} << config.frac(); });
    const golden::PixelRect bounds =
        near ? golden::TruthQuad(snapped, config, state).bounds() : golden::scissor_of(state);
    if (bounds.empty()) continue;
    const ShaderRect rect{std::max(0, bounds.x0 - 1), std::max(0, bounds.y0 - 1), std::min(size, bounds.x1 + 1),
                          std::min(size, bounds.y1 + 1)};
    shader.load(quads);
    shader.clear(rect);
    shader.draw(0, 1);
    const auto pixels = shader.read(rect);
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x) {
        const ShaderPixel& actual = pixels[static_cast<std::size_t>((y - rect.y0) * (rect.x1 - rect.x0) + x - rect.x0)];
        const golden::ReferenceSample expected = paper.sample(x, y);
        if (expected.covered && expected.undefined) {
          ++result.undefined;
          continue;
        }
        const bool drawn =
            expected.covered && expected.visible && expected.z >= state.znear && expected.z <= state.zfar;
        if (!drawn && !actual.drawn) continue;
        const Tolerance allowed = tolerance(snapped, config, state, x, y);
        if (drawn != actual.drawn) {
          ++(drawn ? result.only_float : result.only_shader);
          // OpenGL moves corners to its own grid of 1/256 pixel, clipped ones too, and edges with them.
          const bool at_end = expected.covered && (std::fabs(expected.z - state.znear) <= allowed.z ||
                                                   std::fabs(expected.z - state.zfar) <= allowed.z);
          if (distance(snapped, x, y) > 1.0 / 128 && allowed.certain && !at_end && result.far_apart++ == 0)
            result.first =
                "pixel " + std::to_string(x) + ", " + std::to_string(y) + ": only " + (drawn ? "float" : "the shader");
          continue;
        }
        ++result.compared;
        double excess = 0;
        const auto judge = [&](double a, double e, double tolerated) {
          const double error = std::fabs(a - e);
          if (!(error <= tolerated)) excess = std::max(excess, std::isfinite(error) ? error : INFINITY);
        };
        for (std::size_t i = 0; i < 4; ++i) {
          judge(actual.lambda[i], expected.lambda[i], allowed.lambda[i]);
          result.worst = std::max(result.worst, std::fabs(actual.lambda[i] - expected.lambda[i]) / allowed.lambda[i]);
        }
        judge(actual.z, expected.z, allowed.z);
        for (std::size_t a = 0; a < attributes; ++a)
          judge(actual.attribute[a], expected.attribute[a], allowed.attribute[a]);
        if (excess == 0 && actual.front == expected.front) continue;
        if (result.wrong++ == 0)
          result.first = "pixel " + std::to_string(x) + ", " + std::to_string(y) + ": off by " + std::to_string(excess);
      }
    }
  }
  return result;
}

/// The papers' figures of few quads.
std::vector<std::string> figures() {
  std::vector<std::string> names;
  for (const golden::SceneInfo& scene : golden::list_scenes())
    if (golden::make_scene(scene.name).mesh.faces.size() <= 300) names.push_back(scene.name);
  return names;
}

TEST(Shader, WithoutOpenGlSaysWhatIsMissing) {
  if (QuadShader::in_build()) GTEST_SKIP() << "in this build";
  EngineSettings settings;
  settings.kind = EngineKind::shader;
  try {
    make_shader_engine(settings);
    FAIL() << "an engine without OpenGL";
  } catch (const EnvironmentError& error) {
    EXPECT_NE(std::string(error.what()).find("libepoxy-dev"), std::string::npos) << error.what();
  }
}

class OpenGl : public testing::Test {
 protected:
  void SetUp() override {
    if (!QuadShader::in_build()) GTEST_SKIP() << "the engine shader is not in this build";
  }
};

TEST_F(OpenGl, TheShaderAgreesWithTheFormulasInDouble) {
  Agreement all;
  for (const bool perspective : {true, false}) {
    const DrawState state = draw_state(perspective);
    QuadShader shader({.state = state, .weights = true});
    for (const std::string& name : figures()) {
      const Agreement one = compare(name, shader, state);
      EXPECT_EQ(one.wrong, 0u) << name << ": " << one.first;
      EXPECT_EQ(one.far_apart, 0u) << name << ": " << one.first;
      all.compared += one.compared;
      all.only_float += one.only_float;
      all.only_shader += one.only_shader;
      all.worst = std::max(all.worst, one.worst);
      all.undefined += one.undefined;
    }
  }
  EXPECT_GT(all.compared, 100'000u);
}

std::string replaced(std::string text, const std::string& search, const std::string& by) {
  const std::size_t place = text.find(search);
  EXPECT_NE(place, std::string::npos) << search;
  return text.replace(place, search.size(), by);
}

using Source = ShaderSource (*)(ShaderSource);

/// Each fault in a scene that shows it.
TEST_F(OpenGl, AWrongShaderDoesNotAgree) {
  const std::map<std::string, std::pair<const char*, Source>> faults{
      {"sign of w",
       {"fig9_a",
        [](ShaderSource s) {
          s.fragment = replaced(s.fragment, "sqrt(sx * sx + sy * sy) * w_sign", "sqrt(sx * sx + sy * sy)");
          return s;
        }}},
      {"neighbour of t",
       {"fig10_convex",
        [](ShaderSource s) {
          s.fragment = replaced(s.fragment, "t.wxyz + t", "t.yzwx + t");
          return s;
        }}},
      {"z by eq. (10)",
       {"fig7_floor",
        [](ShaderSource s) {
          s.fragment = replaced(s.fragment, "sum(m * value[0]) / all", "sum(m * value[0]) / over_w");
          return s;
        }}},
      {"facing",
       {"fig10_crossed",
        [](ShaderSource s) {
          s.fragment = replaced(s.fragment, "facing < 0.0", "facing > 0.0");
          return s;
        }}},
      {"centre of the pixel off by 1e-4",
       {"fig10_convex",
        [](ShaderSource s) {
          s.fragment = replaced(s.fragment, "gl_FragCoord.xy - to_centre", "gl_FragCoord.xy - to_centre + 1e-4");
          return s;
        }}},
      {"one of the quad's triangles",
       {"fig1_flat",
        [](ShaderSource s) {
          s.vertex =
              replaced(s.vertex, "  vec4 x = ", "  if ((own & 3) == 2) gl_Position = vec4(0, 0, 0, 1);\n  vec4 x = ");
          return s;
        }}},
      {"nothing killed",
       {"fig10_crossed",
        [](ShaderSource s) {
          s.fragment = replaced(s.fragment, "any(lessThan(m * vk * over_w, vec4(0.0))) || ", "");
          return s;
        }}},
      {"corners of a texture coordinate",
       {"fig7_floor",
        [](ShaderSource s) {
          s.vertex = replaced(s.vertex, "fetch(first + 2, v)[c], fetch(first + 3, v)[c]",
                              "fetch(first + 3, v)[c], fetch(first + 2, v)[c]");
          return s;
        }}},
  };
  for (const auto& [what, fault] : faults) {
    const DrawState state = draw_state(true);
    QuadShader shader({.state = state,
                       .weights = true,
                       .source = fault.second(quad_shader_source({.attributes = attributes, .weights = true}))});
    const Agreement found = compare(fault.first, shader, state);
    EXPECT_GT(found.wrong + found.far_apart, 10u) << what;
  }
}

/// The engine hands out every fragment of overlapping quads, in order, as read(): two quads in one place.
TEST_F(OpenGl, TheEngineGivesEveryFragmentOfEveryQuad) {
  EngineSettings settings;
  settings.state.width = settings.state.height = settings.state.scissor_x1 = settings.state.scissor_y1 = 32;
  settings.state.scissor_x0 = 5;
  std::vector<WindowQuad> quads(2);
  for (std::uint32_t i = 0; i < 2; ++i) {
    quads[i].id = 7 + i;
    quads[i].vertex = {{{2, 3, 0.25, 1}, {20, 3, 0.25, 1}, {20, 13, 0.25, 1}, {2, 13, 0.25, 1}}};
    for (std::size_t v = 0; v < 4; ++v)
      quads[i].attribute[v] = {v == 1 || v == 2 ? 1.0 : 0.0, v > 1 ? 1.0 : 0.0, 3, 4, 5};
  }
  quads[1].vertex = {{quads[0].vertex[0], quads[0].vertex[3], quads[0].vertex[2], quads[0].vertex[1]}};
  for (const bool snap : {true, false}) {
    std::vector<EngineSample> samples;
    settings.kind = EngineKind::shader;
    settings.snap = snap;
    make_shader_engine(settings)->draw(quads, 5, true, [&](std::span<const EngineSample> some) {
      samples.insert(samples.end(), some.begin(), some.end());
    });
    ASSERT_EQ(samples.size(), 2u * 15 * 10);
    std::set<std::tuple<int, int, int>> places;
    for (const EngineSample& s : samples) {
      places.insert({static_cast<int>(s.index), s.x, s.y});
      EXPECT_EQ(s.quad, 7 + s.index);
      EXPECT_EQ(s.front, s.index == 1);  // 0 goes clockwise on the screen
      EXPECT_FALSE(s.undefined);
      EXPECT_NEAR(s.z, 0.25, 1e-6);
      EXPECT_NEAR(s.attribute[0], s.lambda[1] + s.lambda[2], 1e-5);
      if (s.index == 0) {
        EXPECT_NEAR(s.attribute[1], s.lambda[2] + s.lambda[3], 1e-5);
      }
      EXPECT_NEAR(s.attribute[2], 3, 1e-5);
      EXPECT_NEAR(s.attribute[3], 4, 1e-5);
      EXPECT_NEAR(s.attribute[4], 5, 1e-5);
    }
    EXPECT_EQ(places.size(), samples.size());
  }

  settings.state.cull = Cull::back;
  std::size_t drawn = 0;
  make_shader_engine(settings)->draw(quads, 0, false, [&](std::span<const EngineSample> some) {
    for (const EngineSample& s : some) drawn += s.front ? 1 : 1000;
  });
  EXPECT_EQ(drawn, 150u);
  settings.state.znear = 0.5;
  make_shader_engine(settings)->draw(quads, 0, false,
                                     [&](std::span<const EngineSample>) { FAIL() << "nearer than znear"; });
}

}  // namespace
}  // namespace quadrille::tb
