#include "model/pixel_pipeline.hpp"

namespace quadrille {
namespace {

PipelineFloat magnitude(PipelineFloat v) {
  v.neg = false;
  return v;
}

/// sqrt(q_far / q_near) of two pairs without a corner in common, as num / den.
struct RootRatio {
  PipelineFloat num, den;
};

/// q = r r' + D of an edge, r r' - D of a diagonal. Where the terms are of one sign that is u; where they cancel it is
/// A² / u, by (r r')² - D² = A².
RootRatio root_ratio(const PixelTrace& p, std::size_t near, std::size_t far, const PipelineContext& c) {
  const auto cancels = [&](std::size_t k) { return p.d_fp[k].neg == (k < 4); };
  const PipelineFloat root = fp_sqrt(fp_multiply(p.u[near], p.u[far], c.format), c.sqrt_table, c.format);
  if (!cancels(near)) return {cancels(far) ? p.v[far] : p.u[far], root};
  if (!cancels(far)) return {root, p.v[near]};
  return {fp_multiply(p.v[far], p.u[near], c.format), fp_multiply(p.v[near], root, c.format)};
}

/// M_i = product of the three.
struct Factors {
  PipelineFloat x, y, z;
};

std::array<Factors, 4> regular(const PixelTrace& p, const PipelineContext& c) {
  const RootRatio a = root_ratio(p, 0, 2, c);  // 23 / 01
  const RootRatio b = root_ratio(p, 3, 1, c);  // 12 / 30
  const RootRatio d = root_ratio(p, 4, 5, c);  // 13 / 20
  return {{{a.num, b.num, d.num}, {a.num, b.den, d.den}, {a.den, b.den, d.num}, {a.den, b.num, d.den}}};
}

std::array<Factors, 4> two_corner(const PixelTrace& p, const QuadData& quad, const PipelineContext& c) {
  std::size_t i = 0;
  while (p.r2[i] > 0) ++i;
  std::size_t j = i + 1;
  while (p.r2[j] > 0) ++j;
  // Crossed factors: λ'_i = k_j·k_i / (k_j·k_i + k_i·k_j) = 1/2 whatever the k.
  const PipelineFloat one = c.format.one();
  std::array<Factors, 4> m{};
  m[i] = {magnitude(quad.k[j]), one, one};
  m[j] = {magnitude(quad.k[i]), one, one};
  return m;
}

std::array<Factors, 4> on_vertex(const PixelTrace& p, const PipelineContext& c) {
  const PipelineFloat one = c.format.one();
  std::array<Factors, 4> m{};
  for (std::size_t i = 0; i < 4; ++i)
    if (p.r2[i] <= 0) m[i] = {one, one, one};
  return m;
}

/// Along an edge (i, j) the weights are r_j and r_i, with the denominator r_j k_i + r_i k_j; crossing the denominators
/// of two edges gives the mean of their interpolations. A vertex on both has two such terms.
void two_edge(PixelTrace& p, const QuadData& quad, const PipelineContext& c) {
  const SignificandFormat& f = c.format;
  const auto is_on = [&](std::size_t e) { return p.a[e] == 0 && p.d[e] < 0; };
  std::size_t a = 0;
  while (!is_on(a)) ++a;
  std::size_t b = a + 1;
  while (!is_on(b)) ++b;
  const auto denominator = [&](std::size_t e) {
    const std::size_t j = (e + 1) % 4;
    return magnitude(fp_sum({raw_product(p.root[j], quad.k[e]), raw_product(p.root[e], quad.k[j])}, f));
  };
  const PipelineFloat of_a = denominator(a), of_b = denominator(b);
  for (std::size_t i = 0; i < 4; ++i) {
    /// The weight along an edge that has vertex i, or nothing.
    const auto along = [&](std::size_t e, const PipelineFloat& other_denominator) -> PipelineFloat {
      if (i == e) return fp_multiply(p.root[(e + 1) % 4], other_denominator, f);
      if (i == (e + 1) % 4) return fp_multiply(p.root[e], other_denominator, f);
      return {};
    };
    p.m[i] = fp_sum({raw_from_fp(along(a, of_b), f), raw_from_fp(along(b, of_a), f)}, f);
  }
}

/// Two neighbouring A have opposite signs: an edge turns backward as seen from the pixel.
bool is_notch(const PixelTrace& p) {
  for (std::size_t i = 0; i < 4; ++i) {
    const std::int64_t before = p.a[(i + 3) % 4];
    if ((before < 0 && p.a[i] > 0) || (before > 0 && p.a[i] < 0)) return true;
  }
  return false;
}

}  // namespace

void mean_value_weights(PixelTrace& p, const QuadData& quad, const PipelineContext& c) {
  p.cured = c.config.notch_exact && !p.two_corner && !p.on_vertex && !p.two_edge && is_notch(p);
  if (p.two_edge) return two_edge(p, quad, c);
  const std::array<Factors, 4> m = p.two_corner  ? two_corner(p, quad, c)
                                   : p.on_vertex ? on_vertex(p, c)
                                                 : regular(p, c);
  for (std::size_t i = 0; i < 4; ++i) p.m[i] = fp_multiply(fp_multiply(m[i].x, m[i].y, c.format), m[i].z, c.format);
}

}  // namespace quadrille
