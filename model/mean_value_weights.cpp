#include "model/pixel_pipeline.hpp"

namespace quadrille {
namespace {

PipelineFloat magnitude(PipelineFloat v) {
  v.neg = false;
  return v;
}

/// What replaces the regular factors at a singular pixel.
struct Singular {
  std::array<PipelineFloat, 4> numerator{};
  bool rho_is_one = false;
};

Singular two_corner(const PixelTrace& p, const QuadData& quad) {
  std::size_t i = 0;
  while (p.r2[i] > 0) ++i;
  std::size_t j = i + 1;
  while (p.r2[j] > 0) ++j;
  // Crossed factors: λ'_i = k_j·k_i / (k_j·k_i + k_i·k_j) = 1/2 whatever the k.
  Singular s{{}, true};
  s.numerator[i] = magnitude(quad.k[j]);
  s.numerator[j] = magnitude(quad.k[i]);
  return s;
}

Singular on_vertex(const PixelTrace& p, const PipelineContext& c) {
  Singular s{{}, true};
  for (std::size_t i = 0; i < 4; ++i)
    if (p.r2[i] <= 0) s.numerator[i] = c.format.one();
  return s;
}

/// `edge_sum[i]` = |ρ_i k_i + ρ_{i+1} k_{i+1}|. Each edge's own interpolation is ρ k over that sum; crossing the sums
/// gives their mean.
Singular two_edge(const PixelTrace& p, const std::array<PipelineFloat, 4>& edge_sum, const PipelineContext& c) {
  const auto is_on = [&](std::size_t e) { return p.a[e] == 0 && p.d[e] < 0; };
  std::size_t a = 0;
  while (!is_on(a)) ++a;
  std::size_t b = a + 1;
  while (!is_on(b)) ++b;
  const PipelineFloat both =
      magnitude(fp_sum({raw_from_fp(edge_sum[a], c.format), raw_from_fp(edge_sum[b], c.format)}, c.format));
  Singular s;
  for (std::size_t i = 0; i < 4; ++i) {
    const bool on_a = i == a || i == (a + 1) % 4;
    const bool on_b = i == b || i == (b + 1) % 4;
    s.numerator[i] = on_a && on_b ? both : on_a ? edge_sum[b] : on_b ? edge_sum[a] : PipelineFloat{};
  }
  return s;
}

}  // namespace

void mean_value_weights(PixelTrace& p, const QuadData& quad, const PipelineContext& c) {
  const SignificandFormat& f = c.format;
  const bool singular = p.two_corner || p.on_vertex || p.two_edge;
  std::array<bool, 4> differ{};
  bool any_differ = false;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::int64_t before = p.a[(i + 3) % 4];
    differ[i] = (before < 0 && p.a[i] > 0) || (before > 0 && p.a[i] < 0);
    any_differ |= differ[i];
  }
  p.cured = c.config.notch_exact && any_differ && !singular;

  std::array<PipelineFloat, 4> numerator;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t h = (i + 3) % 4;
    const std::size_t j = (i + 1) % 4;
    if (p.two_edge) {
      numerator[i] = fp_sum({raw_product(p.rho[i], quad.k[i]), raw_product(p.rho[j], quad.k[j])}, f);
    } else if (p.cured && differ[i]) {
      numerator[i] = fp_sum({raw_product(p.num[h], p.num[i]), raw_product(p.den[h], p.den[i])}, f);
    } else {
      RawProduct second = raw_product(p.num[i], p.den[h]);
      second.neg = differ[i];
      numerator[i] = fp_sum({raw_product(p.num[h], p.den[i]), second}, f);
    }
    numerator[i].neg = false;
  }

  Singular special;
  if (p.two_corner) special = two_corner(p, quad);
  if (p.on_vertex) special = on_vertex(p, c);
  if (p.two_edge) special = two_edge(p, numerator, c);

  const PipelineFloat one = f.one();
  const PipelineFloat even_factor = fp_multiply(p.num[5], p.den[4], f);  // n13·d20
  const PipelineFloat odd_factor = fp_multiply(p.num[4], p.den[5], f);   // n20·d13
  const PipelineFloat plain_factor = fp_multiply(p.den[5], p.den[4], f);
  for (std::size_t i = 0; i < 4; ++i) {
    const PipelineFloat lead = singular ? special.numerator[i] : numerator[i];
    const PipelineFloat denominators = singular ? one : fp_multiply(p.den[(i + 1) % 4], p.den[(i + 2) % 4], f);
    const PipelineFloat rho = singular && special.rho_is_one ? one : p.rho[i];
    const PipelineFloat factor = !p.cured ? one : differ[i] ? (i % 2 == 0 ? even_factor : odd_factor) : plain_factor;
    p.m[i] = fp_multiply(fp_multiply(lead, denominators, f), fp_multiply(rho, factor, f), f);
  }
}

}  // namespace quadrille
