// The forms of the weights against the truth, within what fp32 may lose; and where the printed form is not finite.
#include "golden/reference/port_number.hpp"
#include "golden/reference/truth.hpp"
#include "golden/scenes/scenes.hpp"
#include "tb/engines/engine.hpp"
#include "tb/studies/shader/fp32_bound.hpp"
#include "tb/studies/shader/quad_shader.hpp"

#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

namespace quadrille::tb {
namespace {

constexpr int size = 96;

DrawState draw_state(int attributes = 0) {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = size;
  state.attributes = attributes;
  return state;
}

using Corners = std::array<Bounded, 4>;

/// Hypotenuses and edge functions of a form at a pixel; the printed one divides by w before.
struct Geometry {
  Corners x, y, r;

  Bounded cross(std::size_t i, std::size_t j) const { return x[i] * y[j] - y[i] * x[j]; }
  Bounded dot(std::size_t i, std::size_t j) const { return x[i] * x[j] + y[i] * y[j]; }
};

Geometry geometry(const Corners& x, const Corners& y, const Corners& w, double px, double py) {
  Geometry g;
  for (std::size_t i = 0; i < 4; ++i) {
    g.x[i] = x[i] - w[i] * Bounded{px, 0};
    g.y[i] = y[i] - w[i] * Bounded{py, 0};
    g.r[i] = root(g.x[i] * g.x[i] + g.y[i] * g.y[i]);
  }
  return g;
}

/// By tangents.
Corners tangent_weights(const Geometry& g, bool small_a_too) {
  Corners t, m;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    const Bounded a = g.cross(i, j), d = g.dot(i, j), rr = g.r[i] * g.r[j];
    t[i] = small_a_too || d.value < 0 ? (rr - d) / a : a / (rr + d);
  }
  for (std::size_t i = 0; i < 4; ++i) m[i] = (t[(i + 3) % 4] + t[i]) / g.r[i];
  return m;
}

/// M = a - t n of corners relative to a pixel near them.
Corners determinant_weights(const Corners& x, const Corners& y, const Corners& w, double px, double py) {
  const auto det = [&](std::size_t i, std::size_t j, std::size_t k) {
    const Corners terms{
        x[i] * (y[j] * w[k] - w[j] * y[k]), y[i] * (w[j] * x[k] - x[j] * w[k]), w[i] * (x[j] * y[k] - y[j] * x[k]), {}};
    return sum(terms);
  };
  const Bounded minus{-1, 0};
  Corners n{det(1, 2, 3), minus * det(0, 2, 3), det(3, 0, 1), minus * det(2, 0, 1)}, m;
  const std::size_t first = std::fabs(n[1].value) > std::fabs(n[3].value) ? 2 : 0;
  const auto at = [&](std::size_t i) { return (first + i) % 4; };
  const Geometry g = geometry(x, y, w, px, py);
  const Corners a{g.cross(at(1), at(2)), g.cross(at(2), at(0)), g.cross(at(0), at(1)), {}};
  Corners above, below;
  for (std::size_t i = 0; i < 4; ++i) {
    const Bounded r = i % 2 == 0 ? g.r[at(i)] : minus * g.r[at(i)];
    above[i] = r * a[i];
    below[i] = r * n[at(i)];
  }
  const Bounded t = sum(above) / sum(below);
  for (std::size_t i = 0; i < 4; ++i) m[at(i)] = a[i] - t * n[at(i)];
  return m;
}

/// Bounds of the errors of the four weights and of depth.
std::array<double, 5> bounds(ShaderForm form, const SnappedQuad& quad, const Config& config, int px, int py) {
  const auto number = [&](std::int32_t v) { return rounded(std::ldexp(static_cast<double>(v), -config.frac())); };
  const auto port = [&](const PortNumber& v) { return rounded(golden::port_value(v, config.significand_bits)); };
  Corners x, y, w, k, z, m, weight, depth, all;
  for (std::size_t i = 0; i < 4; ++i) {
    const SnappedVertex& v = quad.vertex[i];
    x[i] = number(v.x);
    y[i] = number(v.y);
    w[i] = number(v.w);
    k[i] = port(v.k);
    z[i] = rounded(golden::port_value(v.z, config.significand_bits) +
                   w[i].value * std::ldexp(quad.base.depth, -config.depth_bits));
  }
  if (form == ShaderForm::determinant) {
    const double limit = size;
    const auto near = [&](const Corners& c) {
      return w[0].value > 0 ? std::clamp(std::round(c[0].value / w[0].value), 0.0, limit) : limit / 2;
    };
    const double nx = near(x), ny = near(y);
    for (std::size_t i = 0; i < 4; ++i) {
      x[i] = x[i] - Bounded{nx, 0} * w[i];
      y[i] = y[i] - Bounded{ny, 0} * w[i];
    }
    m = determinant_weights(x, y, w, px - nx, py - ny);
  } else {
    if (form == ShaderForm::printed)
      for (std::size_t i = 0; i < 4; ++i) {
        x[i] = x[i] / w[i];
        y[i] = y[i] / w[i];
        k[i] = k[i] / w[i];
        z[i] = z[i] / w[i];
        w[i] = {w[i].value < 0 ? -1.0 : 1.0, 0};
      }
    Geometry g = geometry(x, y, form == ShaderForm::printed ? Corners{{{1, 0}, {1, 0}, {1, 0}, {1, 0}}} : w, px, py);
    if (form == ShaderForm::printed)
      for (std::size_t i = 0; i < 4; ++i) g.r[i].value *= w[i].value;
    m = tangent_weights(g, form == ShaderForm::printed);
    if (form == ShaderForm::printed) w = {{{1, 0}, {1, 0}, {1, 0}, {1, 0}}};
  }
  if (form == ShaderForm::printed) {
    const Bounded sum_mu = sum(m);
    for (Bounded& mu : m) mu = mu / sum_mu;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    weight[i] = m[i] * k[i];
    depth[i] = m[i] * z[i];
    all[i] = m[i] * w[i];
  }
  std::array<double, 5> result{};
  for (std::size_t i = 0; i < 4; ++i) result[i] = higher_orders * (weight[i] / sum(weight)).error;
  result[4] = higher_orders * (sum(depth) / sum(all)).error;
  return result;
}

struct Agreement {
  std::uint64_t compared = 0, wrong = 0, undefined = 0, without_bound = 0;
};

void compare(const WindowQuad& quad, ShaderForm form, QuadShader& shader, Agreement& result) {
  const Config config;
  const SnappedQuad snapped = snap_as(quad, 0, config, draw_state());
  const golden::TruthQuad truth(snapped, config, draw_state());
  const golden::PixelRect b = truth.bounds();
  if (b.empty()) return;
  ShaderQuads quads(0);
  quads.add(snapped, config);
  shader.load(quads);
  shader.choose(form, Triangles::split_012_023);
  const ShaderRect rect{b.x0, b.y0, b.x1, b.y1};
  shader.clear(rect);
  shader.draw(0, 1);
  const auto pixels = shader.read(rect);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const int x = b.x0 + static_cast<int>(i) % (b.x1 - b.x0), y = b.y0 + static_cast<int>(i) / (b.x1 - b.x0);
    const golden::ReferenceSample sample = truth.sample(x, y);
    if (!pixels[i].drawn || !sample.covered || !sample.visible) continue;
    ++result.compared;
    const auto bound = bounds(form, snapped, config, x, y);
    bool right = true, finite = true, bounded = true;
    for (std::size_t c = 0; c < 5; ++c) {
      const double error = c == 4 ? pixels[i].z - sample.z : pixels[i].lambda[c] - sample.lambda[c];
      finite = finite && std::isfinite(error);
      bounded = bounded && std::isfinite(bound[c]);
      right = right && !(std::fabs(error) > bound[c]);
    }
    if (!finite) ++result.undefined;
    if (!bounded) ++result.without_bound;
    if (!right) ++result.wrong;
  }
}

/// Quads of the papers' figures with all w > 0 and near the picture.
std::vector<WindowQuad> ordinary_quads() {
  std::vector<WindowQuad> quads;
  const Config config;
  for (const golden::SceneInfo& scene : golden::list_scenes())
    for (const WindowQuad& quad : golden::scene_quads(golden::make_scene(scene.name), size, size)) {
      if (quads.size() > 0 && quad.id > 40) break;
      const SnappedQuad snapped = snap_as(quad, 0, config, draw_state());
      if (std::ranges::all_of(snapped.vertex, [&](const SnappedVertex& v) { return v.w == 1 << config.frac(); }))
        quads.push_back(quad);
    }
  return quads;
}

WindowQuad quad_of(const std::array<WindowVertex, 4>& vertices) {
  WindowQuad quad;
  quad.vertex = vertices;
  for (std::size_t v = 0; v < 4; ++v) quad.attribute[v] = {v == 1 || v == 2 ? 1.0 : 0.0, v > 1 ? 1.0 : 0.0};
  return quad;
}

class ShaderForms : public testing::Test {
 protected:
  void SetUp() override {
    if (!QuadShader::in_build()) GTEST_SKIP() << "the engine shader is not in this build";
  }
};

TEST_F(ShaderForms, AgreeWithTheTruthAsFarAsFp32Allows) {
  QuadShader shader({.state = draw_state(), .weights = true});
  const std::vector<WindowQuad> quads = ordinary_quads();
  for (const ShaderFormInfo& info : shader_forms) {
    if (!info.mean_value) continue;
    Agreement found;
    for (const WindowQuad& quad : quads) compare(quad, info.form, shader, found);
    EXPECT_EQ(found.wrong, 0u) << info.name;
    EXPECT_GT(found.compared, 50'000u) << info.name;
    // The printed form has no bound where A cancels.
    EXPECT_LT(found.without_bound, found.compared / (info.form == ShaderForm::printed ? 10 : 1000)) << info.name;
  }
}

std::string replaced(std::string text, const std::string& search, const std::string& by) {
  const std::size_t place = text.find(search);
  EXPECT_NE(place, std::string::npos) << search;
  return place == std::string::npos ? text : text.replace(place, search.size(), by);
}

TEST_F(ShaderForms, AWrongFormDoesNot) {
  const std::vector<WindowQuad> quads = ordinary_quads();
  for (const auto& [form, search, by] : std::vector<std::tuple<ShaderForm, const char*, const char*>>{
           {ShaderForm::printed, "product - inner", "product - 0.9999 * inner"},
           {ShaderForm::no_small_a, "product + inner", "product + 0.9999 * inner"},
           {ShaderForm::no_small_a, "lessThan(inner", "greaterThan(inner"},
           {ShaderForm::determinant, "r.x * a.x - r.y", "r.x * a.x - 0.9999 * r.y"},
           {ShaderForm::determinant, "result.a - result.t * n", "result.a - 0.9999 * result.t * n"}}) {
    ShaderSource source = quad_shader_source({.form = form, .weights = true});
    source.fragment = replaced(source.fragment, search, by);
    QuadShader shader({.state = draw_state(), .weights = true, .form = form, .source = source});
    Agreement found;
    for (const WindowQuad& quad : quads) compare(quad, form, shader, found);
    EXPECT_GT(found.wrong + found.undefined, 1000u) << search;
  }
}

/// A corner at infinity, and corners behind the eye: the determinant form is as good as elsewhere.
TEST_F(ShaderForms, DeterminantTakesWOfAnySign) {
  const std::array<WindowQuad, 3> quads{
      quad_of({{{20, 20, 0.5, 1}, {60, 15, 0.5, 1}, {50, 60, 0.5, 1}, {-20, 30, 0.2, 0}}}),
      quad_of({{{20, 20, 0.5, 1}, {60, 15, 0.5, 1}, {50, 60, 0.5, 1}, {-40, -60, -0.1, -0.5}}}),
      quad_of({{{20, 20, 0.5, 1}, {60, 15, 0.5, 1}, {-30, -80, -0.2, -0.5}, {-40, -60, -0.1, -0.5}}})};
  QuadShader shader({.state = draw_state(), .weights = true});
  for (const WindowQuad& quad : quads) {
    Agreement determinant, printed;
    compare(quad, ShaderForm::determinant, shader, determinant);
    compare(quad, ShaderForm::printed, shader, printed);
    EXPECT_GT(determinant.compared, 500u);
    EXPECT_EQ(determinant.wrong + determinant.undefined + determinant.without_bound, 0u);
    EXPECT_EQ(printed.undefined, quad.vertex[3].w == 0 ? printed.compared : 0u);
  }
}

/// Corners at pixel centres, so that pixels lie on edges and at corners, where values are known without any form.
TEST_F(ShaderForms, DeterminantIsFiniteOnEdgesAndAtCorners) {
  const WindowQuad quad =
      quad_of({{{2.5, 3.5, 0.25, 1}, {42.5, 3.5, 0.25, 1}, {32.5, 43.5, 0.25, 1}, {2.5, 23.5, 0.25, 1}}});
  const DrawState state = draw_state(2);
  const Config config;
  ShaderQuads quads(2);
  quads.add(snap_as(quad, 0, config, state), config);
  QuadShader shader({.state = state, .picture = true});
  shader.load(quads);
  for (const ShaderFormInfo& info : shader_forms) {
    for (const Triangles triangles : {Triangles::split_013_123, Triangles::split_012_023}) {
      shader.choose(info.form, triangles);
      shader.draw_picture();
      const auto pixels = shader.read({0, 0, size, size});
      int drawn = 0, wrong = 0;
      double worst = 0;
      const auto judge = [&](int x, int y, double u, double v) {
        const ShaderPixel& pixel = pixels[static_cast<std::size_t>(y * size + x)];
        if (!pixel.drawn) return;
        ++drawn;
        const double error = std::max(std::fabs(pixel.attribute[0] - u), std::fabs(pixel.attribute[1] - v));
        worst = std::max(worst, error);
        wrong += error > 0.01 ? 1 : 0;
      };
      // The top and the left edge belong to the quad, the right and the lower one do not.
      for (int x = 2; x < 42; ++x) judge(x, 3, (x - 2) / 40.0, 0);
      for (int y = 4; y < 23; ++y) judge(2, y, 0, (y - 3) / 20.0);
      if (info.form == ShaderForm::determinant || info.form == ShaderForm::bilinear) {
        EXPECT_EQ(drawn, 59) << info.name;
        EXPECT_LT(worst, 0x1p-20) << info.name;
      } else {  // what is not finite fails the depth test
        EXPECT_LT(drawn, 59) << info.name;
      }
      if (info.form == ShaderForm::printed) {
        EXPECT_GT(wrong, 50);  // the guard takes the edge for its line outside
      }
    }
  }
}

/// The weights of bilinear interpolation are those of u and v: w0 w2 = w1 w3, and they reproduce the pixel.
TEST_F(ShaderForms, BilinearWeightsAreBilinear) {
  const std::array<std::array<double, 2>, 4> corner{{{10, 12}, {80, 20}, {70, 75}, {15, 60}}};
  std::array<WindowVertex, 4> vertices;
  for (std::size_t i = 0; i < 4; ++i) vertices[i] = {corner[i][0] + 0.5, corner[i][1] + 0.5, 0.5, 1};
  const Config config;
  ShaderQuads quads(0);
  quads.add(snap_as(quad_of(vertices), 0, config, draw_state()), config);
  QuadShader shader({.state = draw_state(), .weights = true, .form = ShaderForm::bilinear});
  shader.load(quads);
  shader.clear({0, 0, size, size});
  shader.draw(0, 1);
  const auto pixels = shader.read({0, 0, size, size});
  int drawn = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!pixels[i].drawn) continue;
    ++drawn;
    const auto& w = pixels[i].lambda;
    double x = 0, y = 0, all = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      x += w[c] * corner[c][0];
      y += w[c] * corner[c][1];
      all += w[c];
    }
    // Some fifty operations of half an ulp, of numbers up to 1 and up to the picture's side.
    constexpr double tolerance = 50 * unit;
    EXPECT_NEAR(w[0] * w[2], w[1] * w[3], tolerance);
    EXPECT_NEAR(all, 1, tolerance);
    EXPECT_NEAR(x, static_cast<double>(i % size), size * tolerance);
    EXPECT_NEAR(y, static_cast<double>(i / size), size * tolerance);
  }
  EXPECT_GT(drawn, 2000);
}

}  // namespace
}  // namespace quadrille::tb
