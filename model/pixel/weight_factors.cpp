#include "model/pixel/weight_factors.hpp"

#include "model/pixel/root_ratio.hpp"

#include <algorithm>

namespace quadrille {
namespace {

PipelineFloat magnitude(PipelineFloat v) {
  v.neg = false;
  return v;
}

std::array<WeightFactors, 4> regular(const PixelTrace& p, const PipelineContext& c) {
  const RootRatio a = root_ratio(p, 0, 2, c);  // 23 / 01
  const RootRatio b = root_ratio(p, 3, 1, c);  // 12 / 30
  const RootRatio d = root_ratio(p, 4, 5, c);  // 13 / 20
  return {{{a.num, b.num, d.num}, {a.num, b.den, d.den}, {a.den, b.den, d.num}, {a.den, b.num, d.den}}};
}

std::array<WeightFactors, 4> two_corner(const PixelTrace& p, const QuadData& quad, const PipelineContext& c) {
  std::size_t i = 0;
  while (p.r2[i] > 0) ++i;
  std::size_t j = i + 1;
  while (p.r2[j] > 0) ++j;
  // Crossed factors: λ'_i = k_j·k_i / (k_j·k_i + k_i·k_j) = 1/2 whatever the k.
  const PipelineFloat one = c.format.one();
  std::array<WeightFactors, 4> m{};
  m[i] = {magnitude(quad.k[j]), one, one};
  m[j] = {magnitude(quad.k[i]), one, one};
  return m;
}

std::array<WeightFactors, 4> on_vertex(const PixelTrace& p, const PipelineContext& c) {
  const PipelineFloat one = c.format.one();
  std::array<WeightFactors, 4> m{};
  for (std::size_t i = 0; i < 4; ++i)
    if (p.r2[i] <= 0) m[i] = {one, one, one};
  return m;
}

/// Opposite each corner, of the triangle 012 or 023 that the pixel is in. Inside a convex quad the edge functions have
/// one sign, and E20 has it too on the side of corner 1.
std::array<WeightFactors, 4> areas(const PixelTrace& p, const PipelineContext& c) {
  const bool negative = std::any_of(p.a.begin(), p.a.begin() + 4, [](std::int64_t a) { return a < 0; });
  const bool behind_diagonal = (p.a[4] < 0) != negative;
  const PipelineFloat one = c.format.one();
  const auto area = [&](std::size_t k) { return WeightFactors{p.v[k], one, one}; };
  const WeightFactors none{{}, one, one};
  if (behind_diagonal) return {area(2), none, area(3), area(4)};
  return {area(1), area(4), area(0), none};
}

}  // namespace

std::array<WeightFactors, 4> weight_factors(const PixelTrace& p, const QuadData& quad, const PipelineContext& c) {
  if (p.two_corner) return two_corner(p, quad, c);
  if (p.on_vertex) return on_vertex(p, c);
  return quad.plane ? areas(p, c) : regular(p, c);
}

PipelineFloat edge_denominator(const PixelTrace& p, std::size_t e, const QuadData& quad, const PipelineContext& c) {
  const std::size_t j = (e + 1) % 4;
  return magnitude(fp_sum({raw_product(p.root[j], quad.k[e]), raw_product(p.root[e], quad.k[j])}, c.format));
}

}  // namespace quadrille
