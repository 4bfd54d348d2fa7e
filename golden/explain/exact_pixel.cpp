#include "golden/explain/exact_pixel.hpp"

#include "golden/reference/port_number.hpp"
#include "golden/reference/rsqrt.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#if __LDBL_MANT_DIG__ != 113
// Of GCC's libquadmath; Clang does not find its header.
extern "C" int quadmath_snprintf(char* text, std::size_t size, const char* format, ...);
#endif

namespace quadrille::explain {

Float113 scaled(Float113 v, int exponent) {
  // Powers of two within the range of a double at a time.
  for (; exponent > 1000; exponent -= 1000) v *= std::ldexp(1.0, 1000);
  for (; exponent < -1000; exponent += 1000) v *= std::ldexp(1.0, -1000);
  return v * std::ldexp(1.0, exponent);
}

int exponent_of(Float113 v) {
  // Rounded to long double a number may reach the next power of two.
  const int exponent = std::ilogb(static_cast<long double>(v));
  return magnitude(v) < scaled(1, exponent) ? exponent - 1 : exponent;
}

std::string decimal(Float113 v, int digits) {
  char text[80];
#if __LDBL_MANT_DIG__ == 113
  std::snprintf(text, sizeof text, "%.*Lg", digits, v);
#else
  quadmath_snprintf(text, sizeof text, "%.*Qg", digits, v);
#endif
  return text;
}

ExactView::ExactView(const SnappedQuad& quad, int x, int y) {
  for (std::size_t i = 0; i < 4; ++i) {
    const SnappedVertex& v = quad.vertex[i];
    w_[i] = v.w;
    x_[i] = v.x - w_[i] * x;
    y_[i] = v.y - w_[i] * y;
  }
}

ExactForm ExactView::linear(std::size_t pair) const {
  const auto [i, j] = vertex_pair[pair];
  return {x_[i] * y_[j] - y_[i] * x_[j], y_[i] * w_[j] - w_[i] * y_[j], w_[i] * x_[j] - x_[i] * w_[j], 0};
}

ExactForm ExactView::quadratic(std::size_t k) const {
  const std::size_t i = k < linear_count ? vertex_pair[k][0] : k - linear_count,
                    j = k < linear_count ? vertex_pair[k][1] : k - linear_count;
  return {x_[i] * x_[j] + y_[i] * y_[j], -(x_[i] * w_[j] + w_[i] * x_[j]), -(y_[i] * w_[j] + w_[i] * y_[j]),
          w_[i] * w_[j]};
}

__int128 ExactView::squared_length(std::size_t pair) const {
  const auto [i, j] = vertex_pair[pair];
  const __int128 x = x_[i] - x_[j], y = y_[i] - y_[j];
  return x * x + y * y;
}

namespace {

/// Of a plane quad: opposite each corner, of the triangle that the pixel is in.
std::array<Float113, 4> areas(const ExactView& view) {
  std::array<Float113, 5> area;
  bool negative = false;
  for (std::size_t k = 0; k < 5; ++k) {
    const __int128 value = view.linear(k).value;
    area[k] = static_cast<Float113>(value < 0 ? -value : value);
    negative = negative || (k < 4 && value < 0);
  }
  if ((view.linear(4).value < 0) != negative) return {area[2], 0, area[3], area[4]};
  return {area[1], area[4], area[0], 0};
}

}  // namespace

ExactPixel::ExactPixel(const SnappedQuad& quad, const golden::TruthQuad& exact, const OnePixel& machine,
                       const PipelineContext& context) {
  const Config& config = context.config;
  const PixelTrace& p = machine.trace;
  const ExactView view(quad, p.x, p.y);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto square = static_cast<Float113>(view.quadratic(linear_count + i).value);
    root[i] = square == 0 ? square : square * golden::rsqrt(square);
  }
  for (std::size_t k = 0; k < linear_count; ++k) {
    const auto [i, j] = vertex_pair[k];
    u[k] = root[i] * root[j] + magnitude(static_cast<Float113>(view.quadratic(k).value));
    v[k] = magnitude(static_cast<Float113>(view.linear(k).value));
  }

  const bool regular = !p.two_corner && !p.on_vertex && !p.two_edge;
  m = machine.data.plane && regular ? areas(view) : exact.homogeneous_weights(p.x, p.y);
  const auto port = [&](const PortNumber& n) { return golden::port_value(n, config.significand_bits); };
  const bool perspective = context.state.perspective;
  std::array<double, 4> w, k;
  Float113 sum = 0, stored = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    w[i] = std::ldexp(quad.vertex[i].w, -config.frac());
    k[i] = perspective ? port(quad.vertex[i].k) : w[i];
    sum += m[i] * std::fabs(k[i]);
    stored += scaled(p.m[i].sig, p.m[i].exp - (config.significand_bits - 1)) * std::fabs(k[i]);
  }
  if (sum != 0)
    for (Float113& weight : m) weight *= stored / sum;

  truth = exact.sample(p.x, p.y, golden::TruthQuad::Effort::all_bits);
  std::array<Float113, 4> part;
  for (std::size_t i = 0; i < 4; ++i) {
    const SnappedVertex& vertex = quad.vertex[i];
    part[i] = m[i] * k[i];
    den_k += part[i];
    den_w += m[i] * w[i];
    num_z += m[i] * port(vertex.z);
    for (std::size_t a = 0; i > 0 && a < num_a.size(); ++a) num_a[a] += m[i] * port(vertex.attribute[a]);
  }
  // It vanishes as an identity, or it does not (truth.hpp); rounding has no say.
  if (truth.visible_margin == 0) den_w = 0;
  if (!perspective) den_k = den_w;
  const auto code = [](auto value, int fraction) { return scaled(static_cast<Float113>(value), -fraction); };
  for (std::size_t a = 0; a < attribute.size(); ++a)
    attribute[a] = code(quad.base.attribute[a], config.attribute_frac()) + (den_k == 0 ? 0 : num_a[a] / den_k);
  if (den_k != 0)
    for (std::size_t i = 0; i < 4; ++i) lambda[i] = part[i] / den_k;
  const Float113 low = code(quad.base.depth_low, config.depth_bits),
                 high = code(quad.base.depth_high, config.depth_bits);
  z = code(quad.base.depth, config.depth_bits) + (den_w == 0 ? 0 : num_z / den_w);
  z = std::min(std::max(z, low), high);
}

}  // namespace quadrille::explain
