#include "tb/studies/peer_errors.hpp"

#include "golden/reference/truth.hpp"
#include "model/port/snap.hpp"
#include "tb/engines/engine.hpp"
#include "tb/passes/pass.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace quadrille::tb {
namespace {

constexpr std::size_t least_quads = 16;
constexpr int weights = 4;

DrawState weights_state(int width, int height) {
  DrawState state;
  state.width = state.scissor_x1 = width;
  state.height = state.scissor_y1 = height;
  state.attributes = weights;
  return state;
}

/// What the truth draws of a rectangle; without a value where it draws nothing.
std::vector<std::optional<golden::ReferenceSample>> truth_of(const golden::TruthQuad& truth, const ShaderRect& rect,
                                                             const DrawState& state) {
  std::vector<std::optional<golden::ReferenceSample>> samples;
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x) {
      samples.emplace_back();
      const golden::Coverage coverage = truth.cover(x, y);
      if (!coverage.covered || !coverage.visible) continue;
      const golden::ReferenceSample sample = truth.sample(x, y);
      if (!state.depth || (sample.z >= state.znear && sample.z <= state.zfar)) samples.back() = sample;
    }
  return samples;
}

void judge(const ShaderPixel& pixel, const golden::ReferenceSample& sample, FormErrors& errors) {
  if (!pixel.drawn) {
    ++errors.missing;
    return;
  }
  double weight = 0, sum = pixel.z;
  for (std::size_t i = 0; i < weights; ++i) {
    weight = std::max(weight, std::fabs(pixel.attribute[i] - sample.lambda[i]));
    sum += pixel.attribute[i];
  }
  if (!std::isfinite(sum)) {
    ++errors.undefined;
    return;
  }
  errors.weight = std::max(errors.weight, weight);
  errors.depth = std::max(errors.depth, std::fabs(pixel.z - sample.z));
}

}  // namespace

double determinant_condition(const SnappedQuad& quad, const Config& config, int x, int y) {
  using Vector = std::array<long double, 3>;
  std::array<Vector, 4> v;
  std::array<long double, 4> r, n{}, m{};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto number = [&](std::int32_t value) { return std::ldexp(static_cast<long double>(value), -config.frac()); };
    const SnappedVertex& vertex = quad.vertex[i];
    v[i] = {number(vertex.x) - number(vertex.w) * x, number(vertex.y) - number(vertex.w) * y, number(vertex.w)};
    r[i] = std::hypot(v[i][0], v[i][1]);
  }
  const auto cross = [&](std::size_t i, std::size_t j) { return v[i][0] * v[j][1] - v[i][1] * v[j][0]; };
  const auto det = [&](std::size_t i, std::size_t j, std::size_t k) {
    return v[i][2] * cross(j, k) - v[j][2] * cross(i, k) + v[k][2] * cross(i, j);
  };
  n = {det(1, 2, 3), -det(0, 2, 3), det(0, 1, 3), -det(0, 1, 2)};
  // The cofactors of the rows (-1)^i R, x, y.
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t a = (i + 1) % 4, b = (i + 2) % 4, c = (i + 3) % 4;
    m[i] = r[a] * cross(b, c) + r[b] * cross(a, c) + r[c] * cross(a, b);
  }
  long double largest = 0, sum = 0, all = 0, share = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    largest = std::max(largest, std::fabs(n[i]));
    sum += (i % 2 == 0 ? r[i] : -r[i]) * n[i];
    all += m[i] * v[i][2];
    share += r[i] * std::fabs(m[i]);
  }
  return static_cast<double>(largest * share / std::fabs(all * sum));
}

PeerErrorBench::PeerErrorBench(const Config& config, int width, int height)
    : state_(weights_state(width, height)), config_(snapping_config(config, weights)), shader_({.state = state_}) {}

PeerErrors PeerErrorBench::errors(std::span<const WindowQuad> quads, std::uint64_t least) {
  PeerErrors result;
  const Pass pass = plan_passes(0, true, weights).front();
  for (const WindowQuad& quad : quads) {
    if (result.pixels >= least && result.quads >= least_quads) break;
    ++result.quads;
    const SnappedQuad snapped = snap_as(pass_quad(quad, pass), 0, config_, state_);
    const golden::TruthQuad truth(snapped, config_, state_);
    const golden::PixelRect& b = truth.bounds();
    if (b.empty()) continue;
    const ShaderRect rect{b.x0, b.y0, b.x1, b.y1};
    const auto samples = truth_of(truth, rect, state_);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (!samples[i]) continue;
      ++result.pixels;
      const int place = static_cast<int>(i), width = rect.x1 - rect.x0;
      const double condition =
          determinant_condition(snapped, config_, rect.x0 + place % width, rect.y0 + place / width);
      if (std::isfinite(condition)) result.condition = std::max(result.condition, condition);
    }
    ShaderQuads vertices(weights);
    vertices.add(snapped, config_);
    shader_.load(vertices);
    for (const ShaderFormInfo& info : shader_forms) {
      if (!info.mean_value) continue;
      shader_.choose(info.form, Triangles::split_012_023);
      shader_.clear(rect);
      shader_.draw(0, 1);
      const auto pixels = shader_.read(rect);
      for (std::size_t i = 0; i < samples.size(); ++i)
        if (samples[i]) judge(pixels[i], *samples[i], result.forms[static_cast<std::size_t>(info.form)]);
    }
  }
  return result;
}

}  // namespace quadrille::tb
