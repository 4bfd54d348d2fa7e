// Method hybrid: two triangles whose fragment program computes mean value coordinates in single precision, as published
// (Hormann & Tarini 2004, section 5.1; Bloomenthal 2022, listings 1 and 2). The formulas, the order of operations and
// every weakness are theirs. Only the weights are: what a caller makes of them, sum(lambda_i a_i), is in double, where
// the listing sums in single precision too, so that the listing's own values are off by an ulp or so more.
#include "golden/methods/builders.hpp"
#include "golden/methods/homogeneous.hpp"
#include "golden/reference/paper_float.hpp"

#include <cmath>

namespace quadrille::golden::methods {
namespace {

bool in_ndc(HybridForm form) { return form == HybridForm::ndc || form == HybridForm::bloomenthal; }
bool kills(HybridForm form) { return form != HybridForm::bloomenthal; }
bool guards(HybridForm form) { return form != HybridForm::tarini; }

float sign(float v) { return static_cast<float>((v > 0) - (v < 0)); }  // as GLSL's

/// What the fragment program of one quad sees, and what it does. All in binary32, rounded to nearest after every
/// operation; GLSL's length() is taken as sqrt(x x + y y).
class FragmentProgram {
 public:
  FragmentProgram(const std::array<WindowVertex, 4>& vertex, const View& view, HybridForm form)
      : form_(form), width_(static_cast<float>(view.width)), height_(static_cast<float>(view.height)) {
    for (std::size_t i = 0; i < 4; ++i) {
      const WindowVertex& p = vertex[i];
      w_[i] = static_cast<float>(p.w);
      if (in_ndc(form)) {
        // gl_Position: clip coordinates, y up; v_i is divided in the program.
        x_[i] = static_cast<float>(2 * p.x / view.width - p.w) / w_[i];
        y_[i] = static_cast<float>(p.w - 2 * p.y / view.height) / w_[i];
      } else {
        x_[i] = static_cast<float>(p.x) / w_[i];
        y_[i] = static_cast<float>(p.y) / w_[i];
      }
      z_[i] = static_cast<float>(p.z) / w_[i];
    }
  }

  /// Appends what becomes of a triangle's fragment: a sample, an undefined sample, or nothing where it is killed.
  void run(const TrianglePixel& pixel, bool perspective, std::vector<MethodSample>& out) const {
    const std::array<float, 4> weight = barycentric_weights(pixel.x, pixel.y);
    // Eq. (10). Inside the quad these have one sign whatever the signs of w; those of eq. (7) have not.
    std::array<float, 4> f{};
    for (std::size_t i = 0; i < 4; ++i) f[i] = weight[i] / w_[i];
    // In GLSL: if (any(lessThan(f, vec4(0))) && any(greaterThan(f, vec4(0)))) discard; a NaN is neither.
    if (kills(form_) && std::ranges::any_of(f, [](float v) { return v < 0; }) &&
        std::ranges::any_of(f, [](float v) { return v > 0; }))
      return;

    const float sum = f[0] + f[1] + f[2] + f[3];
    MethodSample sample{pixel.x, pixel.y, pixel.front, false, depth(weight, pixel), {}};
    bool finite = std::isfinite(sample.z);
    for (std::size_t i = 0; i < 4; ++i) {
      sample.lambda[i] = static_cast<double>(perspective ? f[i] / sum : weight[i]);
      finite = finite && std::isfinite(sample.lambda[i]);
    }
    out.push_back(finite ? sample : undefined_sample(pixel.x, pixel.y, pixel.front));
  }

 private:
  /// BarycentricWeights() of the listing: eq. (7).
  std::array<float, 4> barycentric_weights(int x, int y) const {
    // gl_FragCoord, y up in NDC; in pixels y down as the vertices.
    float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
    if (in_ndc(form_)) {
      px = 2 * (px - 0) / width_ - 1;
      py = 2 * ((height_ - py) - 0) / height_ - 1;
    }
    std::array<float, 4> sx{}, sy{}, signs{};
    for (std::size_t i = 0; i < 4; ++i) {
      sx[i] = x_[i] - px;
      sy[i] = y_[i] - py;
      signs[i] = sign(w_[i]);
    }
    std::array<float, 4> u = PaperWeights<float>(sx, sy, signs, guards(form_) ? 1e-6f : 0).mu;
    const float sum = u[0] + u[1] + u[2] + u[3];
    for (float& v : u) v /= sum;
    return u;
  }

  /// Eq. (4) where the program writes the depth; Bloomenthal's leaves the rasterizer's.
  double depth(const std::array<float, 4>& weight, const TrianglePixel& pixel) const {
    if (in_ndc(form_)) return pixel.z;
    return static_cast<double>(weight[0] * z_[0] + weight[1] * z_[1] + weight[2] * z_[2] + weight[3] * z_[3]);
  }

  HybridForm form_;
  float width_, height_;
  std::array<float, 4> x_{}, y_{}, z_{}, w_{};  ///< v_i and z_i of eq. (1), w_i
};

class Hybrid final : public Method {
 public:
  explicit Hybrid(HybridForm form) : form_(form) {}

  std::string name() const override {
    switch (form_) {
      case HybridForm::pixels:
        return "hybrid:pixels";
      case HybridForm::ndc:
        return "hybrid:ndc";
      case HybridForm::tarini:
        return "hybrid:tarini";
      case HybridForm::bloomenthal:
        return "hybrid:bloomenthal";
    }
    return "hybrid";
  }

  void draw(const Quad& quad, const View& view, std::vector<MethodSample>& out) const override {
    const FragmentProgram program(quad.vertex, view, form_);
    for (const auto& [a, b, c] : triangles()) {
      raster_triangle({quad.vertex[a], quad.vertex[b], quad.vertex[c]}, view,
                      [&](const TrianglePixel& pixel) { program.run(pixel, view.perspective, out); });
    }
  }

  Census census(std::span<const Quad> quads, const View&) const override {
    return {.quads = quads.size(), .emitted_quads = quads.size(), .triangles = 2 * quads.size()};
  }

  std::vector<std::vector<WindowVertex>> wireframe(const Quad& quad, const View&) const override {
    std::vector<std::vector<WindowVertex>> outline;
    for (const auto& [a, b, c] : triangles()) outline.push_back({quad.vertex[a], quad.vertex[b], quad.vertex[c]});
    return outline;
  }

 private:
  std::array<std::array<std::size_t, 3>, 2> triangles() const {
    if (in_ndc(form_)) return {{{0, 1, 3}, {1, 2, 3}}};  // listing 1
    return {{{0, 1, 2}, {0, 2, 3}}};
  }

  HybridForm form_;
};

}  // namespace

std::unique_ptr<Method> make_hybrid(HybridForm form) { return std::make_unique<Hybrid>(form); }

}  // namespace quadrille::golden::methods
